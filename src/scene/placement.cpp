#include "placement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <pellucid/base/error.h>

namespace pellucid {

double Normalisation::scale() const noexcept { return std::ldexp(1.0, exponent); }

Normalisation normalise(const SceneDescription& description) {
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper(-lower);
    for (const Geometry& g : description.geometries)
        for (const glm::vec3& p : description.meshes[g.mesh].positions) {
            const glm::dvec3 world(g.toWorld * glm::dvec4(glm::dvec3(p), 1.0));
            lower = glm::min(lower, world);
            upper = glm::max(upper, world);
        }
    Normalisation n;
    n.centre = 0.5 * (lower + upper);
    const double radius = 0.5 * glm::length(upper - lower);
    if (!(radius > 0.0) || !std::isfinite(radius))
        throw Error(ErrorKind::BadInput, "the scene has no extent that a number can hold", description.name,
                    "give it geometry of finite, non-zero size");
    n.exponent = -static_cast<int>(std::lround(std::log2(radius)));
    return n;
}

glm::dmat4 normalisedTransform(const Normalisation& n, const glm::dmat4& toWorld) {
    glm::dmat4 m = toWorld;
    m[3] = glm::dvec4(glm::dvec3(m[3]) - n.centre, 1.0);
    const double s = n.scale();
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 3; ++r) m[c][r] *= s;
    return m;
}

Placement place(const Normalisation& n, const Geometry& geometry) {
    const glm::dmat4 m = normalisedTransform(n, geometry.toWorld);
    Placement p;
    p.toScene = glm::mat4(m);
    const glm::dmat3 linear(m);
    const double determinant = glm::determinant(linear);
    p.mirrored = determinant < 0.0;
    // The cofactor matrix is the inverse transpose up to its scale and exists for singular transforms too.
    const glm::dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                              glm::cross(linear[0], linear[1]));
    const double size =
        std::max({glm::length(cofactor[0]), glm::length(cofactor[1]), glm::length(cofactor[2]), 1e-300});
    p.normalToScene = glm::mat3(cofactor * ((determinant < 0.0 ? -1.0 : 1.0) / size));
    return p;
}

Corners cornersIn(const Placement& placement, const Mesh& mesh, std::uint32_t primitive) noexcept {
    const glm::uvec3 t = mesh.triangles[primitive];
    if (placement.baked) return {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
    const glm::mat4& m = placement.toScene;
    return {glm::vec3(m * glm::vec4(mesh.positions[t.x], 1.0F)), glm::vec3(m * glm::vec4(mesh.positions[t.y], 1.0F)),
            glm::vec3(m * glm::vec4(mesh.positions[t.z], 1.0F))};
}

void bake(Placement& placement, Mesh& mesh) {
    for (glm::vec3& p : mesh.positions) p = glm::vec3(placement.toScene * glm::vec4(p, 1.0F));
    for (glm::vec3& n : mesh.normals) n = placement.normalToScene * n;
    for (glm::vec4& t : mesh.tangents) t = glm::vec4(glm::mat3(placement.toScene) * glm::vec3(t), t.w);
    placement.toScene = glm::mat4(1.0F);
    placement.normalToScene = glm::mat3(1.0F);
    placement.baked = true;
}

}  // namespace pellucid

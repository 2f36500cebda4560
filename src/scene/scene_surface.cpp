// The surface at a hit, from the mesh: position, normals, tangent, texture coordinates and vertex colour.
#include <array>
#include <cmath>

#include "scene_impl.h"

namespace pellucid {

namespace {

/// An attribute of a mesh's corners, interpolated.
struct Interpolation {
    glm::uvec3 corners;
    float w, u, v;

    template <class Attribute>
    [[nodiscard]] Attribute operator()(const std::vector<Attribute>& values) const noexcept {
        return values[corners.x] * w + values[corners.y] * u + values[corners.z] * v;
    }
};

void setNormals(SurfacePoint& p, const Corners& corners, const Mesh& mesh, const Placement& placement,
                const Interpolation& at) noexcept {
    const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    const double length = glm::length(cross);
    p.geometricNormal = length > 0.0 ? glm::vec3(cross * (1.0 / length)) : glm::vec3(0.0F, 0.0F, 1.0F);
    if (placement.mirrored) p.geometricNormal = -p.geometricNormal;
    p.shadingNormal = p.geometricNormal;
    if (mesh.normals.empty()) return;
    glm::vec3 n = at(mesh.normals);
    if (!placement.baked) n = placement.normalToScene * n;
    const float size = glm::length(n);
    if (size > 1e-12F && std::isfinite(size)) p.shadingNormal = n * (1.0F / size);
    const float side = glm::dot(p.shadingNormal, p.geometricNormal);
    if (side <= 0.0F) p.shadingNormal = p.geometricNormal;  // turned or grazing: not a normal of this face
}

/// The tangent that comes with the mesh.
void setGivenTangent(SurfacePoint& p, const Mesh& mesh, const Placement& placement, const Interpolation& at) noexcept {
    const glm::vec4 tangent = at(mesh.tangents);
    const glm::vec3 world = glm::mat3(placement.toScene) * glm::vec3(tangent);
    const float size = glm::length(world);
    if (size > 0.0F && std::isfinite(size)) p.tangent = world / size;
    p.tangentSign = (tangent.w < 0.0F) != placement.mirrored ? -1.0F : 1.0F;
}

/// The tangent along which the texture's u grows.
void setTextureTangent(SurfacePoint& p, const Corners& corners, const std::vector<glm::vec2>& uvs, const glm::uvec3& t,
                       bool mirrored) noexcept {
    const auto& [a, b, c] = corners;
    const glm::vec2 d1 = uvs[t.y] - uvs[t.x], d2 = uvs[t.z] - uvs[t.x];
    const float det = d1.x * d2.y - d1.y * d2.x;
    glm::vec3 tangent = ((b - a) * d2.y - (c - a) * d1.y) * (det < 0.0F ? -1.0F : 1.0F);
    tangent -= p.shadingNormal * glm::dot(p.shadingNormal, tangent);
    const float size = glm::length(tangent);
    if (det == 0.0F || !(size > 0.0F)) return;
    p.tangent = tangent / size;
    // glTF's v grows downwards in the image: its bitangent is that of flipped v.
    p.tangentSign = (det < 0.0F) != mirrored ? 1.0F : -1.0F;
}

}  // namespace

Corners Scene::Impl::corners(std::uint32_t geometry, std::uint32_t primitive) const noexcept {
    return cornersIn(placements[geometry], description.meshes[description.geometries[geometry].mesh], primitive);
}

/// Recomputes the hit from its barycentrics in double, so that its error does not grow with the ray's length.
SurfacePoint Scene::Impl::surfacePoint(const RawHit& hit) const noexcept {
    const Mesh& mesh = description.meshes[description.geometries[hit.geometry].mesh];
    const Placement& placement = placements[hit.geometry];
    const glm::uvec3 t = mesh.triangles[hit.primitive];
    const Corners abc = corners(hit.geometry, hit.primitive);
    const double u = static_cast<double>(hit.u), v = static_cast<double>(hit.v), w = 1.0 - u - v;
    const Interpolation at{t, static_cast<float>(w), hit.u, hit.v};
    SurfacePoint p;
    p.geometry = hit.geometry;
    p.primitive = hit.primitive;
    p.material = mesh.material;
    p.barycentric = {hit.u, hit.v};
    p.position = glm::vec3(glm::dvec3(abc[0]) * w + glm::dvec3(abc[1]) * u + glm::dvec3(abc[2]) * v);
    setNormals(p, abc, mesh, placement, at);
    if (!mesh.uv0.empty()) p.uv[0] = at(mesh.uv0);
    if (!mesh.uv1.empty()) p.uv[1] = at(mesh.uv1);
    if (!mesh.colors.empty()) p.color = at(mesh.colors);
    p.tangent = glm::vec3(0.0F);
    const auto& normalTexture = description.materials[mesh.material].normalTexture;
    if (!normalTexture) return p;
    if (!mesh.tangents.empty())
        setGivenTangent(p, mesh, placement, at);
    else if (!mesh.uv0.empty())
        setTextureTangent(p, abc, normalTexture.uvSet == 1 && !mesh.uv1.empty() ? mesh.uv1 : mesh.uv0, t,
                          placement.mirrored);
    return p;
}

}  // namespace pellucid

#include <cmath>
#include <limits>
#include <vector>

#include "gltf_scene.h"

namespace pellucid {
namespace {

constexpr std::uint32_t kNoMesh = std::numeric_limits<std::uint32_t>::max();

/// det(m) m^-T of the linear part: takes the cross product of two edges to that of their images.
[[nodiscard]] glm::dmat3 areaTransform(const glm::dmat4& m) noexcept {
    const glm::dvec3 a(m[0]), b(m[1]), c(m[2]);
    return {glm::cross(b, c), glm::cross(c, a), glm::cross(a, b)};
}

[[nodiscard]] double squaredNorm(const glm::dmat3& m) noexcept {
    return glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]);
}

struct DoubleBounds {
    glm::dvec3 lower{std::numeric_limits<double>::infinity()}, upper{-std::numeric_limits<double>::infinity()};
    void extend(const glm::dvec3& p) noexcept {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
};

/// Diagonal of a box around all geometries (around their boxes, which is enough for a measure of size).
[[nodiscard]] double sceneSize(const SceneDescription& description) {
    std::vector<DoubleBounds> local(description.meshes.size());
    for (std::size_t i = 0; i < local.size(); ++i)
        for (const glm::vec3& p : description.meshes[i].positions) local[i].extend(glm::dvec3(p));
    DoubleBounds all;
    for (const Geometry& geometry : description.geometries) {
        const DoubleBounds& box = local[geometry.mesh];
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 p((corner & 1) != 0 ? box.upper.x : box.lower.x,
                               (corner & 2) != 0 ? box.upper.y : box.lower.y,
                               (corner & 4) != 0 ? box.upper.z : box.lower.z);
            all.extend(glm::dvec3(geometry.toWorld * glm::dvec4(p, 1.0)));
        }
    }
    return description.geometries.empty() ? 0.0 : glm::length(all.upper - all.lower);
}

/// For each mesh the placement that makes it largest: a triangle goes only where it is nothing in every placement.
[[nodiscard]] std::vector<glm::dmat3> largestPlacements(const SceneDescription& description) {
    std::vector<glm::dmat3> largest(description.meshes.size(), glm::dmat3(0.0));
    for (const Geometry& geometry : description.geometries) {
        const glm::dmat3 candidate = areaTransform(geometry.toWorld);
        if (squaredNorm(candidate) > squaredNorm(largest[geometry.mesh])) largest[geometry.mesh] = candidate;
    }
    return largest;
}

[[nodiscard]] double squaredArea(const Mesh& mesh, const glm::uvec3& triangle, const glm::dmat3& toWorld) noexcept {
    const glm::dvec3 a(mesh.positions[triangle.x]), b(mesh.positions[triangle.y]), c(mesh.positions[triangle.z]);
    const glm::dvec3 twice = toWorld * glm::cross(b - a, c - a);
    return 0.25 * glm::dot(twice, twice);
}

/// Takes out meshes without triangles or placements, and renumbers the geometries.
void dropEmpty(SceneDescription& description) {
    std::vector<char> placed(description.meshes.size(), 0);
    for (const Geometry& geometry : description.geometries) placed[geometry.mesh] = 1;
    std::vector<std::uint32_t> number(description.meshes.size(), kNoMesh);
    std::vector<Mesh> kept;
    for (std::size_t i = 0; i < description.meshes.size(); ++i) {
        if (placed[i] == 0 || description.meshes[i].triangles.empty()) continue;
        number[i] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(std::move(description.meshes[i]));
    }
    description.meshes = std::move(kept);
    for (Geometry& geometry : description.geometries) geometry.mesh = number[geometry.mesh];
    std::erase_if(description.geometries, [](const Geometry& geometry) { return geometry.mesh == kNoMesh; });
}

}  // namespace

void dropDegenerate(SceneDescription& description) {
    dropEmpty(description);
    const double size = sceneSize(description);
    const double least = 1e-24 * (size * size) * (size * size);
    const std::vector<glm::dmat3> toWorld = largestPlacements(description);
    for (std::size_t i = 0; i < description.meshes.size(); ++i) {
        Mesh& mesh = description.meshes[i];
        description.droppedTriangles += std::erase_if(mesh.triangles, [&](const glm::uvec3& triangle) {
            return !(squaredArea(mesh, triangle, toWorld[i]) > least);
        });
    }
    dropEmpty(description);
}

}  // namespace pellucid

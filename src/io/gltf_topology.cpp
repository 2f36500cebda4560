#include "gltf_meshes.h"

#include <tiny_gltf.h>

#include "gltf_accessors.h"

namespace pellucid {
namespace {

/// Corners of triangle `i` as places in the index list. glTF 2.0 section 3.7.2.1: strips turn every second triangle.
[[nodiscard]] glm::u64vec3 corners(int mode, std::uint64_t i) noexcept {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) return {i, i + 1 + i % 2, i + 2 - i % 2};
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {i + 1, i + 2, 0};
    return {3 * i, 3 * i + 1, 3 * i + 2};
}

[[nodiscard]] std::uint64_t triangleCount(int mode, std::uint64_t corners) noexcept {
    if (mode == TINYGLTF_MODE_TRIANGLES) return corners / 3;
    return corners < 3 ? 0 : corners - 2;
}

}  // namespace

std::vector<glm::uvec3> readTriangles(const GltfAsset& asset, const PrimitiveId& id, std::size_t& dropped) {
    const tinygltf::Primitive& primitive =
        asset.model().meshes[static_cast<std::size_t>(id.mesh)].primitives[id.primitive];
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) {
        asset.notes().warn(id.path() + " has no positions and is left out");
        return {};
    }
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
        asset.notes().warn("points and lines are left out: they have no surface");
        return {};
    }
    const std::size_t vertices = asset.model().accessors[static_cast<std::size_t>(position->second)].count;
    std::optional<AccessorReader> indices;
    if (primitive.indices >= 0) indices.emplace(asset, primitive.indices);
    const std::uint64_t listed = indices ? indices->count() : vertices;
    if (primitive.mode == TINYGLTF_MODE_TRIANGLES && listed % 3 != 0)
        asset.notes().warn(id.path() + ": the last triangle is not whole and is left out");

    std::vector<glm::uvec3> triangles;
    const std::uint64_t count = triangleCount(primitive.mode, listed);
    triangles.reserve(static_cast<std::size_t>(count));
    for (std::uint64_t i = 0; i < count; ++i) {
        const glm::u64vec3 place = corners(primitive.mode, i);
        glm::uvec3 triangle(place);
        if (indices)
            for (int k = 0; k < 3; ++k) triangle[k] = indices->index(static_cast<std::size_t>(place[k]));
        for (int k = 0; k < 3; ++k)
            if (triangle[k] >= vertices)
                asset.bad(id.path() + ".indices",
                          "index " + std::to_string(triangle[k]) + " is past the end of " + std::to_string(vertices) +
                              " vertices",
                          "export the file again");
        if (triangle.x == triangle.y || triangle.y == triangle.z || triangle.z == triangle.x)
            ++dropped;
        else
            triangles.push_back(triangle);
    }
    return triangles;
}

}  // namespace pellucid

/// One mesh primitive to one Mesh: topology, attributes, morph targets, skin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include <pellucid/geometry/mesh.h>

#include "gltf_asset.h"

namespace tinygltf {
struct Primitive;
}

namespace pellucid {

struct PrimitiveId {
    int mesh = 0;
    std::size_t primitive = 0;
    [[nodiscard]] std::string path() const {
        return element(element("meshes", static_cast<std::size_t>(mesh)) + ".primitives", primitive);
    }
};

/// What a node does to its mesh beyond placing it.
struct Deformation {
    std::vector<double> weights;     ///< of the morph targets; missing ones are 0
    std::vector<glm::dmat4> joints;  ///< to the world from bind space; empty: not skinned
};

/// The triangles of a primitive, by the numbers of the accessor's vertices. Empty: it has none (points, lines, no
/// positions: warned of). Triangles that repeat an index are left out and counted in `dropped`.
[[nodiscard]] std::vector<glm::uvec3> readTriangles(const GltfAsset& asset, const PrimitiveId& id,
                                                    std::size_t& dropped);

/// Empty: no triangles. `material` of primitives without one is the number of materials in the file.
[[nodiscard]] std::optional<Mesh> buildMesh(const GltfAsset& asset, const PrimitiveId& id,
                                            const Deformation& deformation, std::size_t& dropped);

/// gltf_deform.cpp. `used` are the numbers of the mesh's vertices in the accessors. glTF 2.0 sections 3.7.2.2, 3.7.3.
void applyMorphTargets(const GltfAsset& asset, const tinygltf::Primitive& primitive, const std::vector<double>& weights,
                       const std::vector<std::uint32_t>& used, Mesh& mesh);
[[nodiscard]] bool hasInfluences(const tinygltf::Primitive& primitive);
/// Only for primitives with influences.
void applySkin(const GltfAsset& asset, const PrimitiveId& id, const std::vector<glm::dmat4>& joints,
               const std::vector<std::uint32_t>& used, Mesh& mesh);

/// Turns the front to the other side: the winding of the triangles and the sign of the bitangents.
void turnRound(Mesh& mesh);

}  // namespace pellucid

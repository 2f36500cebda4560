/// The node trees: which nodes the scene shows, and where each of them stands. No recursion: depth is the file's.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "gltf_asset.h"

namespace pellucid {

/// World transforms of all nodes, in and out of the scene (joints may be out of it).
[[nodiscard]] std::vector<glm::dmat4> worldTransforms(const GltfAsset& asset);

/// Nodes of the default scene, else of the first one, else all, parents before children, in the file's order.
[[nodiscard]] std::vector<int> sceneNodes(const GltfAsset& asset);

/// EXT_mesh_gpu_instancing: transforms below the node's own. Empty: the node has none.
[[nodiscard]] std::vector<glm::dmat4> instanceTransforms(const GltfAsset& asset, int node);

[[nodiscard]] bool isFinite(const glm::dmat4& m) noexcept;

}  // namespace pellucid

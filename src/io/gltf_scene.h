/// The parts of a scene description that nodes place: meshes and geometries, cameras, punctual lights.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include <pellucid/scene/description.h>

#include "gltf_asset.h"

namespace pellucid {

/// Meshes and geometries of the given nodes. Materials of primitives without one get the number one past the file's.
void addMeshes(const GltfAsset& asset, const std::vector<int>& nodes, const std::vector<glm::dmat4>& world,
               SceneDescription& description);

void addCameras(const GltfAsset& asset, const std::vector<int>& nodes, const std::vector<glm::dmat4>& world,
                SceneDescription& description);

void addLights(const GltfAsset& asset, const std::vector<int>& nodes, const std::vector<glm::dmat4>& world,
               SceneDescription& description);

/// Takes out triangles without area, counting them, and then meshes and geometries that have nothing left.
void dropDegenerate(SceneDescription& description);

}  // namespace pellucid

/// glTF materials to Material, textures decoded for those that the scene uses.
#pragma once

#include <pellucid/scene/description.h>

#include "gltf_asset.h"

namespace pellucid {

/// Materials keep the file's numbers; the default material follows them where a mesh needs it, or there are none.
void addMaterials(GltfAsset& asset, SceneDescription& description);

}  // namespace pellucid

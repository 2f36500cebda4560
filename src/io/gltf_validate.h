/// What the JSON schema cannot see: whether sizes fit together, whether accessors have a form that their use allows,
/// and whether the nodes make trees. After this the model can be read without further checks of range, but for the
/// values in its buffers.
#pragma once

#include "gltf_accessors.h"
#include "gltf_asset.h"

namespace pellucid {

/// An extension in extensionsRequired that is not understood throws; others that are not are warned of, once each.
void checkExtensions(const GltfAsset& asset);

/// Names of the extensions in use that the loader leaves out.
[[nodiscard]] std::vector<std::string> ignoredExtensions(const GltfAsset& asset);

/// Throws Error{BadInput}.
void validateModel(const GltfAsset& asset);

}  // namespace pellucid

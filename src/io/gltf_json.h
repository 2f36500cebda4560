/// The JSON of a glTF file, held against the schema and brought to one form. tinygltf then sees only text without
/// references to files, without extras, animations and unknown extensions, in which every index is in range and every
/// number has the type that it expects.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

struct BufferSource {
    std::string uri;
    bool hasUri = false;
    std::uint64_t byteLength = 0;
};

struct ImageSource {
    std::string uri;
    bool hasUri = false;
    int bufferView = -1;
};

struct GltfJson {
    std::string text;  ///< for tinygltf; buffers and images are taken out
    std::vector<BufferSource> buffers;
    std::vector<ImageSource> images;
    std::vector<std::string> extensionsUsed;  ///< declared or found, sorted
    std::vector<std::string> extensionsRequired;
    bool hasAnimations = false;
    /// Accessors without a buffer view are zeros: they point to this view, one past the file's own. Its buffer is one
    /// past the file's own as well.
    int zeroView = 0;
};

/// Throws Error{BadInput} with the place in the JSON.
[[nodiscard]] GltfJson readGltfJson(std::string_view text, const std::string& file);

}  // namespace pellucid

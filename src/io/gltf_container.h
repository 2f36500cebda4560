/// The outermost layer: a glTF file is JSON text, or a GLB with a JSON chunk and at most one binary chunk.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pellucid {

/// Views into the file's bytes.
struct GltfContainer {
    std::string_view json;
    std::optional<std::span<const std::byte>> binary;  ///< GLB: the buffer without a uri
};

/// Throws Error{BadInput} for a header, a length or an order of chunks that glTF 2.0 section 4.4 does not allow.
[[nodiscard]] GltfContainer splitGltf(std::span<const std::byte> bytes, const std::string& file);

}  // namespace pellucid

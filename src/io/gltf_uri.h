/// The three places where a glTF file keeps bytes outside of its JSON: data URIs, files beside it, the GLB's own chunk.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

[[nodiscard]] bool isDataUri(std::string_view uri);

/// Base64 or percent-encoded. Empty: malformed.
[[nodiscard]] std::optional<std::vector<std::byte>> decodeDataUri(std::string_view uri);

/// %XX to bytes. Empty: a broken escape, or a NUL.
[[nodiscard]] std::optional<std::string> percentDecode(std::string_view text);

/// The file inside `folder` that a relative reference names. Empty: absolute, with a scheme, or leading out of the
/// folder by '..'. Backslashes count as separators, so that no platform reads more into them.
[[nodiscard]] std::optional<std::filesystem::path> resolveInside(const std::filesystem::path& folder,
                                                                 std::string_view uri);

}  // namespace pellucid

/// The bytes of a whole regular file, or one clear error.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace pellucid {

/// Throws Error{BadInput} with `where` when the file is missing, is no regular file, or cannot be read.
[[nodiscard]] std::vector<std::byte> readFileBytes(const std::filesystem::path& file, const std::string& where);

}  // namespace pellucid

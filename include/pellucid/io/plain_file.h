/// Files that need no library: text (record.json) and the two plain float image formats, PFM and Radiance HDR. All are
/// written to a temporary name and renamed: whole or absent.
#pragma once

#include <filesystem>
#include <string_view>

#include <pellucid/math/image.h>

namespace pellucid {

/// Throws Error{CannotFinish}.
void writeFile(const std::filesystem::path& file, std::string_view bytes);

/// Throws Error{CannotFinish} unless the folder of `file` exists and takes files, and `file` itself is no folder.
void checkFolderWritable(const std::filesystem::path& file);

/// Little-endian "PF" of R G B, float32.
void writePfm(const std::filesystem::path& file, const Image& image);

/// Radiance RGBE of R G B, without run lengths: 8 bits of mantissa. Negative and non-finite values become 0.
void writeRadianceHdr(const std::filesystem::path& file, const Image& image);

}  // namespace pellucid

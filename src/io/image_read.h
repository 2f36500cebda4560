/// What the image files of this room share: reading pixels, with the limits that come before any allocation.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <pellucid/math/image.h>

namespace pellucid {

/// A picture larger than this is refused before memory is asked for. 16384 x 8192 environments pass.
inline constexpr int kMaxImageDimension = 32768;
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 28;
inline constexpr std::int64_t kMaxImageValues = std::int64_t{1} << 32;  ///< pixels x channels

/// Throws Error{BadInput} unless width, height and channels are positive and within the limits.
void checkImageSize(std::int64_t width, std::int64_t height, std::int64_t channels, const std::string& where);

/// A library's complaint as one line, as errors are printed.
[[nodiscard]] std::string oneLine(std::string text);

enum class WantedChannels { All, ColourOnly };

/// readImage() proper. ColourOnly leaves out everything but R G B (or the first channel, where there is no colour)
/// already while reading: large environments would not fit twice.
[[nodiscard]] Image readPixels(const std::filesystem::path& file, WantedChannels wanted);

}  // namespace pellucid

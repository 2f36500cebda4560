/// Pixels as base64 text for a page: as many bytes a value as the page can afford.
#pragma once

#include <cstddef>
#include <string>

#include <pellucid/math/image.h>

namespace pellucid {

/// Bytes a value: 4 float32; 3 float32 rounded to 16 bits of mantissa; 2 half float.
enum class PixelBytes { Half = 2, Short = 3, Full = 4 };

/// Channels first .. first + count - 1 of every pixel, little endian.
[[nodiscard]] std::string pixelsAsBase64(const Image& image, int first, int count, PixelBytes bytes);

/// Length of that text.
[[nodiscard]] std::size_t base64Length(std::size_t values, PixelBytes bytes) noexcept;

/// R G B alone.
[[nodiscard]] Image colourOf(const Image& image);

/// Mean of 2 x 2 pixels; a last odd row or column stands for itself.
[[nodiscard]] Image halved(const Image& image);

}  // namespace pellucid

#include "report_pixels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include <pellucid/study/image_pair.h>

namespace pellucid {
namespace {

/// IEEE 754 half of a float, rounded to nearest, ties to even. Beyond 65504 the largest finite half.
[[nodiscard]] std::uint32_t halfBits(float value) noexcept {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(value), sign = bits >> 16U & 0x8000U;
    if (std::isnan(value)) return sign | 0x7E00U;
    const float size = std::min(std::abs(value), 65504.0F);
    if (size < 0x1p-14F) return sign | static_cast<std::uint32_t>(std::nearbyint(size * 0x1p24F));
    const std::uint32_t magnitude = std::bit_cast<std::uint32_t>(size) - (112U << 23U);  // exponent bias 127 to 15
    const std::uint32_t odd = magnitude >> 13U & 1U;
    return sign | (magnitude + 0xFFFU + odd) >> 13U;
}

/// The upper 24 bits of a float, rounded. Infinities stay; a carry into them is what rounding means.
[[nodiscard]] std::uint32_t shortBits(float value) noexcept {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
    if (!std::isfinite(value)) return bits >> 8U;
    return (bits + 0x7FU + (bits >> 8U & 1U)) >> 8U;
}

[[nodiscard]] std::string base64(const std::vector<std::uint8_t>& bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t given = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8U | (k < given ? bytes[i + k] : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += k <= given ? kDigits[group >> (18U - 6U * k) & 63U] : '=';
    }
    return text;
}

}  // namespace

std::string pixelsAsBase64(const Image& image, int first, int count, PixelBytes width) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(image.pixels() * static_cast<std::size_t>(count) * static_cast<std::size_t>(width));
    for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel)
        for (int c = first; c < first + count; ++c) {
            const float value = image.at(pixel, c);
            std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
            if (width == PixelBytes::Half) bits = halfBits(value);
            if (width == PixelBytes::Short) bits = shortBits(value);
            for (unsigned k = 0; k < static_cast<unsigned>(width); ++k)
                bytes.push_back(static_cast<std::uint8_t>(bits >> 8U * k & 255U));
        }
    return base64(bytes);
}

std::size_t base64Length(std::size_t values, PixelBytes bytes) noexcept {
    return (values * static_cast<std::size_t>(bytes) + 2) / 3 * 4;
}

Image colourOf(const Image& image) {
    const std::array<int, 3> channels = colourChannels(image);
    Image colour(image.width(), image.height(), {"R", "G", "B"});
    for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel)
        for (int c = 0; c < 3; ++c) colour.at(pixel, c) = image.at(pixel, channels[static_cast<std::size_t>(c)]);
    return colour;
}

Image halved(const Image& image) {
    Image small((image.width() + 1) / 2, (image.height() + 1) / 2, image.channelNames());
    for (int y = 0; y < small.height(); ++y)
        for (int x = 0; x < small.width(); ++x)
            for (int c = 0; c < image.channels(); ++c) {
                float sum = 0.0F, count = 0.0F;
                for (int v = 2 * y; v < std::min(2 * y + 2, image.height()); ++v)
                    for (int u = 2 * x; u < std::min(2 * x + 2, image.width()); ++u) {
                        sum += image.at(static_cast<std::size_t>(v) * static_cast<std::size_t>(image.width()) +
                                            static_cast<std::size_t>(u),
                                        c);
                        count += 1.0F;
                    }
                small.at(
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(small.width()) + static_cast<std::size_t>(x),
                    c) = sum / count;
            }
    return small;
}

}  // namespace pellucid

#include <pellucid/surface/texture.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace pellucid {
namespace {

/// Every 8-bit code decoded once: a look-up decodes four texels of three channels.
const std::array<float, 256>& decodedCodes() noexcept {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = srgbToLinear(static_cast<float>(i) / 255.0F);
        return values;
    }();
    return table;
}

[[nodiscard]] glm::vec4 decode8(const glm::u8vec4& texel, bool srgb) noexcept {
    constexpr float kScale = 1.0F / 255.0F;
    const float alpha = static_cast<float>(texel.a) * kScale;
    if (!srgb) return {glm::vec3(texel.r, texel.g, texel.b) * kScale, alpha};
    const std::array<float, 256>& table = decodedCodes();
    return {table[texel.r], table[texel.g], table[texel.b], alpha};
}

[[nodiscard]] glm::vec4 decode16(const glm::u16vec4& texel, bool srgb) noexcept {
    const glm::vec4 value = glm::vec4(texel) * (1.0F / 65535.0F);
    if (!srgb) return value;
    return {srgbToLinear(value.r), srgbToLinear(value.g), srgbToLinear(value.b), value.a};
}

/// Scale, then rotation, then offset (KHR_texture_transform: matrix = translation * rotation * scale). A positive angle
/// turns the coordinates counter-clockwise as seen with v pointing down, which is (c, s; -s, c): the extension's own
/// example (offset 0,1, a quarter turn, scale 0.5) must give the lower left quadrant of the image.
[[nodiscard]] glm::vec2 transformed(const TextureRef& texture, const glm::vec2& uv) noexcept {
    const glm::vec2 scaled = texture.scale * uv;
    if (texture.rotation == 0.0F) return texture.offset + scaled;
    const float c = std::cos(texture.rotation), s = std::sin(texture.rotation);
    return texture.offset + glm::vec2(c * scaled.x + s * scaled.y, -s * scaled.x + c * scaled.y);
}

/// Brings a coordinate to [0, 1] (clamp, repeat) or [0, 2] (mirror: its period), so that texel numbers fit an int.
/// What is not finite becomes 0.
[[nodiscard]] float reduced(float t, Wrap wrap) noexcept {
    if (!(std::fabs(t) <= std::numeric_limits<float>::max())) return 0.0F;
    if (wrap == Wrap::Clamp) return std::clamp(t, 0.0F, 1.0F);
    if (wrap == Wrap::Repeat) return t - std::floor(t);
    const float half = 0.5F * t;
    return 2.0F * (half - std::floor(half));
}

/// Number of the texel that stands at place `i` of the endlessly wrapped row; -2 size <= i < 4 size.
[[nodiscard]] int wrapped(int i, int size, Wrap wrap) noexcept {
    if (wrap == Wrap::Clamp) return std::clamp(i, 0, size - 1);
    if (wrap == Wrap::Repeat) return (i + 2 * size) % size;
    const int m = (i + 2 * size) % (2 * size);
    return m < size ? m : 2 * size - 1 - m;
}

[[nodiscard]] glm::vec4 texel(const TextureRef& texture, int x, int y) noexcept {
    const TextureImage& image = *texture.image;
    const std::size_t index =
        static_cast<std::size_t>(wrapped(y, image.height, texture.wrapT)) * static_cast<std::size_t>(image.width) +
        static_cast<std::size_t>(wrapped(x, image.width, texture.wrapS));
    return image.texels8.empty() ? decode16(image.texels16[index], texture.srgb)
                                 : decode8(image.texels8[index], texture.srgb);
}

}  // namespace

float srgbToLinear(float encoded) noexcept {
    return encoded <= 0.04045F ? encoded * (1.0F / 12.92F) : std::pow((encoded + 0.055F) * (1.0F / 1.055F), 2.4F);
}

float linearToSrgb(float linear) noexcept {
    return linear <= 0.0031308F ? linear * 12.92F : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

glm::vec4 sampleTexture(const TextureRef& texture, const glm::vec2& uv) noexcept {
    if (!texture.image) return glm::vec4(1.0F);
    const glm::vec2 at = transformed(texture, uv);
    const float x = reduced(at.x, texture.wrapS) * static_cast<float>(texture.image->width);
    const float y = reduced(at.y, texture.wrapT) * static_cast<float>(texture.image->height);
    if (!texture.linear) return texel(texture, static_cast<int>(x), static_cast<int>(y));

    const float left = std::floor(x - 0.5F), top = std::floor(y - 0.5F);  // texel centres lie at halves
    const float fx = x - 0.5F - left, fy = y - 0.5F - top;
    const int x0 = static_cast<int>(left), y0 = static_cast<int>(top);
    const glm::vec4 upper = glm::mix(texel(texture, x0, y0), texel(texture, x0 + 1, y0), fx);
    const glm::vec4 lower = glm::mix(texel(texture, x0, y0 + 1), texel(texture, x0 + 1, y0 + 1), fx);
    return glm::mix(upper, lower, fy);
}

}  // namespace pellucid

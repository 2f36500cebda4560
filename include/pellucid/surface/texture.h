/// Texture images and their look-up with glTF's sampler state and KHR_texture_transform. Bilinear, no mip maps: the
/// pixel's samples do the filtering. Texels stay in the file's encoding; decoding happens at look-up.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace pellucid {

/// RGBA, row 0 at the top. Exactly one of texels8 and texels16 is filled (unsigned normalised).
struct TextureImage {
    std::string name;
    int width = 0, height = 0;
    std::vector<glm::u8vec4> texels8;
    std::vector<glm::u16vec4> texels16;
};

enum class Wrap { Repeat, Clamp, Mirror };

/// How a material uses an image. No image: the look-up returns white.
struct TextureRef {
    std::shared_ptr<const TextureImage> image;
    bool srgb = false;   ///< decode colour channels with the sRGB curve (alpha never is)
    bool linear = true;  ///< bilinear, else nearest
    Wrap wrapS = Wrap::Repeat, wrapT = Wrap::Repeat;
    int uvSet = 0;                        ///< 0 or 1
    glm::vec2 offset{0.0F}, scale{1.0F};  ///< KHR_texture_transform
    float rotation = 0.0F;                ///< radians, counter-clockwise

    [[nodiscard]] explicit operator bool() const noexcept { return image != nullptr; }
};

/// RGBA at the given coordinates (before the texture transform), colour decoded to linear. Components in [0, 1].
[[nodiscard]] glm::vec4 sampleTexture(const TextureRef& texture, const glm::vec2& uv) noexcept;

/// The sRGB electro-optical transfer function (IEC 61966-2-1) and its inverse, on [0, 1].
[[nodiscard]] float srgbToLinear(float encoded) noexcept;
[[nodiscard]] float linearToSrgb(float linear) noexcept;

}  // namespace pellucid

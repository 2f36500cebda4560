/// Variance of a reference's pixels as its layers tell it: variance.R G B, or variance.Y. What `diff` calls the noise of the
/// reference, and what is taken off the measured bias^2.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <pellucid/math/image.h>
#include <pellucid/study/image_pair.h>

namespace pellucid {

class ReferenceVariance {
public:
    explicit ReferenceVariance(const Image& reference)
        : reference_(reference),
          colours_(colourChannels(reference)),
          own_{reference.channel("variance.R"), reference.channel("variance.G"), reference.channel("variance.B")},
          grey_(reference.channel("variance.Y")) {}

    [[nodiscard]] bool known() const noexcept { return hasOwn() || grey_ >= 0; }

    /// Of the mean radiance of the pixel in channel c; 0 where it is not known. variance.Y is that of the luminance: noise
    /// has the colour of the light that makes it, so a channel's share is (R_c / Y)^2 of it. The same variance for all three
    /// would count the blue of a golden surface many times.
    [[nodiscard]] double at(std::size_t pixel, std::size_t c) const noexcept {
        if (hasOwn()) return sane(reference_.at(pixel, own_[c]));
        if (grey_ < 0) return 0.0;
        const auto radiance = [&](std::size_t k) { return static_cast<double>(reference_.at(pixel, colours_[k])); };
        const double luminance = 0.2126 * radiance(0) + 0.7152 * radiance(1) + 0.0722 * radiance(2);
        const double share = luminance > 0.0 ? std::max(0.0, radiance(c)) / luminance : 1.0;
        return sane(reference_.at(pixel, grey_)) * share * share;
    }

private:
    [[nodiscard]] bool hasOwn() const noexcept {
        return std::ranges::all_of(own_, [](int channel) { return channel >= 0; });
    }
    [[nodiscard]] static double sane(float variance) noexcept {
        return std::isfinite(variance) && variance > 0.0F ? static_cast<double>(variance) : 0.0;
    }
    const Image& reference_;
    std::array<int, 3> colours_, own_;
    int grey_;
};

}  // namespace pellucid

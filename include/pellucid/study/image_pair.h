/// A reference and an image of the same size, seen as RGB, with the pixels that count: what every metric iterates over.
#pragma once

#include <array>
#include <cstddef>

#include <pellucid/math/image.h>

namespace pellucid {

/// The channels of an image that stand for R, G and B: those of that name, or three times a lone "Y" or lone channel.
/// Throws Error{BadInput} when there are none.
[[nodiscard]] std::array<int, 3> colourChannels(const Image& image);

/// Holds references: both images must outlive it. Throws Error{BadInput} when the sizes differ.
class ImagePair {
public:
    ImagePair(const Image& reference, const Image& image);

    [[nodiscard]] std::size_t pixels() const noexcept { return reference_.pixels(); }
    [[nodiscard]] int width() const noexcept { return reference_.width(); }
    [[nodiscard]] int height() const noexcept { return reference_.height(); }

    [[nodiscard]] float reference(std::size_t pixel, std::size_t channel) const noexcept {
        return reference_.at(pixel, referenceChannels_[channel]);
    }
    [[nodiscard]] float image(std::size_t pixel, std::size_t channel) const noexcept {
        return image_.at(pixel, imageChannels_[channel]);
    }
    /// False where the reference's channel mask.Y is 0.
    [[nodiscard]] bool counts(std::size_t pixel) const noexcept {
        return mask_ < 0 || reference_.at(pixel, mask_) != 0.0F;
    }
    /// 0.01 mean(R)^2, the floor of relmse's denominator: it makes relmse independent of exposure and keeps black
    /// pixels from deciding it. The mean is over every finite value of the reference, masked pixels included.
    [[nodiscard]] double relativeFloor() const noexcept { return relativeFloor_; }

private:
    const Image& reference_;
    const Image& image_;
    std::array<int, 3> referenceChannels_, imageChannels_;
    int mask_;
    double relativeFloor_;
};

}  // namespace pellucid

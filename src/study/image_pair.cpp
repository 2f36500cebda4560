#include <pellucid/study/image_pair.h>

#include <cmath>
#include <cstddef>
#include <string>

#include <pellucid/base/error.h>

namespace pellucid {
namespace {

std::string sizeText(const Image& image) {
    return std::to_string(image.width()) + "x" + std::to_string(image.height());
}

[[nodiscard]] double meanOfFinite(const Image& image, const std::array<int, 3>& channels) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel)
        for (const int c : channels)
            if (const float value = image.at(pixel, c); std::isfinite(value)) {
                sum += static_cast<double>(value);
                ++count;
            }
    return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

}  // namespace

std::array<int, 3> colourChannels(const Image& image) {
    const std::array<int, 3> rgb{image.channel("R"), image.channel("G"), image.channel("B")};
    if (rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0) return rgb;
    const int grey = image.channels() == 1 ? 0 : image.channel("Y");
    if (grey >= 0) return {grey, grey, grey};
    throw Error(ErrorKind::BadInput, "an image has no channels R, G and B", sizeText(image) + " image",
                "give a colour image");
}

ImagePair::ImagePair(const Image& reference, const Image& image)
    : reference_(reference),
      image_(image),
      referenceChannels_(colourChannels(reference)),
      imageChannels_(colourChannels(image)),
      mask_(reference.channel("mask.Y")),
      relativeFloor_(0.01 * std::pow(meanOfFinite(reference, referenceChannels_), 2)) {
    if (reference.width() != image.width() || reference.height() != image.height())
        throw Error(ErrorKind::BadInput, "the images have different sizes",
                    sizeText(reference) + " and " + sizeText(image), "render both at the same --size");
}

}  // namespace pellucid

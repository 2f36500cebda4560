#include <pellucid/study/false_colour.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <pellucid/surface/texture.h>

namespace pellucid {
namespace {

/// Evenly spaced stops, sRGB-encoded bytes, after the colour map "magma" of N. Smith and S. van der Walt (CC0).
constexpr std::array<std::array<int, 3>, 10> kStops{{{0, 0, 4},
                                                     {24, 15, 62},
                                                     {69, 16, 119},
                                                     {114, 31, 129},
                                                     {159, 47, 127},
                                                     {205, 64, 113},
                                                     {241, 96, 93},
                                                     {253, 149, 103},
                                                     {254, 201, 141},
                                                     {252, 253, 191}}};

}  // namespace

Rgb falseColour(float value) noexcept {
    const float place = (value > 0.0F ? std::min(value, 1.0F) : 0.0F) * static_cast<float>(kStops.size() - 1);
    const auto stop = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
    const float share = place - static_cast<float>(stop);
    Rgb colour;
    for (int c = 0; c < 3; ++c) {
        const auto k = static_cast<std::size_t>(c);
        const auto from = static_cast<float>(kStops[stop][k]), to = static_cast<float>(kStops[stop + 1][k]);
        colour[c] = srgbToLinear(std::lerp(from, to, share) / 255.0F);
    }
    return colour;
}

Image falseColourImage(const Image& map) {
    Image image(map.width(), map.height(), {"R", "G", "B"});
    for (std::size_t pixel = 0; pixel < map.pixels(); ++pixel) image.setRgb(pixel, falseColour(map.at(pixel, 0)));
    return image;
}

}  // namespace pellucid

#include "patterns.h"

#include <cmath>

#include <glm/gtc/constants.hpp>

namespace scenes {

namespace {

std::uint8_t toByte(double value) {
    return static_cast<std::uint8_t>(std::lround(255.0 * glm::clamp(value, 0.0, 1.0)));
}

/// Calls pixel(x, y) for each pixel and keeps its bytes.
template <typename Function>
Pixels draw(int size, int channels, const Function& pixel) {
    Pixels pixels{size, size, channels, {}};
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const auto value = pixel(x, y);
            for (int channel = 0; channel < channels; ++channel) {
                pixels.bytes.push_back(value[channel]);
            }
        }
    }
    return pixels;
}

}  // namespace

Pixels checker(int size, int cells, const glm::u8vec3& even, const glm::u8vec3& odd) {
    return draw(size, 3, [&](int x, int y) { return (x * cells / size + y * cells / size) % 2 == 0 ? even : odd; });
}

Pixels leaf(int size) {
    return draw(size, 4, [&](int x, int y) {
        const double across = std::abs((x + 0.5) / size - 0.5), along = 1.0 - (y + 0.5) / size;
        const double halfWidth = 0.42 * std::sin(glm::pi<double>() * std::pow(along, 0.75));
        const bool rib = across < 0.025 || std::abs(std::fmod(8.0 * (along - 0.8 * across) + 8.0, 1.0)) < 0.12;
        const glm::u8vec3 color = rib ? glm::u8vec3(150, 190, 90) : glm::u8vec3(60, 130, 45);
        return glm::u8vec4(color, across < halfWidth ? 255 : 0);
    });
}

Pixels studs(int size, int count) {
    return draw(size, 3, [&](int x, int y) {
        // A stud is the height h(r) = depth (1 - r^2)^2 inside its cell's unit disc, whose slope vanishes at its edge.
        const auto inCell = [&](int i) { return 2.4 * (std::fmod((i + 0.5) * count / size, 1.0) - 0.5); };
        const double u = inCell(x), v = -inCell(y), inside = 1.0 - u * u - v * v;
        const double slope = inside > 0.0 ? -4.0 * 0.35 * inside : 0.0;
        const glm::dvec3 normal = glm::normalize(glm::dvec3(-slope * u, -slope * v, 1.0));
        return glm::u8vec3(toByte(0.5 + 0.5 * normal.x), toByte(0.5 + 0.5 * normal.y), toByte(0.5 + 0.5 * normal.z));
    });
}

Pixels roughnessBands(int size, int bands) {
    return draw(size, 3, [&](int x, int) {
        const int band = x * bands / size;
        return glm::u8vec3(255, toByte(0.12 + 0.5 * band / (bands - 1)), 255);
    });
}

}  // namespace scenes

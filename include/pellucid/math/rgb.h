/// Linear Rec.709 RGB. Radiance, irradiance and reflectance all use it; the unit is in the name of the variable.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

namespace pellucid {

using Rgb = glm::vec3;

[[nodiscard]] inline float luminance(const Rgb& c) noexcept { return 0.2126F * c.r + 0.7152F * c.g + 0.0722F * c.b; }
[[nodiscard]] inline float maxComponent(const Rgb& c) noexcept { return std::max(c.r, std::max(c.g, c.b)); }
[[nodiscard]] inline float average(const Rgb& c) noexcept { return (c.r + c.g + c.b) * (1.0F / 3.0F); }
[[nodiscard]] inline bool isBlack(const Rgb& c) noexcept { return c.r == 0.0F && c.g == 0.0F && c.b == 0.0F; }
[[nodiscard]] inline bool isFinite(const Rgb& c) noexcept {
    return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
}

}  // namespace pellucid

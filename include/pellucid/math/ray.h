/// A ray and the rule that keeps a new ray off the surface that it leaves.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/glm.hpp>

namespace pellucid {

struct Ray {
    glm::vec3 origin{0.0F};
    glm::vec3 direction{0.0F, 0.0F, 1.0F};                ///< unit length
    float tMax = std::numeric_limits<float>::infinity();  ///< distance where it ends, scene units
};

/// Moves `point` off its surface along `normal` (on the side that the new ray leaves to) by about one part in 65536 of
/// its size or, near the origin, by an absolute step. The constants assume a scene of unit scale. [WaechterBinder2019]
[[nodiscard]] inline glm::vec3 offsetOrigin(const glm::vec3& point, const glm::vec3& normal) noexcept {
    constexpr float kOrigin = 1.0F / 32.0F;
    constexpr float kFloatScale = 1.0F / 65536.0F;
    constexpr float kIntScale = 256.0F;
    glm::vec3 result;
    for (int i = 0; i < 3; ++i) {
        const auto steps = static_cast<std::int32_t>(kIntScale * normal[i]);
        const auto bits = std::bit_cast<std::int32_t>(point[i]);
        const float moved = std::bit_cast<float>(bits + (point[i] < 0.0F ? -steps : steps));
        result[i] = std::fabs(point[i]) < kOrigin ? point[i] + kFloatScale * normal[i] : moved;
    }
    return result;
}

}  // namespace pellucid

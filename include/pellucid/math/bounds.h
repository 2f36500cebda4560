/// Axis-aligned box.
#pragma once

#include <limits>

#include <glm/glm.hpp>

namespace pellucid {

struct Bounds {
    glm::vec3 lower{std::numeric_limits<float>::infinity()};
    glm::vec3 upper{-std::numeric_limits<float>::infinity()};

    void extend(const glm::vec3& p) noexcept {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    void extend(const Bounds& b) noexcept {
        lower = glm::min(lower, b.lower);
        upper = glm::max(upper, b.upper);
    }
    [[nodiscard]] bool empty() const noexcept { return lower.x > upper.x; }
    [[nodiscard]] glm::vec3 centre() const noexcept { return 0.5F * (lower + upper); }
    [[nodiscard]] glm::vec3 diagonal() const noexcept { return upper - lower; }
    /// Radius of the sphere around the box's corners.
    [[nodiscard]] float radius() const noexcept { return empty() ? 0.0F : 0.5F * glm::length(diagonal()); }
};

/// Whether two boxes share a point, be it of their faces.
[[nodiscard]] inline bool overlap(const Bounds& a, const Bounds& b) noexcept {
    return glm::all(glm::lessThanEqual(a.lower, b.upper)) && glm::all(glm::lessThanEqual(b.lower, a.upper));
}

}  // namespace pellucid

/// An orthonormal frame around a normal; local z is the normal.
#pragma once

#include <cmath>

#include <glm/glm.hpp>

namespace pellucid {

struct Frame {
    glm::vec3 tangent{1.0F, 0.0F, 0.0F};
    glm::vec3 bitangent{0.0F, 1.0F, 0.0F};
    glm::vec3 normal{0.0F, 0.0F, 1.0F};

    Frame() = default;

    /// Branch-free and continuous but for one seam. [Duff2017]
    explicit Frame(const glm::vec3& n) noexcept : normal(n) {
        const float sign = std::copysign(1.0F, n.z);
        const float a = -1.0F / (sign + n.z);
        const float b = n.x * n.y * a;
        tangent = {1.0F + sign * n.x * n.x * a, sign * b, -sign * n.x};
        bitangent = {b, sign + n.y * n.y * a, -n.y};
    }

    [[nodiscard]] glm::vec3 toWorld(const glm::vec3& v) const noexcept {
        return tangent * v.x + bitangent * v.y + normal * v.z;
    }
    [[nodiscard]] glm::vec3 toLocal(const glm::vec3& v) const noexcept {
        return {glm::dot(v, tangent), glm::dot(v, bitangent), glm::dot(v, normal)};
    }
};

}  // namespace pellucid

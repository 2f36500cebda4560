/// A point on a surface, as the intersection code hands it to shading. All vectors in normalised scene space.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace pellucid {

/// No material: air.
inline constexpr std::uint32_t kAir = 0xffffffffU;

struct SurfacePoint {
    glm::vec3 position{0.0F};
    /// Unit; by the triangle's winding (glTF: counter-clockwise is the front).
    glm::vec3 geometricNormal{0.0F, 0.0F, 1.0F};
    /// Unit, interpolated, on the same side as geometricNormal; not yet normal-mapped.
    glm::vec3 shadingNormal{0.0F, 0.0F, 1.0F};
    glm::vec3 tangent{1.0F, 0.0F, 0.0F};  ///< unit, for normal maps; zero when there is none
    float tangentSign = 1.0F;             ///< bitangent = sign * cross(shadingNormal, tangent)
    glm::vec2 uv[2]{};                    ///< of both sets, as glTF counts them
    glm::vec4 color{1.0F};                ///< of the vertices, linear: multiplies the base colour
    std::uint32_t geometry = 0, primitive = 0, material = 0;
    std::uint32_t beyond = kAir;  ///< material of the body that touches this face of glass from its front
    glm::vec2 barycentric{0.0F};  ///< weights of the triangle's second and third corner
};

}  // namespace pellucid

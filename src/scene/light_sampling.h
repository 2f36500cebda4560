/// What one finite light does by itself, without the choice among lights: the falloff of a spot, and points on a
/// triangle seen from a shading point with their density. Private to the room; Lights and LightChoice are built on
/// it.
#pragma once

#include <optional>

#include <glm/glm.hpp>

#include <pellucid/scene/lights.h>

namespace pellucid {

/// Closer to a punctual light than this (scene units, scene of radius about 1) there is no direction to it worth the
/// name.
inline constexpr float kMinDistance2 = 1e-16F;

/// KHR_lights_punctual: clamp((cos - cosOuter) / (cosInner - cosOuter), 0, 1)^2, of the angle to the spot's axis.
[[nodiscard]] inline float spotFalloff(const SpotEmitter& spot, float cosine) noexcept {
    if (cosine <= spot.cosOuter) return 0.0F;
    if (cosine >= spot.cosInner) return 1.0F;
    const float t = (cosine - spot.cosOuter) / (spot.cosInner - spot.cosOuter);
    return t * t;
}

/// Integrals of the falloff over solid angle: 2 pi (1 - cosInner) within the inner cone, 2 pi (cosInner - cosOuter) /
/// 3 around it.
struct SpotSolidAngle {
    double inner, outer;
    [[nodiscard]] double total() const noexcept { return inner + outer; }
};
[[nodiscard]] SpotSolidAngle spotSolidAngle(const SpotEmitter& spot) noexcept;

/// Cosine to the axis, drawn in exact proportion to the falloff. `u` in [0,1).
[[nodiscard]] float sampleSpotCosine(const SpotEmitter& spot, float u) noexcept;

/// A point of a triangle seen from a shading point.
struct TrianglePoint {
    glm::vec3 wi{0.0F};
    float distance = 0.0F;
    glm::vec2 barycentric{0.0F};  ///< weights of the second and third corner
    float cosLight = 0.0F;  ///< of the angle between the normal and the direction back to the shading point; signed
    float pdfSolidAngle = 0.0F;
};

/// Uniform in solid angle where the triangle looks large from `point`, uniform in area elsewhere: a function of the two
/// alone. Empty where the point lies in the plane of a triangle that looks large, and where the direction or its density is
/// not finite.
[[nodiscard]] std::optional<TrianglePoint> sampleTriangle(const EmissiveTriangle& triangle, const glm::vec3& point,
                                                          const glm::vec2& u) noexcept;

/// The density of sampleTriangle() for direction `wi`, which meets the triangle at `distance`; 0 where that is empty.
[[nodiscard]] float pdfTriangleSolidAngle(const EmissiveTriangle& triangle, const glm::vec3& point, const glm::vec3& wi,
                                          float distance) noexcept;

}  // namespace pellucid

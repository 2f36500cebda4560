/// From the unit square to directions and points. Every sampling function stands beside its pdf: the density, in the
/// measure that its name gives, with which the function makes that value; tests/statistical/warps_test.cpp compares
/// each pair.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

#include <pellucid/math/constants.h>

namespace pellucid {

/// Concentric map: keeps strata compact and areas equal. [ShirleyChiu1997]
[[nodiscard]] inline glm::vec2 sampleUniformDisc(const glm::vec2& u) noexcept {
    const float x = 2.0F * u.x - 1.0F, y = 2.0F * u.y - 1.0F;
    if (x == 0.0F && y == 0.0F) return glm::vec2{0.0F};
    const bool wide = std::fabs(x) > std::fabs(y);
    const float radius = wide ? x : y;
    const float angle = wide ? 0.25F * kPi * (y / x) : 0.5F * kPi - 0.25F * kPi * (x / y);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}
[[nodiscard]] inline float pdfAreaUniformDisc(const glm::vec2& p) noexcept {
    return glm::dot(p, p) <= 1.0F ? kInvPi : 0.0F;
}

/// Local z up, density cos / pi: the disc lifted to the hemisphere (Malley's method).
[[nodiscard]] inline glm::vec3 sampleCosineHemisphere(const glm::vec2& u) noexcept {
    const glm::vec2 p = sampleUniformDisc(u);
    return {p.x, p.y, std::sqrt(std::max(0.0F, 1.0F - glm::dot(p, p)))};
}
[[nodiscard]] inline float pdfSolidAngleCosineHemisphere(const glm::vec3& w) noexcept {
    return std::max(0.0F, w.z) * kInvPi;
}

[[nodiscard]] inline glm::vec3 sampleUniformHemisphere(const glm::vec2& u) noexcept {
    const float sine = std::sqrt(std::max(0.0F, u.y * (2.0F - u.y))), phi = kTwoPi * u.x;
    return {sine * std::cos(phi), sine * std::sin(phi), 1.0F - u.y};
}
[[nodiscard]] inline float pdfSolidAngleUniformHemisphere(const glm::vec3& w) noexcept {
    return w.z >= 0.0F ? 0.5F * kInvPi : 0.0F;
}

[[nodiscard]] inline glm::vec3 sampleUniformSphere(const glm::vec2& u) noexcept {
    const float sine = 2.0F * std::sqrt(std::max(0.0F, u.y * (1.0F - u.y))), phi = kTwoPi * u.x;
    return {sine * std::cos(phi), sine * std::sin(phi), 1.0F - 2.0F * u.y};
}
[[nodiscard]] inline float pdfSolidAngleUniformSphere() noexcept { return 0.25F * kInvPi; }

/// 1 - cos of an angle below 90 degrees from its squared sine; keeps its digits for cones of any smallness.
[[nodiscard]] inline float oneMinusCosine(float sin2) noexcept {
    return sin2 / (1.0F + std::sqrt(std::max(0.0F, 1.0F - sin2)));
}

/// Uniform over the cone around z whose half angle (up to 90 degrees) has the squared sine `sin2Max`.
[[nodiscard]] inline glm::vec3 sampleUniformCone(const glm::vec2& u, float sin2Max) noexcept {
    const float drop = u.y * oneMinusCosine(sin2Max);  // 1 - cos
    const float sine = std::sqrt(std::max(0.0F, drop * (2.0F - drop))), phi = kTwoPi * u.x;
    return {sine * std::cos(phi), sine * std::sin(phi), 1.0F - drop};
}
/// 1 / solid angle of the cone; infinite for an empty one.
[[nodiscard]] inline float pdfSolidAngleUniformCone(float sin2Max) noexcept {
    return 1.0F / (kTwoPi * oneMinusCosine(sin2Max));
}

/// Weights of a triangle's second and third corner, uniform over its area (the weight of the first is the rest to 1).
/// The square is folded at its diagonal, which keeps strata better than the root of u. [Heitz2019triangle]
[[nodiscard]] inline glm::vec2 sampleUniformTriangle(const glm::vec2& u) noexcept {
    if (u.y > u.x) return {0.5F * u.x, u.y - 0.5F * u.x};
    return {u.x - 0.5F * u.y, 0.5F * u.y};
}
[[nodiscard]] inline float pdfAreaUniformTriangle(float triangleArea) noexcept { return 1.0F / triangleArea; }

}  // namespace pellucid

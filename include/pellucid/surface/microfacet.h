/// The GGX distribution of facets, Smith's masking and the sampling of visible normals, in the local frame whose z is
/// the normal. Written without tangents and with sin^2 from x and y, so that alpha = 1e-3 and grazing directions keep
/// their digits.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

#include <pellucid/math/constants.h>

namespace pellucid {

[[nodiscard]] inline float sin2Theta(const glm::vec3& w) noexcept { return w.x * w.x + w.y * w.y; }

/// Density of facet area with normal h, per solid angle. [Walter2007, eq. 33]
[[nodiscard]] inline float ggxDistribution(const glm::vec3& h, float alpha) noexcept {
    const float a2 = alpha * alpha;
    const float t = sin2Theta(h) / a2 + h.z * h.z;
    return 1.0F / (kPi * a2 * t * t);
}

/// cos sqrt(1 + alpha^2 tan^2): Smith's Lambda is (ggxSlope / cos - 1) / 2. [Heitz2014, eq. 72] Never 0 for alpha > 0.
[[nodiscard]] inline float ggxSlope(const glm::vec3& w, float alpha) noexcept {
    return std::sqrt(w.z * w.z + alpha * alpha * sin2Theta(w));
}

/// Masking of one direction. [Heitz2014, eq. 43]
[[nodiscard]] inline float ggxG1(const glm::vec3& w, float alpha) noexcept {
    const float c = std::fabs(w.z);
    return 2.0F * c / (c + ggxSlope(w, alpha));
}

/// G2 / (4 |cos o| |cos i|) with the height-correlated G2 = 1 / (1 + Lambda_o + Lambda_i) [Heitz2014, eq. 99], used on
/// both sides of the surface; each cosine cancels, so grazing directions need no special case.
[[nodiscard]] inline float ggxVisibility(const glm::vec3& wo, const glm::vec3& wi, float alpha) noexcept {
    return 0.5F / (std::fabs(wo.z) * ggxSlope(wi, alpha) + std::fabs(wi.z) * ggxSlope(wo, alpha));
}

/// Density per solid angle of h among the normals visible from wo (wo.z > 0), divided by dot(wo, h). [Heitz2018, eq. 3]
[[nodiscard]] inline float ggxVisiblePdfOverDot(const glm::vec3& wo, float distribution, float alpha) noexcept {
    return 2.0F * distribution / (wo.z + ggxSlope(wo, alpha));
}

/// A normal visible from wo (wo.z > 0), by the spherical cap. [DupuyBenyoub2023, listing 3] The cap's sine comes from
/// factors of 1 - z^2 that do not cancel.
[[nodiscard]] inline glm::vec3 sampleGgxVisibleNormal(const glm::vec3& wo, float alpha, const glm::vec2& u) noexcept {
    const glm::vec3 w = glm::normalize(glm::vec3{alpha * wo.x, alpha * wo.y, wo.z});
    const float range = 1.0F + w.z;
    const float height = (1.0F - u.y) * range;
    const float z = height - w.z;
    const float sine = std::sqrt(std::max(0.0F, range * u.y * ((1.0F - w.z) + height)));
    const float phi = kTwoPi * u.x;
    return glm::normalize(
        glm::vec3{alpha * (w.x + sine * std::cos(phi)), alpha * (w.y + sine * std::sin(phi)), w.z + z});
}

}  // namespace pellucid

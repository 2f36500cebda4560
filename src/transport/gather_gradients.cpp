#include "gather_gradients.h"

#include <algorithm>
#include <cmath>

#include <pellucid/math/constants.h>

namespace pellucid {

namespace {

[[nodiscard]] constexpr float square(float x) noexcept { return x * x; }

}  // namespace

glm::vec3 meanSlope(const IrradianceRecord& record) noexcept {
    return (record.translation[0] + record.translation[1] + record.translation[2]) * (1.0F / 3.0F);
}

/// Rotational: dE = sum_k v(phi_k + pi/2) sum_j tan(theta_j) L_jk pi/(MN).
void addRotation(const GatherGrid& g, const Frame& frame, IrradianceRecord& record) {
    const float norm = kPi / static_cast<float>(g.elevations * g.azimuths);
    // The stratum's mean of tan(theta) over s = sin^2: int sqrt(s / (1 - s)) ds = asin(sqrt s) - sqrt(s (1 - s)).
    const auto meanTan = [m = static_cast<float>(g.elevations)](int border) {
        const float s = static_cast<float>(border) / m;
        return m * (std::asin(std::sqrt(s)) - std::sqrt(s * (1.0F - s)));
    };
    for (int k = 0; k < g.azimuths; ++k) {
        const float phi = kTwoPi * (static_cast<float>(k) + 0.5F) / static_cast<float>(g.azimuths);
        const glm::vec3 v = frame.toWorld({-std::sin(phi), std::cos(phi), 0.0F});
        Rgb sum(0.0F);
        for (int j = 0; j < g.elevations; ++j) {
            sum += (meanTan(j + 1) - meanTan(j)) * g.at(j, k).radiance;
        }
        for (glm::length_t c = 0; c < 3; ++c) record.rotation[static_cast<std::size_t>(c)] += v * (sum[c] * norm);
    }
}

/// Translational: the change of occlusion across the strata's borders, in elevation and in azimuth.
void addTranslation(const GatherGrid& g, const Frame& frame, float nearestKept, IrradianceRecord& record) {
    const auto m = static_cast<float>(g.elevations), n = static_cast<float>(g.azimuths);
    const auto lower = [m](int j) { return std::sqrt(static_cast<float>(j) / m); };  // sin(theta_j-)
    const auto cosine = [m](int j) {
        return std::sqrt(std::max(0.0F, 1.0F - static_cast<float>(j) / m));
    };  // cos(theta_j-)
    float noise = 0.0F;
    for (int k = 0; k < g.azimuths; ++k) {
        const int before = (k + g.azimuths - 1) % g.azimuths;
        const float phi = kTwoPi * (static_cast<float>(k) + 0.5F) / n, border = kTwoPi * static_cast<float>(k) / n;
        const glm::vec3 u = frame.toWorld({std::cos(phi), std::sin(phi), 0.0F});
        const glm::vec3 v = frame.toWorld({-std::sin(border), std::cos(border), 0.0F});
        Rgb radial(0.0F), around(0.0F);
        const auto add = [&noise](Rgb& sum, float factor, const Rgb& step) {
            sum += factor * step;
            noise += square(factor * average(step));
        };
        for (int j = 0; j < g.elevations; ++j) {
            const GatherCell& cell = g.at(j, k);
            if (j > 0) {
                const GatherCell& below = g.at(j - 1, k);
                const float nearest = std::max(nearestKept, std::min(cell.distance, below.distance));
                if (std::isfinite(nearest))
                    add(radial, (kTwoPi / n) * cosine(j) * cosine(j) * lower(j) / nearest,
                        cell.radiance - below.radiance);
            }
            const GatherCell& side = g.at(j, before);
            const float nearest = std::max(nearestKept, std::min(cell.distance, side.distance));
            const float sin2 = (static_cast<float>(j) + 0.5F) / m;
            if (std::isfinite(nearest))
                add(around, std::sqrt((1.0F - sin2) / sin2) * (cosine(j) - cosine(j + 1)) / nearest,
                    cell.radiance - side.radiance);
        }
        for (glm::length_t c = 0; c < 3; ++c)
            record.translation[static_cast<std::size_t>(c)] += u * radial[c] + v * around[c];
    }
    // Were every step across a border noise, the squared length would be about the sum of the squared steps: keep only what
    // exceeds it, as a positive-part James-Stein estimator does. [JamesStein1961]
    const float length2 = square(glm::length(meanSlope(record)));
    const float kept = length2 > 0.0F ? std::max(0.0F, 1.0F - noise / length2) : 0.0F;
    for (glm::vec3& t : record.translation) t *= kept;
}

}  // namespace pellucid

/// What a record keeps of its rays for mapped normals: exact for even light and for the record's own normal, near the integral
/// for light that varies over the hemisphere.
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/math/constants.h>
#include <pellucid/transport/light_by_direction.h>

namespace pellucid {
namespace {

using Light = std::function<double(const glm::dvec3&)>;

/// By azimuth and elevation, at the middles of the strata of a gather of this size.
[[nodiscard]] std::vector<Rgb> gatherOf(const Light& light, int elevations, int azimuths) {
    std::vector<Rgb> radiance;
    for (int k = 0; k < azimuths; ++k)
        for (int j = 0; j < elevations; ++j) {
            double sum = 0.0;
            constexpr int kInside = 8;
            for (int a = 0; a < kInside * kInside; ++a) {
                const double s = (j + (a % kInside + 0.5) / kInside) / elevations,
                             phi = 2.0 * kPiD * (k + (a / kInside + 0.5) / kInside) / azimuths;
                sum += light({std::sqrt(s) * std::cos(phi), std::sqrt(s) * std::sin(phi), std::sqrt(1.0 - s)});
            }
            radiance.emplace_back(static_cast<float>(sum / (kInside * kInside)));
        }
    return radiance;
}

/// E and E5 on `normal` of light from the upper hemisphere, by the midpoint rule.
[[nodiscard]] glm::dvec2 integral(const Light& light, const glm::dvec3& normal) {
    constexpr int kSteps = 400;
    glm::dvec2 sum(0.0);
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < 2 * kSteps; ++k) {
            const double z = (i + 0.5) / kSteps, r = std::sqrt(1.0 - z * z), phi = kPiD * (k + 0.5) / kSteps;
            const glm::dvec3 w(r * std::cos(phi), r * std::sin(phi), z);
            const double cosine = glm::dot(w, normal);
            if (cosine > 0.0) sum += glm::dvec2(1.0, std::pow(1.0 - cosine, 5.0)) * (light(w) * cosine);
        }
    return sum * (kPiD / (kSteps * kSteps));
}

[[nodiscard]] glm::dvec3 tilted(double angle, double phi) {
    return {std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi), std::cos(angle)};
}

TEST(LightByDirection, EvenLightIsExact) {
    const LightByDirection light = packByDirection(gatherOf([](const glm::dvec3&) { return 0.5; }, 6, 19), 6, 19,
                                                   7);  // 0.5: packed without rounding
    for (const double angle : {0.0, 0.3, 0.8, 1.4}) {
        const TurnedLight turned = turnLight(light, glm::vec3(tilted(angle, 1.1)));
        for (glm::length_t c = 0; c < 3; ++c)
            EXPECT_NEAR(turned.ratio[c], 0.5 * (1.0 + std::cos(angle)), 1e-4) << angle;
    }
}

TEST(LightByDirection, TheRecordsOwnNormalIsExactWhateverTheLight) {
    const Light light = [](const glm::dvec3& w) { return 0.1 + 3.0 * std::max(0.0, w.x * w.y) + w.z; };
    for (const int rays : {6, 9, 13}) {
        const TurnedLight turned =
            turnLight(packByDirection(gatherOf(light, rays, 3 * rays), rays, 3 * rays, 7), {0.0F, 0.0F, 1.0F});
        EXPECT_NEAR(turned.ratio.g, 1.0, 1e-4);
    }
}

TEST(LightByDirection, TurnsAsTheIntegralDoes) {
    const std::vector<Light> lights{[](const glm::dvec3& w) { return 1.0 + 0.8 * w.x; },
                                    [](const glm::dvec3& w) { return w.x > 0.3 ? 1.0 : 0.1; },
                                    [](const glm::dvec3& w) { return w.z < 0.4 ? 1.0 : 0.2 + w.y * w.y; }};
    for (const Light& light : lights) {
        const LightByDirection packed = packByDirection(gatherOf(light, 9, 28), 9, 28, 3);
        const double own = integral(light, {0, 0, 1}).x;
        for (const double angle : {0.2, 0.5, 0.8})
            for (const double phi : {0.0, 1.0, 2.5, 4.0}) {
                const glm::dvec3 normal = tilted(angle, phi);
                const glm::dvec2 expected = integral(light, normal);
                const TurnedLight turned = turnLight(packed, glm::vec3(normal));
                EXPECT_NEAR(turned.ratio.g, expected.x / own, 0.05 * expected.x / own) << angle << " " << phi;
                EXPECT_NEAR(turned.grazingShare.g, expected.y / expected.x, 0.02) << angle << " " << phi;
            }
    }
}

TEST(LightByDirection, NoLightIsNoLight) {
    const TurnedLight turned = turnLight(LightByDirection{}, glm::vec3(tilted(0.5, 0.0)));
    EXPECT_EQ(turned.ratio, Rgb(0.0F));
    EXPECT_TRUE(isSound(LightByDirection{}));
    LightByDirection bad;
    bad.bins[3] = 0xff010101U;  // an exponent that no colour has
    EXPECT_FALSE(isSound(bad));
}

}  // namespace
}  // namespace pellucid

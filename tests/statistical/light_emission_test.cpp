/// Photons' starts: total flux against closed forms, directions against their density, and photons from infinity
/// against the irradiance that they must make.
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/math/constants.h>
#include <pellucid/scene/lights.h>

#include "chi_square.h"

namespace pellucid {
namespace {

using testing::uniform;
using testing::uniform2;

EmissionNumbers numbers(std::mt19937_64& random) { return {uniform(random), uniform2(random), uniform2(random)}; }

Lights::Parts oneOfEach(const Environment* environment) {
    Lights::Parts parts;
    parts.points = {{{0.1F, 0.2F, 0.3F}, Rgb(1.0F)}};
    parts.spots = {{{0.0F, 0.5F, 0.0F}, glm::normalize(glm::vec3(0.3F, -1.0F, 0.2F)), Rgb(4.0F), 0.95F, 0.7F}};
    parts.directionals = {{glm::normalize(glm::vec3(0.2F, -1.0F, 0.4F)), Rgb(0.8F)}};
    for (const bool twoSided : {false, true}) {
        EmissiveTriangle t;
        t.corner[0] = {0.0F, 0.0F, 0.0F}, t.corner[1] = {0.5F, 0.0F, 0.0F}, t.corner[2] = {0.0F, 0.0F, 0.4F};
        t.normal = {0.0F, -1.0F, 0.0F};
        t.meanRadiance = Rgb(3.0F);
        t.twoSided = twoSided;
        parts.triangles.push_back(t);
    }
    parts.environment = environment;
    parts.sceneRadius = 1.5F;
    parts.sceneCentre = {0.2F, -0.1F, 0.3F};
    return parts;
}

/// point 4 pi I; spot the integral of the falloff; triangle pi A L a side; directional pi R^2 E; environment 4 pi^2
/// R^2 L.
std::vector<double> fluxes() {
    const double disc = kPiD * 2.25;
    return {4.0 * kPiD,       4.0 * 2.0 * kPiD * (0.05 + 0.25 / 3.0),
            kPiD * 0.1 * 3.0, 2.0 * kPiD * 0.1 * 3.0,
            disc * 0.8,       disc * 4.0 * kPiD * 0.5};
}

Environment constantSky() {
    EnvironmentDescription description;
    description.constant = Rgb(0.5F);
    return Environment(description);
}

TEST(LightEmission, FluxIsThatOfTheClosedForm) {
    const Environment sky = constantSky();
    const Lights lights(oneOfEach(&sky), nullptr, nullptr);
    const std::vector<double> expected = fluxes();
    ASSERT_EQ(lights.count(), expected.size());
    std::vector<double> sums(expected.size(), 0.0);
    double whole = 0.0;
    for (const double flux : expected) whole += flux;
    std::mt19937_64 random(1);
    constexpr int kSamples = 200000;
    for (int i = 0; i < kSamples; ++i) {
        const auto e = lights.sampleEmission(numbers(random));
        ASSERT_TRUE(e);
        ASSERT_NEAR(glm::length(e->ray.direction), 1.0F, 1e-5F);
        sums[e->light] += static_cast<double>(e->flux.g) / kSamples;
        // Power sampling of untextured lights: every photon carries the same power.
        ASSERT_NEAR(static_cast<double>(e->flux.g) / whole, 1.0, 1e-4);
    }
    for (std::uint32_t i = 0; i < expected.size(); ++i) {
        EXPECT_NEAR(lights.power(i) / expected[i], 1.0, 1e-5) << "light " << i;
        const double share = expected[i] / whole;
        EXPECT_NEAR(sums[i], expected[i], 4.5 * whole * std::sqrt(share * (1.0 - share) / kSamples)) << "light " << i;
        const auto alone = lights.sampleEmissionFrom(i, {0.3F, 0.6F}, {0.2F, 0.4F});
        ASSERT_TRUE(alone);
        EXPECT_EQ(alone->pmfLight, 1.0F);
        EXPECT_NEAR(static_cast<double>(alone->flux.g) / expected[i], 1.0, 1e-4);
    }
}

/// flux = Le cos / (p_position p_direction) with the emitted quantity written out for each kind.
TEST(LightEmission, FluxIsRadianceOverTheDensities) {
    const Environment sky = constantSky();
    const Lights::Parts parts = oneOfEach(&sky);
    const Lights lights(parts, nullptr, nullptr);
    std::mt19937_64 random(2);
    for (int i = 0; i < 6000; ++i) {
        const auto light = static_cast<std::uint32_t>(i % 6);
        const auto e = lights.sampleEmissionFrom(light, uniform2(random), uniform2(random));
        ASSERT_TRUE(e);
        float emitted = 0.0F;
        if (light == 0) emitted = 1.0F;
        if (light == 1) {
            const float t =
                std::clamp((glm::dot(e->ray.direction, parts.spots[0].direction) - 0.7F) / 0.25F, 0.0F, 1.0F);
            emitted = 4.0F * t * t;
            if (t < 0.05F) continue;  // the quotient of two tiny numbers in float
        }
        if (light == 2) emitted = -3.0F * e->ray.direction.y;
        if (light == 3) emitted = 3.0F * std::fabs(e->ray.direction.y);
        if (light == 4) emitted = 0.8F;
        if (light == 5) emitted = 0.5F;
        EXPECT_NEAR(emitted / (e->pdfPosition * e->pdfDirection) / e->flux.r, 1.0F, 2e-3F) << "light " << light;
    }
}

TEST(LightEmission, DirectionsFollowTheirDensity) {
    const Lights::Parts parts = oneOfEach(nullptr);
    const Lights lights(parts, nullptr, nullptr);
    const glm::vec3 axis = parts.spots[0].direction;
    const double solidAngle = 2.0 * kPiD * (0.05 + 0.25 / 3.0);
    const std::vector<std::function<double(const glm::vec3&)>> densities{
        [](const glm::vec3&) { return 0.25 / kPiD; },
        [&](const glm::vec3& w) {
            const double t = std::clamp((static_cast<double>(glm::dot(w, axis)) - 0.7) / 0.25, 0.0, 1.0);
            return t * t / solidAngle;
        },
        [](const glm::vec3& w) { return static_cast<double>(std::max(0.0F, -w.y)) / kPiD; },
        [](const glm::vec3& w) { return 0.5 * static_cast<double>(std::fabs(w.y)) / kPiD; }};
    for (std::uint32_t light = 0; light < 4; ++light) {
        const auto sample = [&](std::mt19937_64& random) -> std::optional<glm::vec3> {
            const auto e = lights.sampleEmissionFrom(light, uniform2(random), uniform2(random));
            return e ? std::optional(e->ray.direction) : std::nullopt;
        };
        const testing::SphereGrid grid{.axis = light == 1 ? axis : glm::vec3(0.0F, 1.0F, 0.0F)};
        const auto result = testing::chiSquareTest(sample, densities[light], grid, 200000, 50 + light);
        EXPECT_NEAR(result.mass, 1.0, 1e-4) << "light " << light;
        EXPECT_GT(result.pValue, testing::sidakLevel(4)) << "light " << light;
    }
}

/// A small disc anywhere in the scene's sphere receives pi L on each side from a constant sky and E cos from a
/// directional light.
TEST(LightEmission, PhotonsFromInfinityMakeTheRightIrradiance) {
    const Environment sky = constantSky();
    Lights::Parts parts = oneOfEach(&sky);
    parts.points.clear(), parts.spots.clear(), parts.triangles.clear();
    const Lights lights(parts, nullptr, nullptr);
    const glm::vec3 centre = parts.sceneCentre + glm::vec3(0.0F, 1.1F, 0.3F),
                    normal = glm::normalize(glm::vec3(0.4F, 1.0F, 0.0F));
    constexpr float kRadius = 0.3F;
    constexpr int kSamples = 400000;
    const double area = kPiD * 0.09;
    const double expected[2] = {0.8 * static_cast<double>(-glm::dot(parts.directionals[0].direction, normal)),
                                2.0 * kPiD * 0.5};
    for (std::uint32_t light = 0; light < 2; ++light) {
        std::mt19937_64 random(8 + light);
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < kSamples; ++i) {
            const auto e = lights.sampleEmissionFrom(light, uniform2(random), uniform2(random));
            ASSERT_TRUE(e);
            ASSERT_GT(glm::length(e->ray.origin - parts.sceneCentre), parts.sceneRadius);
            const float t = glm::dot(centre - e->ray.origin, normal) / glm::dot(e->ray.direction, normal);
            if (t < 0.0F || glm::length(e->ray.origin + t * e->ray.direction - centre) > kRadius) continue;
            const double value = static_cast<double>(e->flux.r) / area;
            sum += value;
            squares += value * value;
        }
        const double mean = sum / kSamples, error = std::sqrt((squares / kSamples - mean * mean) / kSamples);
        EXPECT_NEAR(mean, expected[light], 4.5 * error) << "light " << light;
        EXPECT_LT(error, 0.02 * mean);
    }
}

}  // namespace
}  // namespace pellucid

// Every warp against its pdf twin, and the chi^2 test itself against a pdf that is wrong on purpose.

#include <pellucid/math/warps.h>

#include <gtest/gtest.h>

#include "chi_square.h"

namespace pellucid {
namespace {

using testing::chiSquareTest;
using testing::SphereGrid;
using testing::uniform2;

constexpr int kTests = 8;
constexpr int kSamples = 400000;

template <typename Sample, typename Pdf>
testing::ChiSquareResult run(Sample sample, Pdf pdf, std::uint64_t seed, const SphereGrid& grid = {}) {
    return chiSquareTest([&](std::mt19937_64& r) { return std::optional<glm::vec3>(sample(uniform2(r))); },
                         [&](const glm::vec3& w) { return static_cast<double>(pdf(w)); }, grid, kSamples, seed);
}

TEST(Warps, CosineHemisphere) {
    const auto result = run(sampleCosineHemisphere, pdfSolidAngleCosineHemisphere, 1);
    EXPECT_NEAR(result.mass, 1.0, 1e-4);
    EXPECT_GT(result.pValue, testing::sidakLevel(kTests));
}

TEST(Warps, UniformHemisphere) {
    const auto result = run(sampleUniformHemisphere, pdfSolidAngleUniformHemisphere, 2);
    EXPECT_NEAR(result.mass, 1.0, 1e-4);
    EXPECT_GT(result.pValue, testing::sidakLevel(kTests));
}

TEST(Warps, UniformSphere) {
    const auto result = run(
        sampleUniformSphere, [](const glm::vec3&) { return pdfSolidAngleUniformSphere(); }, 3);
    EXPECT_NEAR(result.mass, 1.0, 1e-4);
    EXPECT_GT(result.pValue, testing::sidakLevel(kTests));
}

TEST(Warps, UniformCone) {
    // Half angle at the border of the third of 24 rings, so that no cell is cut.
    const float angle = kPi * 3.0F / 24.0F, sin2 = std::sin(angle) * std::sin(angle);
    const auto result =
        run([&](const glm::vec2& u) { return sampleUniformCone(u, sin2); },
            [&](const glm::vec3& w) { return w.z >= std::cos(angle) ? pdfSolidAngleUniformCone(sin2) : 0.0F; }, 4);
    EXPECT_NEAR(result.mass, 1.0, 1e-3);
    EXPECT_GT(result.pValue, testing::sidakLevel(kTests));
}

TEST(Warps, TinyConeKeepsItsDigits) {
    for (const double sine : {1e-2, 1e-4, 1e-6, 1e-9}) {
        const auto sin2 = static_cast<float>(sine * sine);
        EXPECT_NEAR(pdfSolidAngleUniformCone(sin2) * kPiD * sine * sine, 1.0, 1e-4) << sine;
        double meanSin2 = 0.0;
        for (int i = 0; i < 64; ++i) {
            const glm::vec3 w = sampleUniformCone({0.3F, (static_cast<float>(i) + 0.5F) / 64.0F}, sin2);
            meanSin2 += (static_cast<double>(w.x) * w.x + static_cast<double>(w.y) * w.y) / 64.0;
        }
        EXPECT_NEAR(meanSin2 / (sine * sine), 0.5, 1e-3) << sine;
    }
    EXPECT_NEAR(pdfSolidAngleUniformCone(1.0F), 1.0F / kTwoPi, 1e-6F);  // a hemisphere
}

/// Counts in equal-area cells of the plane against equal expectation.
double planePValue(const std::vector<double>& counts, double samples) {
    const std::vector<double> expected(counts.size(), samples / static_cast<double>(counts.size()));
    return testing::compareCounts(expected, counts).pValue;
}

TEST(Warps, UniformDisc) {
    std::mt19937_64 random(5);
    std::vector<double> counts(16 * 16);
    for (int i = 0; i < kSamples; ++i) {
        const glm::vec2 p = sampleUniformDisc(uniform2(random));
        ASSERT_LE(glm::dot(p, p), 1.0F + 1e-6F);
        const double ring = std::min(15.0, std::floor(16.0 * static_cast<double>(glm::dot(p, p))));
        const double angle = (std::atan2(p.y, p.x) / (2.0 * kPiD) + 0.5) * 16.0;
        counts[static_cast<std::size_t>(ring * 16.0 + std::min(15.0, std::floor(angle)))] += 1.0;
    }
    EXPECT_GT(planePValue(counts, kSamples), testing::sidakLevel(kTests));
    EXPECT_FLOAT_EQ(pdfAreaUniformDisc({0.5F, 0.5F}), kInvPi);
    EXPECT_EQ(pdfAreaUniformDisc({0.8F, 0.8F}), 0.0F);
}

TEST(Warps, UniformTriangle) {
    // Equal areas: strips of the triangle x + y < 1 in v = x + y (area v^2) and the ratio x / v.
    std::mt19937_64 random(6);
    std::vector<double> counts(16 * 16);
    for (int i = 0; i < kSamples; ++i) {
        const glm::vec2 b = sampleUniformTriangle(uniform2(random));
        ASSERT_GE(b.x, 0.0F);
        ASSERT_GE(b.y, 0.0F);
        ASSERT_LE(b.x + b.y, 1.0F);
        const double v = static_cast<double>(b.x) + static_cast<double>(b.y);
        const double row = std::min(15.0, std::floor(16.0 * v * v));
        const double column = v > 0.0 ? std::min(15.0, std::floor(16.0 * static_cast<double>(b.x) / v)) : 0.0;
        counts[static_cast<std::size_t>(row * 16.0 + column)] += 1.0;
    }
    EXPECT_GT(planePValue(counts, kSamples), testing::sidakLevel(kTests));
    EXPECT_FLOAT_EQ(pdfAreaUniformTriangle(0.25F), 4.0F);
}

TEST(ChiSquare, TailMatchesTables) {
    EXPECT_NEAR(testing::chiSquareTail(3.841459, 1), 0.05, 1e-6);
    EXPECT_NEAR(testing::chiSquareTail(23.20925, 10), 0.01, 1e-6);
    EXPECT_NEAR(testing::chiSquareTail(2.0, 2), std::exp(-1.0), 1e-12);
    EXPECT_NEAR(testing::chiSquareTail(149.4493, 100), 0.001, 1e-6);
}

TEST(ChiSquare, RejectsWrongDensity) {
    // cos^1.05 instead of cos: of the right mass, wrong by 5 % at the pole.
    const auto result = run(
        sampleCosineHemisphere,
        [](const glm::vec3& w) { return w.z > 0.0F ? std::pow(w.z, 1.05F) * 2.05F / kTwoPi : 0.0F; }, 7);
    EXPECT_NEAR(result.mass, 1.0, 1e-4);
    EXPECT_LT(result.pValue, 1e-6);
}

TEST(ChiSquare, RejectsWrongMass) {
    const auto result = run(
        sampleUniformSphere, [](const glm::vec3&) { return 0.98F * pdfSolidAngleUniformSphere(); }, 8);
    EXPECT_LT(result.pValue, 1e-6);
}

}  // namespace
}  // namespace pellucid

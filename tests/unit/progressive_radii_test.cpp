/// Radii by what a pixel has met: the statistics of progressive photon mapping, and the test that decides instead.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/math/constants.h>
#include <pellucid/transport/progressive_radii.h>

namespace pellucid {
namespace {

[[nodiscard]] KernelTally met(std::uint32_t photons) {
    KernelTally t;
    t.photons = photons;
    return t;
}

/// The recursion as it is printed, with its own tau, against the mean of the iterations' estimates that the film keeps.
TEST(ProgressiveRadii, TheMeanOfTheIterationsIsTauOverTheLastDisc) {
    constexpr double kAlpha = 0.7, kFirst = 0.3;
    ProgressiveRadii radii(1, Shrink::Alpha, kAlpha);
    std::mt19937 random(3);
    double n = 0.0, r2 = kFirst * kFirst, tau = 0.0, sum = 0.0;
    constexpr int kIterations = 200;
    for (int i = 0; i < kIterations; ++i) {
        const double radius = kFirst * static_cast<double>(radii.scale(0));
        EXPECT_NEAR(radius * radius / r2, 1.0, 1e-5);
        const auto m = static_cast<std::uint32_t>(random() % 40);
        double phi = 0.0;
        for (std::uint32_t k = 0; k < m; ++k) phi += 1.0 + static_cast<double>(random() % 5);
        sum += phi / (kPiD * radius * radius);
        if (m > 0) {
            const double ratio = (n + kAlpha * m) / (n + m);
            tau = (tau + phi) * ratio;
            r2 *= ratio;
            n += kAlpha * m;
        }
        radii.update(0, met(m));
    }
    EXPECT_NEAR(tau / (kPiD * r2) / sum, 1.0, 1e-5);
}

/// Of even light a disc holds photons in proportion to its area.
TEST(ProgressiveRadii, InEvenLightItIsTheCommonSchedule) {
    constexpr double kAlpha = 2.0 / 3.0;
    ProgressiveRadii radii(2, Shrink::Alpha, kAlpha);
    double expected = 1.0;
    for (int i = 1; i < 1000; ++i) {
        const double area = std::pow(static_cast<double>(radii.scale(0)), 2.0);
        radii.update(0, met(static_cast<std::uint32_t>(std::lround(1e6 * area))));
        radii.update(1, met(0));
        expected *= (i - 1.0 + kAlpha) / i;
        EXPECT_NEAR(std::pow(static_cast<double>(radii.scale(0)), 2.0) / expected, 1.0, 2e-4);
    }
    EXPECT_EQ(radii.scale(1), 1.0F);  // nothing met, nothing learnt
}

/// Photons in the unit disc with density proportional to `f`, by rejection; powers of 1 and 3.
template <class Function>
[[nodiscard]] KernelTally disc(std::mt19937& random, int photons, const Function& f) {
    std::uniform_real_distribution<float> u(-1.0F, 1.0F);
    KernelTally tally;
    const Frame frame(glm::vec3(0.0F, 0.0F, 1.0F));
    while (tally.photons < static_cast<std::uint32_t>(photons)) {
        const glm::vec3 p(u(random), u(random), 0.0F);
        const float part = glm::dot(p, p);
        if (part >= 1.0F || u(random) + 1.0F > 2.0F * f(p)) continue;
        tally.add(frame, p, part, random() % 4 == 0 ? 3.0F : 1.0F);
    }
    return tally;
}

TEST(KernelTally, ChiSquareOfEvenLightHasItsDistributionAlsoForUnequalPhotons) {
    std::mt19937 random(11);
    constexpr int kTrials = 4000;
    double sum = 0.0;
    int beyond = 0;
    for (int i = 0; i < kTrials; ++i) {
        const double chi = disc(random, 120, [](const glm::vec3&) { return 1.0F; }).chiSquare();
        sum += chi;
        if (chi > 14.067) ++beyond;  // p = 0.05
    }
    // Mean 7 and variance 14 of the chi^2 distribution, four standard errors.
    EXPECT_NEAR(sum / kTrials, 7.0, 4.0 * std::sqrt(14.0 / kTrials));
    EXPECT_NEAR(static_cast<double>(beyond) / kTrials, 0.05, 0.015);
}

TEST(KernelTally, ChiSquareSeesAnEdge) {
    std::mt19937 random(12);
    int seen = 0;
    for (int i = 0; i < 200; ++i)
        if (disc(random, 120, [](const glm::vec3& p) { return p.x > 0.2F ? 1.0F : 0.2F; }).chiSquare() > 18.475) ++seen;
    EXPECT_GT(seen, 195);
}

/// By the test a radius stays where light is even, but for the few tests that err, and goes on shrinking where it is not.
TEST(ProgressiveRadii, ByTestOnlyUnevenLightShrinks) {
    constexpr std::size_t kPixels = 200;
    ProgressiveRadii radii(2 * kPixels, Shrink::ChiSquare, 2.0 / 3.0);
    std::mt19937 random(13);
    for (int i = 0; i < 100; ++i)
        for (std::size_t pixel = 0; pixel < kPixels; ++pixel) {
            radii.update(pixel, disc(random, 20, [](const glm::vec3&) { return 1.0F; }));
            radii.update(kPixels + pixel,
                         disc(random, 20, [](const glm::vec3& p) { return p.x > 0.0F ? 1.0F : 0.3F; }));
        }
    double even = 0.0, uneven = 0.0;
    for (std::size_t pixel = 0; pixel < kPixels; ++pixel) {
        even += static_cast<double>(radii.scale(pixel)) / kPixels;
        uneven += static_cast<double>(radii.scale(kPixels + pixel)) / kPixels;
    }
    EXPECT_GT(even, 0.97);
    EXPECT_LT(uneven, 0.2);
}

TEST(ProgressiveRadii, StateGoesThroughACheckpoint) {
    for (const Shrink by : {Shrink::Alpha, Shrink::ChiSquare}) {
        ProgressiveRadii a(3, by, 0.7), b(3, by, 0.7), other(2, by, 0.7);
        std::mt19937 random(14);
        const auto add = [&](ProgressiveRadii& radii, std::uint32_t seed) {
            std::mt19937 numbers(seed);
            for (std::size_t p = 0; p < 3; ++p)
                radii.update(p, disc(numbers, 30, [](const glm::vec3& at) { return at.x > 0.0F ? 1.0F : 0.1F; }));
        };
        for (std::uint32_t i = 0; i < 5; ++i) add(a, i);
        const std::vector<char> bytes = a.save();
        EXPECT_FALSE(other.restore(bytes.data(), bytes.size()));
        ASSERT_TRUE(b.restore(bytes.data(), bytes.size()));
        for (std::uint32_t i = 5; i < 12; ++i) add(a, i), add(b, i);
        for (std::size_t p = 0; p < 3; ++p) EXPECT_EQ(a.scale(p), b.scale(p));
        EXPECT_LT(a.scale(0), 1.0F);
    }
}

}  // namespace
}  // namespace pellucid

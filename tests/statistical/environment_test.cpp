/// The environment's mapping, its mean, and its sampler against its own density: for smooth maps, maps with one burning
/// texel, maps of one texel, and maps so large that the tables work on cells of several texels.
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/math/constants.h>
#include <pellucid/math/distribution.h>
#include <pellucid/scene/environment.h>

#include "chi_square.h"

namespace pellucid {
namespace {

using testing::uniform;
using testing::uniform2;

template <class Texel>
Environment makeMap(int width, int height, Texel&& texel) {
    EnvironmentDescription description;
    description.map = Image(width, height, {"R", "G", "B"});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            description.map.setRgb(
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x),
                texel(x, y));
    return Environment(std::move(description));
}

Environment roughMap(unsigned seed) {
    std::mt19937_64 random(seed);
    return makeMap(16, 8, [&](int, int) {
        return Rgb(std::pow(uniform(random), 6.0F), std::pow(uniform(random), 8.0F),
                   uniform(random) > 0.9F ? 5.0F : 0.0F);
    });
}

glm::vec3 direction(double cosTheta, double phi) {
    const double sine = std::sqrt(1.0 - cosTheta * cosTheta);
    return glm::vec3(sine * std::cos(phi), cosTheta, sine * std::sin(phi));
}

/// Calls f(direction, solid angle) on a fine grid of the sphere that is uniform in theta.
template <class Function>
void overSphere(int rows, Function&& f) {
    for (int j = 0; j < rows; ++j) {
        const double top = std::cos(kPiD * j / rows), bottom = std::cos(kPiD * (j + 1) / rows);
        for (int i = 0; i < 2 * rows; ++i)
            f(direction(0.5 * (top + bottom), kPiD * ((i + 0.5) / rows - 1.0)), (top - bottom) * kPiD / rows);
    }
}

TEST(Distribution1D, DrawsByWeightAndSkipsEmptyEntries) {
    const std::vector<double> weights{0.0, 1.0, 0.0, 0.0, 3.0, 1e-12, 0.0};
    const Distribution1D d(weights);
    EXPECT_EQ(d.size(), 7U);
    EXPECT_DOUBLE_EQ(d.pmf(4), 3.0 / d.total());
    EXPECT_EQ(d.sample(0.0).index, 1U);
    EXPECT_EQ(d.sample(0.2499).index, 1U);
    EXPECT_EQ(d.sample(0.2501).index, 4U);
    EXPECT_NEAR(d.sample(0.625).remapped, 0.5, 1e-9);
    EXPECT_EQ(d.sample(1.0 - 0x1p-53).index, 5U);
    for (int i = 0; i < 1000; ++i) {
        const IntervalSample s = d.sample(i / 1000.0);
        EXPECT_GT(d.pmf(s.index), 0.0);
        EXPECT_GE(s.remapped, 0.0);
        EXPECT_LT(s.remapped, 1.0);
    }
}

TEST(Environment, CentreColumnLooksAlongXAndRowZeroIsUp) {
    const Environment map =
        makeMap(8, 4, [](int x, int y) { return Rgb(static_cast<float>(x), static_cast<float>(y), 1.0F); });
    EXPECT_NEAR(map.radiance({0.0F, 1.0F, 0.0F}).g, 0.0F, 1e-6F);
    EXPECT_NEAR(map.radiance({0.0F, -1.0F, 0.0F}).g, 3.0F, 1e-6F);
    EXPECT_NEAR(map.radiance({1.0F, 0.0F, 0.0F}).r, 3.5F, 1e-5F);   // between columns 3 and 4
    EXPECT_NEAR(map.radiance({0.0F, 0.0F, 1.0F}).r, 5.5F, 1e-5F);   // u = 3/4
    EXPECT_NEAR(map.radiance({-1.0F, 0.0F, 0.0F}).r, 3.5F, 1e-5F);  // between columns 7 and 0
    EXPECT_NEAR(map.radiance({1.0F, 0.0F, 0.0F}).g, 1.5F, 1e-5F);
}

TEST(Environment, MeanIsTheIntegralOfTheInterpolation) {
    const std::vector<Environment> maps{roughMap(3), makeMap(1, 1, [](int, int) { return Rgb(2.0F); }),
                                        makeMap(3, 2, [](int x, int y) { return Rgb(static_cast<float>(x + 2 * y)); })};
    for (const Environment& map : maps) {
        glm::dvec3 sum(0.0);
        overSphere(500,
                   [&](const glm::vec3& d, double solidAngle) { sum += glm::dvec3(map.radiance(d)) * solidAngle; });
        sum /= 4.0 * kPiD;
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(static_cast<double>(map.meanRadiance()[k]), sum[k], 2e-5 + 1e-4 * sum[k]);
    }
}

/// Pearson's test over a grid of the sphere; the density, piecewise constant, is integrated by midpoints that fit its
/// texels.
void expectSamplesFollowPdf(const Environment& map, int rows, int samples, unsigned seed) {
    std::mt19937_64 random(seed);
    const int columns = 2 * rows, fine = 24;
    const auto cells = static_cast<std::size_t>(rows * columns);
    std::vector<double> expected(cells, 0.0), observed(cells, 0.0);
    overSphere(rows * fine, [&](const glm::vec3& d, double solidAngle) {
        const auto row = std::min(rows - 1, static_cast<int>(std::acos(static_cast<double>(d.y)) / kPiD * rows));
        const auto column =
            std::min(columns - 1, static_cast<int>((0.5 + std::atan2(d.z, d.x) / (2.0 * kPiD)) * columns));
        expected[static_cast<std::size_t>(row * columns + column)] +=
            static_cast<double>(map.pdf(d)) * solidAngle * samples;
    });
    double total = 0.0;
    for (const double e : expected) total += e;
    EXPECT_NEAR(total / samples, 1.0, 1e-3);
    for (int i = 0; i < samples; ++i) {
        const auto s = map.sample(uniform2(random));
        ASSERT_TRUE(s.has_value());
        ASSERT_NEAR(glm::length(s->direction), 1.0F, 1e-5F);
        const auto row =
            std::min(rows - 1, static_cast<int>(std::acos(static_cast<double>(s->direction.y)) / kPiD * rows));
        const auto column = std::min(
            columns - 1, static_cast<int>((0.5 + std::atan2(s->direction.z, s->direction.x) / (2.0 * kPiD)) * columns));
        observed[static_cast<std::size_t>(row * columns + column)] += 1.0;
    }
    const testing::ChiSquareResult result = testing::compareCounts(expected, observed);
    EXPECT_GT(result.pValue, testing::sidakLevel(3)) << result.cells << " cells";
}

TEST(Environment, SamplesFollowTheDensity) {
    expectSamplesFollowPdf(roughMap(5), 16, 200000, 11);
    expectSamplesFollowPdf(makeMap(1, 1, [](int, int) { return Rgb(1.0F); }), 8, 100000, 12);
    EnvironmentDescription constant;
    constant.constant = Rgb(0.2F, 0.5F, 0.1F);
    expectSamplesFollowPdf(Environment(constant), 8, 100000, 13);
}

/// The estimate radiance / pdf against 4 pi times the mean, and pdf() against the density that sample() reports.
void expectUnbiased(const Environment& map, int samples, double relativeDeviation, unsigned seed) {
    std::mt19937_64 random(seed);
    double sum = 0.0, squares = 0.0;
    int differing = 0;
    for (int i = 0; i < samples; ++i) {
        const auto s = map.sample(uniform2(random));
        ASSERT_TRUE(s && s->pdfSolidAngle > 0.0F);
        const auto value = static_cast<double>(average(map.radiance(s->direction)) / s->pdfSolidAngle);
        sum += value;
        squares += value * value;
        differing += std::fabs(map.pdf(s->direction) / s->pdfSolidAngle - 1.0F) > 1e-4F ? 1 : 0;
    }
    const double mean = sum / samples, deviation = std::sqrt(squares / samples - mean * mean);
    const double expected = 4.0 * kPiD * static_cast<double>(average(map.meanRadiance()));
    EXPECT_NEAR(mean / expected, 1.0, 1e-5 + 5.0 * deviation / expected / std::sqrt(samples));
    EXPECT_LT(deviation, relativeDeviation * expected);
    EXPECT_LT(differing, samples / 200);  // only directions rounded across a texel's edge
}

TEST(Environment, EstimatesItsIntegralWithLittleVariance) {
    expectUnbiased(roughMap(6), 100000, 0.9, 21);
    const auto burning = [](int width, int height, int row) {
        return makeMap(width, height, [=](int x, int y) { return Rgb(x == width - 1 && y == row ? 1e6F : 1e-4F); });
    };
    expectUnbiased(burning(1024, 512, 150), 100000, 1.1, 22);
    expectUnbiased(burning(512, 256, 0), 100000, 1.3, 23);      // at the pole
    expectUnbiased(burning(4200, 2100, 700), 100000, 1.1, 24);  // cells of 2 x 2 texels
    expectUnbiased(makeMap(1, 1, [](int, int) { return Rgb(3.0F); }), 1000, 1e-5, 25);
    expectUnbiased(makeMap(2, 1, [](int x, int) { return Rgb(static_cast<float>(x)); }), 100000, 0.6, 26);
}

TEST(Environment, BlackIsNeverSampled) {
    EXPECT_FALSE(Environment(EnvironmentDescription{}).sample({0.3F, 0.4F}));
    const Environment map = makeMap(4, 2, [](int, int) { return Rgb(0.0F); });
    EXPECT_TRUE(map.black());
    EXPECT_FALSE(map.sample({0.3F, 0.4F}));
    EXPECT_EQ(map.pdf({0.0F, 1.0F, 0.0F}), 0.0F);
}

TEST(Environment, PolesAndExtremesStayFinite) {
    const Environment map = makeMap(64, 32, [](int, int y) { return Rgb(y == 0 ? 1e30F : 1e-30F); });
    for (const glm::vec3 d :
         {glm::vec3(0.0F, 1.0F, 0.0F), glm::vec3(0.0F, -1.0F, 0.0F), glm::vec3(-1.0F, 0.0F, -0.0F)}) {
        EXPECT_TRUE(isFinite(map.radiance(d)));
        EXPECT_TRUE(std::isfinite(map.pdf(d)));
    }
    for (const float u : {0.0F, kOneMinusEpsilon})
        for (const float v : {0.0F, kOneMinusEpsilon}) {
            const auto s = map.sample({u, v});
            ASSERT_TRUE(s);
            EXPECT_TRUE(isFinite(s->direction) && std::isfinite(s->pdfSolidAngle));
        }
}

}  // namespace
}  // namespace pellucid

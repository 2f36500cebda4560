// Synthetic renders with known bias and variance: the estimates' intervals hold them, and equal methods are not told
// apart. Everything is keyed, so a pass is a pass for good.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/math/hash.h>
#include <pellucid/study/statistics.h>

namespace pellucid {
namespace {

constexpr int kTrials = 1000, kSeeds = 8, kWidth = 24, kHeight = 16;

/// Standard normal numbers keyed by a counter [BoxMuller1958].
class Normals {
public:
    explicit Normals(std::uint64_t key) : key_(key) {}
    [[nodiscard]] double next() {
        const double u = uniform(), v = uniform();
        return std::sqrt(-2.0 * std::log(u)) * std::cos(6.283185307179586 * v);
    }

private:
    [[nodiscard]] double uniform() {
        return (static_cast<double>(hashCombine(key_, counter_++) >> 11U) + 0.5) * 0x1.0p-53;
    }
    std::uint64_t key_, counter_ = 0;
};

/// A scene of gradients; bias and noise vary over the image. A share of the noise is common to blocks of pixels, as a
/// cache's is.
struct Synthetic {
    double bias = 0.0, noise = 0.0, common = 0.0, referenceNoise = 0.0;
    int block = 4;

    [[nodiscard]] static double truth(int x, int y) { return 0.2 + 0.05 * x + 0.03 * y; }
    [[nodiscard]] double biasAt(int x, int y) const { return bias * (x % 3 == 0 ? -1.0 : 0.5) * (1.0 + 0.02 * y); }
    [[nodiscard]] double sigmaAt(int x) const { return noise * (0.5 + 0.05 * x); }

    [[nodiscard]] Image reference(std::uint64_t key) const {
        Normals normals(key);
        Image image(kWidth, kHeight, {"R", "G", "B", "variance.R", "variance.G", "variance.B"});
        fill(image, [&](int x, int y) { return truth(x, y) + referenceNoise * normals.next(); });
        for (std::size_t p = 0; p < image.pixels(); ++p)
            for (int c = 3; c < 6; ++c) image.at(p, c) = static_cast<float>(referenceNoise * referenceNoise);
        return image;
    }

    [[nodiscard]] Image render(std::uint64_t key) const {
        Normals normals(key);
        const int blocksX = (kWidth + block - 1) / block, blocksY = (kHeight + block - 1) / block;
        std::vector<double> shared(static_cast<std::size_t>(blocksX * blocksY));
        for (double& z : shared) z = normals.next();
        Image image(kWidth, kHeight, {"R", "G", "B"});
        fill(image, [&](int x, int y) {
            const double z = shared[static_cast<std::size_t>(y / block * blocksX + x / block)];
            const double e = std::sqrt(1.0 - common) * normals.next() + std::sqrt(common) * z;
            return truth(x, y) + biasAt(x, y) + sigmaAt(x) * e;
        });
        return image;
    }

    /// The mean over the image of the square of `value`.
    [[nodiscard]] static double meanSquare(const std::function<double(int, int)>& value) {
        double sum = 0.0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) sum += value(x, y) * value(x, y);
        return sum / (kWidth * kHeight);
    }
    [[nodiscard]] double trueBiasSquared() const {
        return meanSquare([this](int x, int y) { return biasAt(x, y); });
    }
    [[nodiscard]] double trueVariance() const {
        return meanSquare([this](int x, int) { return sigmaAt(x); });
    }

private:
    static void fill(Image& image, const std::function<double(int, int)>& value) {
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                for (int c = 0; c < 3; ++c)
                    image.at(static_cast<std::size_t>(y * kWidth + x), c) = static_cast<float>(value(x, y));
    }
};

[[nodiscard]] bool holds(const Interval& interval, double truth) {
    return interval.low <= truth && truth <= interval.high;
}

struct Coverage {
    int bias = 0, variance = 0;
    double meanBias = 0.0, meanVariance = 0.0;
};

[[nodiscard]] Coverage coverageOf(const Synthetic& synthetic, std::uint64_t key) {
    const SeedBootstrap bootstrap(kSeeds);
    Coverage coverage;
    for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
        const std::uint64_t trialKey = hashCombine(key, trial);
        const Image reference = synthetic.reference(hashCombine(trialKey, 1000));
        std::vector<Image> images;
        for (std::uint64_t seed = 0; seed < kSeeds; ++seed)
            images.push_back(synthetic.render(hashCombine(trialKey, seed)));
        const ErrorProducts errors = errorProducts(reference, images, false);
        const Interval bias = bootstrap.interval([&](SeedCounts c) { return biasSquared(errors, c); });
        const Interval variance = bootstrap.interval([&](SeedCounts c) { return errorVariance(errors, c); });
        coverage.bias += holds(bias, synthetic.trueBiasSquared()) ? 1 : 0;
        coverage.variance += holds(variance, synthetic.trueVariance()) ? 1 : 0;
        coverage.meanBias += bias.value / kTrials;
        coverage.meanVariance += variance.value / kTrials;
    }
    return coverage;
}

void expectRecovered(const std::string& name, const Synthetic& synthetic, std::uint64_t key) {
    const Coverage coverage = coverageOf(synthetic, key);
    const double b2 = synthetic.trueBiasSquared(), v = synthetic.trueVariance();
    std::printf("%-22s bias^2 in %d of %d, variance in %d\n", name.c_str(), coverage.bias, kTrials, coverage.variance);
    EXPECT_GE(coverage.bias, 95 * kTrials / 100) << name;
    EXPECT_GE(coverage.variance, 95 * kTrials / 100) << name;
    EXPECT_NEAR(coverage.meanBias, b2, 0.05 * b2 + 0.005 * v) << name;
    EXPECT_NEAR(coverage.meanVariance, v, 0.02 * v) << name;
}

TEST(Compare, KnownBiasAndVarianceAreRecovered) {
    expectRecovered("noise alone", {.bias = 0.0, .noise = 0.1}, 1);
    expectRecovered("mostly bias", {.bias = 0.1, .noise = 0.03}, 2);
    expectRecovered("both", {.bias = 0.05, .noise = 0.1}, 3);
    expectRecovered("correlated pixels", {.bias = 0.05, .noise = 0.1, .common = 0.3}, 4);
    expectRecovered("noisy reference", {.bias = 0.05, .noise = 0.1, .referenceNoise = 0.01}, 5);
}

/// relmse of one seed of a method, log-normal as measured ones nearly are.
[[nodiscard]] std::vector<double> figuresOf(std::uint64_t key, double shift) {
    Normals normals(key);
    std::vector<double> logs(kSeeds);
    for (double& value : logs) value = std::log(0.01) + shift + 0.1 * normals.next();
    return logs;
}

TEST(Compare, EqualMethodsDifferAtMostAtTheDeclaredRate) {
    constexpr int kFamilies = 400, kTimes = 4;
    int alarms = 0, found = 0;
    for (std::uint64_t family = 0; family < kFamilies; ++family) {
        std::vector<double> equal, different;
        for (std::uint64_t time = 0; time < kTimes; ++time) {
            const std::uint64_t key = hashCombine(family, time);
            const std::vector<double> a = figuresOf(hashCombine(key, 1), 0.0);
            equal.push_back(permutationTest(a, figuresOf(hashCombine(key, 2), 0.0)));
            different.push_back(permutationTest(a, figuresOf(hashCombine(key, 3), 0.4)));
        }
        for (const double p : holmAdjusted(equal))
            if (p <= 0.05) {
                ++alarms;
                break;
            }
        for (const double p : holmAdjusted(different)) found += p <= 0.05 ? 1 : 0;
    }
    std::printf("false alarms in %d of %d families; true differences found: %d of %d\n", alarms, kFamilies, found,
                kFamilies * kTimes);
    // 5 % are declared: 20 expected, and 33 or more would come by chance once in 300.
    EXPECT_LE(alarms, 32);
    EXPECT_GE(found, kFamilies * kTimes * 9 / 10);
}

TEST(Compare, TheSameImagesNeverDiffer) {
    const std::vector<double> a = figuresOf(7, 0.0);
    EXPECT_EQ(permutationTest(a, a), 1.0);
}

}  // namespace
}  // namespace pellucid

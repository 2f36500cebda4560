#include "sample_shares.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <pellucid/math/hash.h>

namespace pellucid {

namespace {

/// Few samples know little of a pixel's variance: it is taken over a neighbourhood.
constexpr int kNeighbours = 3;
/// Of a pixel's own variance, beside its neighbours'.
constexpr float kOwnShare = 0.25F;
/// A pixel this many times noisier than is usual around it has met something rare. Its neighbours are as likely to meet it:
/// what is above counts for all of a wider neighbourhood, part of the image's shorter side.
constexpr float kRare = 10.0F;
constexpr int kWide = 8;
constexpr float kFloor = 0.01F;  ///< of relmse, in squares of the mean
/// The kernels' bias is about as large as the photons' noise, squared, and falls more slowly.
constexpr double kBiasAndNoise = 3.0;
constexpr double kMostWeight = 16.0;  ///< of an iteration beside the one before
constexpr std::array<double, 7> kPhotons{0.125, 0.25, 0.5, 0.7, 1.0, 1.4, 2.0};
constexpr std::array<float, 7> kMeans{1.0F, 1.5F, 2.0F, 3.0F, 4.0F, 6.0F, 8.0F};

/// Means over rows of 2 `reach` + 1 values, cut at the ends; the result lies transposed.
[[nodiscard]] std::vector<float> blurredRows(const std::vector<float>& value, int width, int height, int reach) {
    std::vector<float> result(value.size());
    std::vector<double> sums(static_cast<std::size_t>(width) + 1, 0.0);
    for (int y = 0; y < height; ++y) {
        const float* row = value.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
        for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x)
            sums[x + 1] = sums[x] + static_cast<double>(row[x]);
        for (int x = 0; x < width; ++x) {
            const int first = std::max(0, x - reach), end = std::min(width, x + reach + 1);
            const double sum = sums[static_cast<std::size_t>(end)] - sums[static_cast<std::size_t>(first)];
            result[static_cast<std::size_t>(x) * static_cast<std::size_t>(height) + static_cast<std::size_t>(y)] =
                static_cast<float>(std::max(0.0, sum) / (end - first));
        }
    }
    return result;
}

[[nodiscard]] std::vector<float> blurred(const std::vector<float>& value, int width, int height, int reach) {
    return blurredRows(blurredRows(value, width, height, reach), height, width, reach);
}

/// Variance of each pixel as far as it is usual around it; `rare` becomes what is above. The usual is measured by square roots,
/// which a single pixel hardly moves.
[[nodiscard]] std::vector<float> usualPart(const std::vector<float>& own, int width, int height,
                                           std::vector<float>& rare) {
    std::vector<float> usual(own.size());
    rare.assign(own.size(), 0.0F);
    for (std::size_t i = 0; i < own.size(); ++i) usual[i] = std::sqrt(own[i]);
    const std::vector<float> around = blurred(usual, width, height, kNeighbours);
    for (std::size_t i = 0; i < own.size(); ++i) {
        usual[i] = std::min(own[i], kRare * around[i] * around[i]);
        rare[i] = own[i] - usual[i];
    }
    return usual;
}

struct Need {
    std::vector<float> relative;  ///< eye variance of a sample / (L^2 + e2)
    std::vector<float> rays;
    std::vector<float> wish;  ///< sqrt(relative / rays)
    double photons = 0.0;     ///< sum of the photons' relative variance
};

[[nodiscard]] Need needOf(const std::vector<PixelNoise>& noise, int width, int height) {
    double mean = 0.0, inside = 0.0;
    for (const PixelNoise& p : noise)
        if (p.inside) mean += static_cast<double>(p.luminance), inside += 1.0;
    mean /= std::max(1.0, inside);
    const float floor = std::max(kFloor * static_cast<float>(mean * mean), 1e-30F);
    Need need;
    std::vector<float> own(noise.size());
    need.rays.resize(noise.size());
    for (std::size_t i = 0; i < noise.size(); ++i) {
        const PixelNoise& p = noise[i];
        const float reference = p.luminance * p.luminance + floor;
        own[i] = p.inside ? p.eyeVariance / reference : 0.0F;
        need.rays[i] = std::max(1.0F, p.rays);
        if (p.inside) need.photons += static_cast<double>(p.photonVariance / reference);
    }
    std::vector<float> rare;
    const std::vector<float> usual = usualPart(own, width, height, rare);
    rare = blurred(rare, width, height, std::max(kNeighbours, std::min(width, height) / kWide));
    need.relative = blurred(usual, width, height, kNeighbours);
    for (std::size_t i = 0; i < noise.size(); ++i)
        need.relative[i] =
            noise[i].inside ? (1.0F - kOwnShare) * need.relative[i] + kOwnShare * usual[i] + rare[i] : 0.0F;
    need.wish.resize(noise.size());
    for (std::size_t i = 0; i < noise.size(); ++i) need.wish[i] = std::sqrt(need.relative[i] / need.rays[i]);
    return need;
}

/// Real-valued samples of a pixel when the price of a ray's worth of variance is `scale`.
[[nodiscard]] float wanted(const Need& need, std::size_t i, float scale, float most) {
    return std::clamp(scale * need.wish[i], 1.0F, most);
}

struct Allotment {
    float scale = 0.0F;
    double photons = 1.0;
    double cost = 0.0;  ///< (photons' + eye's variance) x (photons' + eye's rays)
};

[[nodiscard]] Allotment allot(const std::vector<PixelNoise>& noise, const Need& need, double mean,
                              const ShareLimits& limits) {
    double inside = 0.0;
    for (const PixelNoise& p : noise) inside += p.inside ? 1.0 : 0.0;
    float low = 1e-6F, high = 1e12F;
    for (int step = 0; step < 24; ++step) {
        const float middle = std::sqrt(low) * std::sqrt(high);
        double samples = 0.0;
        for (std::size_t i = 0; i < noise.size(); ++i)
            if (noise[i].inside) samples += static_cast<double>(wanted(need, i, middle, limits.mostOfPixel));
        (samples < mean * inside ? low : high) = middle;
    }
    Allotment result{mean > 1.0 ? low : 0.0F};
    double variance = 0.0, rays = 0.0;
    for (std::size_t i = 0; i < noise.size(); ++i) {
        if (!noise[i].inside) continue;
        const float k = wanted(need, i, result.scale, limits.mostOfPixel);
        variance += static_cast<double>(need.relative[i] / k);
        rays += static_cast<double>(need.rays[i] * k);
    }
    for (const double f : kPhotons) {
        if (limits.fixedPhotons && f != 1.0) continue;
        const double cost = (kBiasAndNoise * need.photons / f + variance) * (f * limits.photonRays + rays);
        if (result.cost == 0.0 || cost < result.cost) result.cost = cost, result.photons = f;
    }
    return result;
}

/// Sum over pixels of the relative variance of an iteration.
[[nodiscard]] double varianceOf(const Need& need, const std::vector<std::uint8_t>& samples, double photons) {
    double sum = need.photons / photons;
    for (std::size_t i = 0; i < samples.size(); ++i)
        sum += static_cast<double>(need.relative[i]) / std::max<double>(1.0, samples[i]);
    return sum;
}

}  // namespace

SampleShares sampleShares(const std::vector<PixelNoise>& noise, const std::vector<std::uint8_t>& before, int width,
                          int height, const ShareLimits& limits, std::uint64_t seed) {
    const Need need = needOf(noise, width, height);
    Allotment best;
    for (const float mean : kMeans) {
        if (mean > limits.mostMean && mean > 1.0F) break;
        const Allotment a = allot(noise, need, static_cast<double>(mean), limits);
        if (mean == 1.0F || a.cost < best.cost) best = a;
    }
    SampleShares shares{std::vector<std::uint8_t>(noise.size(), 1), best.photons};
    for (std::size_t i = 0; i < noise.size(); ++i) {
        if (!noise[i].inside) continue;
        const float k = wanted(need, i, best.scale, limits.mostOfPixel), whole = std::floor(k);
        const float u = static_cast<float>(hash64(seed + i) >> 40U) * 0x1p-24F;
        shares.ofPixel[i] = static_cast<std::uint8_t>(whole + (u < k - whole ? 1.0F : 0.0F));
    }
    const double now = varianceOf(need, shares.ofPixel, shares.photons);
    if (now > 0.0) shares.lessNoise = std::clamp(varianceOf(need, before, 1.0) / now, 1.0 / kMostWeight, kMostWeight);
    return shares;
}

}  // namespace pellucid

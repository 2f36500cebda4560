/// What can be said from K independent renders of one image: bias^2 and variance apart, intervals by bootstrap over the
/// seeds, tests between methods, and the figures of an error-against-time curve.
///
/// Only the seeds are independent: a cache or a photon map correlates the pixels of one render. So everything here works
/// on K x K numbers (seeds), never on pixels.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <pellucid/math/image.h>

namespace pellucid {

/// An estimate with its 95 % interval; the ends are NaN where no interval can be given (one seed only). Infinite values
/// are allowed: a time that is never reached.
struct Interval {
    double value = 0.0, low = 0.0, high = 0.0;
};

constexpr double kConfidence = 0.95;

enum class IntervalScale { Linear, Log };

/// How often each seed is drawn in one resample; the counts sum to the number of seeds.
using SeedCounts = std::span<const int>;

/// Resamples of the seeds, the same for every statistic, so that ratios and curves are resampled jointly.
class SeedBootstrap {
public:
    static constexpr int kResamples = 4000;
    explicit SeedBootstrap(int seeds, std::uint64_t key = 0, int resamples = kResamples);

    [[nodiscard]] int seeds() const noexcept { return seeds_; }

    /// statistic(SeedCounts) -> double. The estimate plus and minus t_{K-1} sqrt(K/(K-1)) standard deviations of the
    /// resamples: exact for a mean of normal numbers, where the plain percentile interval of 8 seeds holds the truth in
    /// 88 % only. On the scale Log the same is done with logarithms (errors, times and ratios, above 0 always). Where a
    /// resample is not finite, percentiles moved out by the same factors take the place [Hesterberg2015, sec. 5.3].
    template <class Statistic>
    [[nodiscard]] Interval interval(Statistic&& statistic, IntervalScale scale = IntervalScale::Linear) const {
        const std::vector<int> once(static_cast<std::size_t>(seeds_), 1);
        std::vector<double> values;
        values.reserve(resamples_.size());
        if (seeds_ > 1)
            for (const std::vector<int>& counts : resamples_)
                if (const double v = statistic(SeedCounts(counts)); !std::isnan(v)) values.push_back(v);
        return ends(statistic(SeedCounts(once)), std::move(values), scale);
    }

private:
    [[nodiscard]] Interval ends(double estimate, std::vector<double> values, IntervalScale scale) const;
    int seeds_;
    std::vector<std::vector<int>> resamples_;
};

/// Mean of one value a seed, the seeds drawn as `counts` says.
[[nodiscard]] double countedMean(std::span<const double> values, SeedCounts counts) noexcept;

/// The products of the K error images: g_ij = mean over pixels and channels of w (I_i - R)(I_j - R), with w = 1 or
/// w = 1/(R^2 + 0.01 mean(R)^2). All of bias^2, variance and MSE follow from them, without a pass over the pixels.
struct ErrorProducts {
    int seeds = 0;
    std::vector<double> products;  ///< K x K, symmetric
    double referenceNoise = 0.0;   ///< mean of w Var_R; 0 when unknown

    [[nodiscard]] double at(int i, int j) const noexcept {
        return products[static_cast<std::size_t>(i) * static_cast<std::size_t>(seeds) + static_cast<std::size_t>(j)];
    }
};

/// Mean over the seeds of g_ii: relmse (or MSE), bias, variance and the reference's noise together.
[[nodiscard]] double meanSquaredError(const ErrorProducts& errors, SeedCounts counts) noexcept;
/// V = s^2 averaged, in the form half the mean square of I_i - I_j over the pairs of different seeds: it stays unbiased in a
/// resample, where a seed that was drawn twice differs from itself by nothing. NaN with fewer than two different seeds.
[[nodiscard]] double errorVariance(const ErrorProducts& errors, SeedCounts counts) noexcept;
/// b^2 = (mean I - R)^2 - s^2/K - Var_R averaged, which is the mean squared error less V and Var_R. A small bias may come out
/// negative: noise, not an error.
[[nodiscard]] double biasSquared(const ErrorProducts& errors, SeedCounts counts) noexcept;

/// Products of the colours of each image less the reference's; pixels that the reference's mask.Y
/// leaves out and values that are not finite count nowhere. `relative` chooses the weight w. `prefix` names the layer:
/// "" for R G B, "direct." for a path class (the weight stays that of the whole image, so classes compare).
[[nodiscard]] ErrorProducts errorProducts(const Image& reference, std::span<const Image> images, bool relative,
                                          std::string_view prefix = "");

/// Per-pixel maps over the seeds, one channel "Y" each, relative to sqrt(R^2 + 0.01 mean(R)^2), mean over the colours:
struct SeedMaps {
    Image bias;       ///< (mean I - R): signed, with the noise of K seeds in it
    Image deviation;  ///< s, the standard deviation of one render
};
[[nodiscard]] SeedMaps seedMaps(const Image& reference, std::span<const Image> images);

/// Quantile of Student's t with `degrees` >= 1 degrees of freedom.
[[nodiscard]] double studentQuantile(double probability, int degrees);

/// Two-sided p-value that two samples come from one distribution, by permutation of the difference of means: exact, so
/// that p <= a happens at most with probability a when they do. All splits when they are few, else 9999 at random.
[[nodiscard]] double permutationTest(std::span<const double> a, std::span<const double> b);

/// p-values adjusted for the family [Holm1979]: comparing them with 0.05 keeps the chance of any false alarm below it.
[[nodiscard]] std::vector<double> holmAdjusted(std::span<const double> p);

/// Seconds after which the curve first has sqrt(relmse) <= error, by log-log interpolation between its points. The first
/// point's seconds when it is there already; infinite when it never is. Points in order of time.
[[nodiscard]] double timeToError(std::span<const double> seconds, std::span<const double> relmse,
                                 double error) noexcept;

/// Least-squares slope of log relmse over log seconds; NaN with fewer than two points above 0.
[[nodiscard]] double logLogSlope(std::span<const double> seconds, std::span<const double> relmse) noexcept;

}  // namespace pellucid

#include <pellucid/study/statistics.h>

#include <limits>
#include <numbers>
#include <numeric>

#include <pellucid/math/hash.h>

namespace pellucid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMostSplits = 20000.0;  // up to here every split of a permutation test is tried
constexpr int kRandomSplits = 9999;
constexpr double kTellingShare = 0.75;  // of the resamples that must give a number

/// A stream of uniform integers keyed by a number: the same on every machine, unlike the distributions of <random>.
class KeyedStream {
public:
    explicit KeyedStream(std::uint64_t key) : key_(key) {}
    /// Uniform in [0, bound).
    [[nodiscard]] std::size_t below(std::size_t bound) noexcept {
        const std::uint64_t high = hashCombine(key_, counter_++) >> 32U;
        return static_cast<std::size_t>((high * bound) >> 32U);
    }

private:
    std::uint64_t key_, counter_ = 0;
};

[[nodiscard]] double normalCdf(double x) noexcept { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

/// P(T <= t) of Student's distribution with whole degrees of freedom [AbramowitzStegun 26.7.3, 26.7.4].
[[nodiscard]] double studentCdf(double t, int degrees) noexcept {
    const double theta = std::atan(t / std::sqrt(static_cast<double>(degrees)));
    const double c2 = std::cos(theta) * std::cos(theta);
    const bool odd = degrees % 2 == 1;
    double term = odd ? std::cos(theta) : 1.0, sum = degrees == 1 ? 0.0 : term;
    for (int k = odd ? 3 : 2; k <= degrees - 2; k += 2) {
        term *= c2 * (k - 1) / k;
        sum += term;
    }
    const double inside = odd ? 2.0 / std::numbers::pi * (theta + std::sin(theta) * sum) : std::sin(theta) * sum;
    return 0.5 * (1.0 + inside);
}

/// The value below which the share `rank` of the sorted values lies, between neighbours where both are finite.
[[nodiscard]] double percentile(const std::vector<double>& sorted, double rank) {
    const double place = rank * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const double low = sorted[below], high = sorted[std::min(below + 1, sorted.size() - 1)];
    if (!std::isfinite(low) || !std::isfinite(high)) return place - static_cast<double>(below) > 0.5 ? high : low;
    return std::lerp(low, high, place - static_cast<double>(below));
}

[[nodiscard]] double standardDeviation(const std::vector<double>& values) noexcept {
    const double n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double squares = 0.0;
    for (const double v : values) squares += (v - mean) * (v - mean);
    return std::sqrt(squares / n);
}

/// Number of ways to choose k of n, as far as a double holds it.
[[nodiscard]] double binomial(std::size_t n, std::size_t k) noexcept {
    double ways = 1.0;
    for (std::size_t i = 1; i <= k; ++i) ways *= static_cast<double>(n - k + i) / static_cast<double>(i);
    return ways;
}

/// Difference of means when the places marked true are the first sample.
[[nodiscard]] double splitDifference(const std::vector<double>& pooled, const std::vector<bool>& first) noexcept {
    double sums[2] = {};
    std::size_t counts[2] = {};
    for (std::size_t i = 0; i < pooled.size(); ++i) {
        sums[first[i] ? 0 : 1] += pooled[i];
        ++counts[first[i] ? 0 : 1];
    }
    return std::abs(sums[0] / static_cast<double>(counts[0]) - sums[1] / static_cast<double>(counts[1]));
}

}  // namespace

SeedBootstrap::SeedBootstrap(int seeds, std::uint64_t key, int resamples) : seeds_(seeds) {
    KeyedStream stream(hashCombine(key, static_cast<std::uint64_t>(seeds)));
    const auto count = static_cast<std::size_t>(seeds);
    resamples_.assign(static_cast<std::size_t>(resamples), std::vector<int>(count, 0));
    for (std::vector<int>& counts : resamples_)
        for (std::size_t draw = 0; draw < count; ++draw) ++counts[stream.below(count)];
}

Interval SeedBootstrap::ends(double estimate, std::vector<double> values, IntervalScale scale) const {
    // Where many resamples say nothing (two seeds: half of them hold one seed twice, the others are all the same), no
    // interval is better than a false one.
    const double telling = static_cast<double>(values.size()) / static_cast<double>(resamples_.size());
    if (seeds_ < 2 || telling < kTellingShare) return {estimate, kNan, kNan};
    const double reach = std::sqrt(seeds_ / (seeds_ - 1.0)) * studentQuantile(0.5 + 0.5 * kConfidence, seeds_ - 1);
    if (!std::isfinite(estimate) || !std::ranges::all_of(values, [](double v) { return std::isfinite(v); })) {
        std::ranges::sort(values);
        const double tail = normalCdf(-reach);
        return {estimate, std::min(estimate, percentile(values, tail)),
                std::max(estimate, percentile(values, 1.0 - tail))};
    }
    const bool inLog =
        scale == IntervalScale::Log && estimate > 0.0 && std::ranges::all_of(values, [](double v) { return v > 0.0; });
    if (inLog) std::ranges::transform(values, values.begin(), [](double v) { return std::log(v); });
    const double distance = reach * standardDeviation(values);
    if (inLog) return {estimate, estimate * std::exp(-distance), estimate * std::exp(distance)};
    return {estimate, estimate - distance, estimate + distance};
}

double countedMean(std::span<const double> values, SeedCounts counts) noexcept {
    double sum = 0.0;
    int total = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (counts[i] == 0) continue;  // 0 times infinity is no number
        sum += counts[i] * values[i];
        total += counts[i];
    }
    return total == 0 ? kNan : sum / total;
}

double studentQuantile(double probability, int degrees) {
    double low = -1e6, high = 1e6;
    for (int step = 0; step < 200 && high - low > 1e-12 * std::max(1.0, std::abs(low)); ++step) {
        const double middle = 0.5 * (low + high);
        (studentCdf(middle, degrees) < probability ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double permutationTest(std::span<const double> a, std::span<const double> b) {
    if (a.size() < 2 || b.size() < 2) return 1.0;
    std::vector<double> pooled(a.begin(), a.end());
    pooled.insert(pooled.end(), b.begin(), b.end());
    std::vector<bool> first(pooled.size(), false);
    std::fill_n(first.begin(), a.size(), true);
    // Splits whose difference is the observed one up to rounding count as at least as large.
    const double seen = splitDifference(pooled, first) * (1.0 - 1e-12);
    double asLarge = 0.0, tried = 0.0;
    if (binomial(pooled.size(), a.size()) <= kMostSplits) {
        do {
            asLarge += splitDifference(pooled, first) >= seen ? 1.0 : 0.0;
            tried += 1.0;
        } while (std::prev_permutation(first.begin(), first.end()));
        return asLarge / tried;
    }
    KeyedStream stream(pooled.size());
    for (int split = 0; split < kRandomSplits; ++split) {
        for (std::size_t i = pooled.size() - 1; i > 0; --i) std::swap(pooled[i], pooled[stream.below(i + 1)]);
        asLarge += splitDifference(pooled, first) >= seen ? 1.0 : 0.0;
    }
    return (asLarge + 1.0) / (kRandomSplits + 1.0);
}

std::vector<double> holmAdjusted(std::span<const double> p) {
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, [&p](std::size_t x, std::size_t y) { return p[x] < p[y]; });
    std::vector<double> adjusted(p.size());
    double largest = 0.0;
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        largest = std::max(largest, std::min(1.0, static_cast<double>(p.size() - rank) * p[order[rank]]));
        adjusted[order[rank]] = largest;
    }
    return adjusted;
}

double timeToError(std::span<const double> seconds, std::span<const double> relmse, double error) noexcept {
    const double target = error * error;
    for (std::size_t i = 0; i < seconds.size(); ++i) {
        if (!(relmse[i] <= target)) continue;
        if (i == 0 || !(relmse[i] > 0.0) || !(seconds[i - 1] > 0.0)) return seconds[i];
        const double share = std::log(relmse[i - 1] / target) / std::log(relmse[i - 1] / relmse[i]);
        return seconds[i - 1] * std::pow(seconds[i] / seconds[i - 1], share);
    }
    return kInfinity;
}

double logLogSlope(std::span<const double> seconds, std::span<const double> relmse) noexcept {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, firstX = kNan, firstY = kNan;
    for (std::size_t i = 0; i < seconds.size(); ++i) {
        if (!(seconds[i] > 0.0) || !(relmse[i] > 0.0)) continue;
        if (n == 0.0) firstX = std::log(seconds[i]), firstY = std::log(relmse[i]);
        // From the first point on: an error that stays the same has the slope 0 exactly.
        const double lx = std::log(seconds[i]) - firstX, ly = std::log(relmse[i]) - firstY;
        n += 1.0;
        x += lx;
        y += ly;
        xx += lx * lx;
        xy += lx * ly;
    }
    const double spread = xx - x * x / n;
    return n < 2.0 || !(spread > 1e-12 * xx) ? kNan : (xy - x * y / n) / spread;
}

}  // namespace pellucid

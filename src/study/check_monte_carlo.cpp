// What every lecture on Monte Carlo says, measured with the renderer's own sampler where it has one.
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <pellucid/math/constants.h>
#include <pellucid/math/sampler.h>
#include <pellucid/math/warps.h>

#include "check_cases.h"
#include "check_measure.h"
#include "check_random.h"

namespace pellucid::check {

namespace {

/// A smooth function of the square with a bend, as lighting has it; its integral is 4 / pi^2 + 1/4.
[[nodiscard]] double integrand(double x, double y) {
    const double s = std::sin(kPiD * x) * std::sin(kPiD * y);
    return s + (x + y > 1.0 ? 1.5 * (x + y - 1.0) : 0.0);
}
constexpr double kIntegral = 4.0 / (kPiD * kPiD) + 0.25;

enum class Points { Independent, Stratified, Sobol };

/// Mean of `root` x `root` samples.
[[nodiscard]] double meanOf(Points kind, int root, std::uint64_t seed) {
    Independent random(seed);
    double sum = 0.0;
    const int n = root * root;
    for (int i = 0; i < n; ++i) {
        double x = random.next(), y = random.next();
        if (kind == Points::Stratified) x = (i % root + x) / root, y = (i / root + y) / root;
        if (kind == Points::Sobol) {
            Sampler sampler(seed, 7, static_cast<std::uint32_t>(i));
            const glm::vec2 u = sampler.next2D();
            x = static_cast<double>(u.x), y = static_cast<double>(u.y);
        }
        sum += integrand(x, y);
    }
    return sum / n;
}

[[nodiscard]] double meanSquareError(Points kind, int root, std::uint64_t seed) {
    constexpr int kRuns = 400;
    double sum = 0.0;
    for (int run = 0; run < kRuns; ++run) {
        const double error = meanOf(kind, root, hashCombine(seed, static_cast<std::uint64_t>(run))) - kIntegral;
        sum += error * error;
    }
    return sum / kRuns;
}

/// log2 of the fall of the mean square error from `low`^2 to `high`^2 samples, a factor of 2 in N.
[[nodiscard]] double slope(Points kind, int low, int high, std::uint64_t seed) {
    return std::log(meanSquareError(kind, high, seed) / meanSquareError(kind, low, hash64(seed))) /
           (2.0 * std::log(static_cast<double>(high) / low));
}

std::vector<Finding> convergence(const CheckContext& context) {
    std::vector<Finding> all;
    all.push_back(measureSeeds(context, "exponent of the variance, independent samples", -1.0, 0.02, 0.1,
                               [](std::uint64_t s) { return slope(Points::Independent, 8, 64, s); }));
    // Strata of a function of bounded slope: N^-2 in two dimensions. [Mitchell1996]
    all.push_back(measureSeeds(context, "exponent of the variance, stratified samples", -2.0, 0.05, 0.2,
                               [](std::uint64_t s) { return slope(Points::Stratified, 8, 64, s); }));
    return all;
}

/// The order of the three at 16 and 256 samples, as ratios of mean square errors: not above 1.
std::vector<Finding> ordering(const CheckContext& context) {
    std::vector<Finding> all;
    for (const int root : {4, 16}) {
        const auto ratio = [root](Points a, Points b, std::uint64_t s) {
            return meanSquareError(a, root, s) / meanSquareError(b, root, hash64(s));
        };
        const auto atMost1 = [&](const std::string& what, Points a, Points b) {
            Finding f = measureSeeds(context, fmt::format("{}, {} samples: error ratio, at most 1", what, root * root),
                                     0.5, 1.0, 0.6, [&](std::uint64_t s) { return ratio(a, b, s); });
            f.allowance = 0.5;  // 0 to 1
            all.push_back(f);
        };
        atMost1("stratified over independent", Points::Stratified, Points::Independent);
        atMost1("Sobol over stratified", Points::Sobol, Points::Stratified);
    }
    return all;
}

/// Stratification may be of no use, but never does harm: a function that is anti-symmetric within every stratum.
std::vector<Finding> stratifiedNeverWorse(const CheckContext& context) {
    const auto variance = [](bool stratified, std::uint64_t seed) {
        constexpr int kRoot = 8, kRuns = 2000;
        double sum = 0.0;
        for (int run = 0; run < kRuns; ++run) {
            Independent random(hashCombine(seed, static_cast<std::uint64_t>(run)));
            double mean = 0.0;
            for (int i = 0; i < kRoot * kRoot; ++i) {
                double x = random.next(), y = random.next();
                if (stratified) x = (i % kRoot + x) / kRoot, y = (i / kRoot + y) / kRoot;
                mean += std::sin(2.0 * kPiD * kRoot * x) * std::sin(2.0 * kPiD * kRoot * y) / (kRoot * kRoot);
            }
            sum += mean * mean / kRuns;
        }
        return sum;
    };
    return {measureSeeds(context, "variance ratio where strata cannot help", 1.0, 0.02, 0.25,
                         [&](std::uint64_t s) { return variance(true, s) / variance(false, hash64(s)); })};
}

/// Every sample of an estimator with p proportional to f is the answer.
std::vector<Finding> zeroVariance(const CheckContext& context) {
    double least = 1e9, greatest = 0.0;
    for (std::uint32_t i = 0; i < 4096; ++i) {
        Sampler sampler(context.seed, 3, i);
        const glm::vec3 w = sampleCosineHemisphere(sampler.next2D());
        const double value = static_cast<double>(w.z / pdfSolidAngleCosineHemisphere(w));
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    }
    return {exact("least sample of int cos by cosine sampling", kPiD, least, 1e-5),
            exact("greatest sample", kPiD, greatest, 1e-5)};
}

/// The density 6 x (1 - x) three ways.
enum class Way { Inversion, Rejection, Metropolis };
[[nodiscard]] double parabolaDensity(double x) { return x > 0.0 && x < 1.0 ? 6.0 * x * (1.0 - x) : 0.0; }

[[nodiscard]] std::vector<double> draw(Way way, int count, std::uint64_t seed) {
    Independent random(seed);
    std::vector<double> points;
    double state = 0.5;
    while (points.size() < static_cast<std::size_t>(count)) {
        if (way == Way::Inversion) {
            // u = 3 x^2 - 2 x^3, by the cosine formula for cubics.
            points.push_back(0.5 - std::sin(std::asin(1.0 - 2.0 * random.next()) / 3.0));
        } else if (way == Way::Rejection) {
            const double x = random.next();
            if (random.next() * 1.5 < parabolaDensity(x)) points.push_back(x);
        } else {
            // Between points that are kept, enough steps for the correlation to die.
            for (int step = 0; step < 20; ++step) {
                const double proposed = state + random.next() - 0.5;
                if (random.next() * parabolaDensity(state) < parabolaDensity(proposed)) state = proposed;
            }
            points.push_back(state);
        }
    }
    return points;
}

/// chi^2 over its degrees of freedom: 1 on average, with standard deviation sqrt(2 / 49).
std::vector<Finding> sameDensity(const CheckContext& context) {
    constexpr int kBins = 50, kCount = 100'000;
    std::vector<Finding> all;
    const auto cumulative = [](double x) { return x * x * (3.0 - 2.0 * x); };
    for (const auto& [way, name] : {std::pair(Way::Inversion, "inversion"), std::pair(Way::Rejection, "rejection"),
                                    std::pair(Way::Metropolis, "Metropolis")}) {
        Finding f = measureSeeds(context, fmt::format("{}: chi^2 over degrees of freedom", name), 1.0, 0.0, 1.0,
                                 [&, drawn = way](std::uint64_t seed) {
                                     std::array<double, kBins> bins{};
                                     for (const double x : draw(drawn, kCount, seed))
                                         bins[static_cast<std::size_t>(x * kBins)] += 1.0;
                                     double chi = 0.0;
                                     for (int i = 0; i < kBins; ++i) {
                                         const double mean = kCount * (cumulative((i + 1.0) / kBins) -
                                                                       cumulative(static_cast<double>(i) / kBins));
                                         chi += (bins[static_cast<std::size_t>(i)] - mean) *
                                                (bins[static_cast<std::size_t>(i)] - mean) / mean;
                                     }
                                     return chi / (kBins - 1);
                                 });
        all.push_back(f);
    }
    return all;
}

}  // namespace

void addMonteCarlo(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, const char* source, auto run) {
        cases.push_back({name, CheckGroup::MonteCarlo, guards, source, true, run});
    };
    add("monte-carlo-convergence", "variance falls as 1/N; with strata as 1/N^2 where the integrand is smooth",
        "[Owen2013, ch. 2]", convergence);
    add("monte-carlo-ordering", "stratified beats independent, Owen-scrambled Sobol beats stratified", "[Burley2020]",
        ordering);
    add("monte-carlo-strata-never-worse", "stratified is never worse than independent", "[Owen2013, ch. 8]",
        stratifiedNeverWorse);
    add("monte-carlo-zero-variance", "p proportional to f: every sample is the answer", "[Veach1997, sec. 2.5]",
        zeroVariance);
    add("monte-carlo-same-density", "inversion, rejection and Metropolis follow one density", "[Owen2013, ch. 4, 11]",
        sameDensity);
}

}  // namespace pellucid::check

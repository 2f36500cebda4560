/// From finished runs and a reference to the figures of a comparison: by run, by method and budget, by method, by pair.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <pellucid/study/compare.h>
#include <pellucid/study/statistics.h>

#include "compare_runs.h"

namespace pellucid {

inline constexpr std::array<double, 4> kTargetErrors{0.10, 0.05, 0.02, 0.01};  ///< root of relmse

struct ClassFigures {
    std::string name;
    Interval relmse, bias2, variance;
};

/// One method at one budget, over the seeds.
struct PointFigures {
    double budget = 0.0;
    int seeds = 0;
    Interval seconds, relmse, relmseTrimmed, rmse, smape, flip, bias;
    Interval bias2, variance;                            ///< relative: they and the reference's noise sum to relmse
    Interval bias2Absolute, varianceAbsolute;            ///< of the mean squared error
    Interval efficiency;                                 ///< 1 / (relmse seconds)
    std::uint64_t peakRssBytes = 0;                      ///< largest of the seeds
    std::vector<std::pair<std::string, double>> stages;  ///< mean seconds
    std::vector<ClassFigures> classes;
};

struct MethodFigures {
    std::string label;
    std::vector<PointFigures> points;   ///< by rising budget
    std::vector<Interval> timeToError;  ///< of kTargetErrors; infinite: not reached
    Interval slope;                     ///< of log relmse over log seconds
};

/// Whether two methods differ at one budget.
struct PairFigures {
    std::string a, b;
    double budget = 0.0;
    Interval ratio;  ///< relmse of a over relmse of b
    double p = 1.0, pAdjusted = 1.0;
    [[nodiscard]] bool significant() const noexcept { return pAdjusted <= 1.0 - kConfidence; }
};

struct CompareFigures {
    std::vector<MethodFigures> methods;
    std::vector<PairFigures> pairs;
};

/// Seeds with which a family of `comparisons` permutation tests can show a difference at all: the smallest p of K seeds a
/// side is 2 / (2K choose K), and [Holm1979] multiplies the smallest of a family by its size. 0 without comparisons.
[[nodiscard]] int seedsNeeded(std::size_t comparisons) noexcept;

/// Finished runs of one method and one budget, by seed.
[[nodiscard]] std::vector<const StoredRun*> runsOf(const CompareRuns& runs, const std::string& label, double budget);

/// Gives each run its metrics against the reference; those measured before are read from their records.
void measureRuns(CompareRuns& runs, const CompareReference& reference, const RunStore& store, const Workers& workers);

[[nodiscard]] CompareFigures analyse(const CompareRequest& request, const CompareRuns& runs,
                                     const CompareReference& reference, const RunStore& store, const Workers& workers);

}  // namespace pellucid

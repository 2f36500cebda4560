/// The finalists on whole images and fresh seeds: error against time with confidence, the Pareto front, and the point
/// of it that is wanted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <pellucid/study/statistics.h>

#include "tune_search.h"

namespace pellucid {

/// One finalist at one budget.
struct FrontPoint {
    double time = 0.0;                 ///< budget
    std::vector<double> relmse, cost;  ///< by seed
    Interval error, seconds;           ///< root of the mean relmse; mean cost
    Interval ratio;                    ///< relmse x cost over the default's, same seeds
    bool onFront = false;              ///< nothing measured is both faster and better
};

struct Finalist {
    std::string name;  ///< "default", "tuned", "quick", "runner-up", or a peer's
    Candidate candidate;
    bool mayWin = true;
    std::vector<FrontPoint> points;  ///< by rising time
};

struct Front {
    std::vector<Finalist> finalists;
    int seeds = 0;
};

/// Seeds outermost, so that an end of the budget leaves all finalists with the same number of seeds; at least one is
/// finished. Empty when interrupted before that.
[[nodiscard]] std::optional<Front> measureFinalists(const TuneRequest& request, const SearchOutcome& search,
                                                    const SearchSpace& space, const std::vector<Candidate>& peers,
                                                    TrialRunner& runner, double limit);

/// What tuned.toml is to hold.
struct Choice {
    std::size_t finalist = 0;
    double seconds = 0.0, error = 0.0;  ///< what the measured curve of the finalist says
    bool reached = true;                ///< false: no finalist reaches the error within the measured times
};

[[nodiscard]] Choice choose(const Front& front, const TuneGoal& goal);

}  // namespace pellucid

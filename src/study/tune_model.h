/// A picture of how the error depends on each parameter: log(error / default's error) at equal cost as a sum of one
/// parabola a coordinate, fitted to the trials by ridge regression. It proposes candidates and draws the report's
/// curves; what is claimed of a parameter is measured (see tune_search.h), not read off this fit.
#pragma once

#include <vector>

namespace pellucid {

struct Observation {
    std::vector<double> coordinates;
    double score = 0.0;  ///< log of relmse x cost, relative to the default's
    double weight = 1.0;
};

class AdditiveModel {
public:
    /// Empty (valid() is false) with fewer observations than twice the dimensions.
    AdditiveModel() = default;
    AdditiveModel(const std::vector<Observation>& observations, std::size_t dimensions);

    [[nodiscard]] bool valid() const noexcept { return !slope_.empty(); }
    /// What coordinate `i` at `x` adds to the score.
    [[nodiscard]] double part(std::size_t i, double x) const noexcept;
    /// The least of each parabola.
    [[nodiscard]] std::vector<double> best() const;

private:
    std::vector<double> slope_, curve_;  ///< of (x - 1/2) and (x - 1/2)^2
};

}  // namespace pellucid

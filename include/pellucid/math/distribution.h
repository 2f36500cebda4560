/// Drawing an index from a table of weights. Light selection and the environment map use it. The cumulative sums are
/// doubles and are not normalised: one burning entry among millions of dim ones keeps the dim ones reachable.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace pellucid {

/// An interval of a cumulative table, and where in it the number fell: uniform in [0,1), fit for further use.
struct IntervalSample {
    std::size_t index = 0;
    double remapped = 0.0;
};

/// `cdf` has one entry more than there are intervals, begins at 0 and never falls; its last entry is positive.
/// An interval is chosen in proportion to its length; an empty one never is. `u` in [0,1).
[[nodiscard]] IntervalSample sampleInterval(std::span<const double> cdf, double u) noexcept;

class Distribution1D {
public:
    Distribution1D() = default;
    /// Weights are finite and not negative. With nothing but zeros total() is 0 and sample() must not be called.
    explicit Distribution1D(std::span<const double> weights);

    [[nodiscard]] std::size_t size() const noexcept { return cdf_.size() - 1; }
    [[nodiscard]] double total() const noexcept { return cdf_.back(); }
    [[nodiscard]] double weight(std::size_t index) const noexcept { return cdf_[index + 1] - cdf_[index]; }
    /// Probability with which sample() returns `index`; 0 everywhere when all weights are 0.
    [[nodiscard]] double pmf(std::size_t index) const noexcept { return total() > 0.0 ? weight(index) / total() : 0.0; }
    [[nodiscard]] IntervalSample sample(double u) const noexcept { return sampleInterval(cdf_, u); }

private:
    std::vector<double> cdf_{0.0};
};

}  // namespace pellucid

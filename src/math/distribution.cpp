#include <pellucid/math/distribution.h>

#include <algorithm>

#include <pellucid/math/constants.h>

namespace pellucid {

IntervalSample sampleInterval(std::span<const double> cdf, double u) noexcept {
    const double x = u * cdf.back();
    const auto above = std::upper_bound(cdf.begin(), cdf.end(), x);
    // upper_bound passes every empty interval; only x rounded up to the very end needs the step back.
    std::size_t index = static_cast<std::size_t>(std::min(above, cdf.end() - 1) - cdf.begin()) - 1;
    while (index > 0 && cdf[index + 1] <= cdf[index]) --index;
    const double length = cdf[index + 1] - cdf[index];
    return {index, std::clamp((x - cdf[index]) / length, 0.0, kLargestBelowOne)};
}

Distribution1D::Distribution1D(std::span<const double> weights) {
    cdf_.reserve(weights.size() + 1);
    for (const double weight : weights) cdf_.push_back(cdf_.back() + weight);
}

}  // namespace pellucid

/// A logarithmic axis of a drawing, over whole decades.
#pragma once

#include <algorithm>
#include <cmath>

namespace pellucid {

struct LogAxis {
    double low, high;  ///< exponents of ten
    double from, to;   ///< where they lie on the drawing
    [[nodiscard]] double at(double value) const {
        return from + (to - from) * (std::log10(value) - low) / (high - low);
    }
};

/// At least one decade around `least` and `most`.
[[nodiscard]] inline LogAxis axisOver(double least, double most, double from, double to) {
    const double low = std::floor(std::log10(least)), high = std::ceil(std::log10(most));
    return {low, std::max(high, low + 1.0), from, to};
}

}  // namespace pellucid

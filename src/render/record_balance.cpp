#include "record_balance.h"

#include <algorithm>
#include <cmath>

namespace pellucid {

namespace {

/// Records are made anew for at least this much of the variance, and with at most so many times as many rays.
constexpr double kMostOfVariance = 0.85, kMostRefinement = 8.0;

}  // namespace

double raysOfBetterRecords(const RecordBalance& b) noexcept {
    if (!(b.recordRays > 0.0) || !(b.recordNoise2 > 0.0)) return 0.0;
    const double record = b.recordNoise2 * b.recordRays, eye = b.eyeNoise2 * b.eyeRays;
    const double rays = b.eyeRays + b.raysLeft;
    const double best = rays * std::sqrt(record) / (std::sqrt(record) + std::sqrt(eye));
    const double made = std::min({best, kMostRefinement * b.recordRays, b.raysLeft});
    if (made <= b.recordRays) return 0.0;
    const double asIs = b.recordNoise2 + eye / rays, then = record / made + eye / (rays - made);
    return then < kMostOfVariance * asIs ? made : 0.0;
}

}  // namespace pellucid

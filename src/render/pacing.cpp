#include "pacing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid {

namespace {

constexpr double kDefaultError = 0.05;
/// Kept of a budget for the files, about.
constexpr double kSecondsToWritePixel = 9e-7;

/// Of an iteration: with less time left no other is begun, so that budgets are missed by half of one at most, about.
constexpr double kLeastLeft = 0.55;

[[nodiscard]] bool onlyError(const Budget& b) noexcept { return !b.samples && !b.seconds && !b.rays; }

}  // namespace

std::optional<double> Budget::nominalSeconds() const noexcept {
    if (seconds) return *seconds - startedSecondsAgo;
    if (rays) return static_cast<double>(*rays) / kRaysOfNominalSecond;
    return std::nullopt;
}

double Pace::fractionDone() const {
    double fraction = 0.0;
    if (budget.samples)
        fraction =
            std::max(fraction, static_cast<double>(samplesPerPixel) / std::max<std::uint32_t>(1, *budget.samples));
    if (budget.seconds) fraction = std::max(fraction, seconds / std::max(1e-3, *budget.seconds));
    if (budget.rays)
        fraction = std::max(fraction,
                            static_cast<double>(rays) / static_cast<double>(std::max<std::uint64_t>(1, *budget.rays)));
    if (onlyError(budget)) {
        const double target = budget.error.value_or(kDefaultError), now = film.relativeError();
        fraction = std::max(now > 0.0 ? std::pow(target / now, 2.0) : 1.0, seconds / timeCap);
    }
    return std::min(1.0, fraction);
}

bool Pace::finished() const {
    if (budget.samples && samplesPerPixel >= *budget.samples) return true;
    if (iterations == 0) return false;
    const double writing = kSecondsToWritePixel * static_cast<double>(film.pixels());
    if (budget.seconds && seconds + kLeastLeft * secondsOfIteration + writing >= *budget.seconds) return true;
    if (budget.rays && rays + (rays - raysOnce) / (2 * iterations) >= *budget.rays) return true;
    const bool errorGiven = budget.error || onlyError(budget);
    if (errorGiven && film.samples() >= 4 && film.relativeError() <= budget.error.value_or(kDefaultError)) return true;
    return timeCap > 0.0 && seconds >= timeCap;
}

double Pace::raysLeft(double traced) const {
    const double perSecond = traced / std::max(1U, iterations) / std::max(1e-6, secondsOfIteration);
    double left = std::numeric_limits<double>::infinity();
    if (budget.seconds) left = std::min(left, (*budget.seconds - seconds) * perSecond);
    if (budget.rays) left = std::min(left, static_cast<double>(*budget.rays) - static_cast<double>(rays));
    if (budget.error || onlyError(budget))
        left =
            std::min(left, traced * (std::pow(film.relativeError() / budget.error.value_or(kDefaultError), 2.0) - 1.0));
    if (timeCap > 0.0) left = std::min(left, (timeCap - seconds) * perSecond);
    return std::max(0.0, left);
}

ProgressReport Pace::report(std::string_view stage) const {
    ProgressReport r;
    r.stage = stage;
    r.fraction = fractionDone();
    r.secondsElapsed = seconds;
    if (r.fraction > 0.0) r.secondsLeft = r.secondsElapsed * (1.0 / r.fraction - 1.0);
    r.samplesPerSecond =
        static_cast<double>(samplesPerPixel) * static_cast<double>(film.pixels()) / std::max(1e-6, r.secondsElapsed);
    return r;
}

}  // namespace pellucid

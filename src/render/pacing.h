/// How far a render has come in its budget of samples, seconds, rays or error, and whether that is enough.
#pragma once

#include <cstdint>
#include <string_view>

#include <pellucid/base/progress.h>
#include <pellucid/render/film.h>
#include <pellucid/render/render.h>

namespace pellucid {

struct Pace {
    const Budget& budget;
    const Film& film;
    double timeCap = 0.0;  ///< seconds; 0: none
    std::uint32_t iterations = 0, samplesPerPixel = 0;
    std::uint64_t rays = 0, raysOnce = 0;  ///< of all passes; of those that not every iteration makes
    double seconds = 0.0, secondsOfIteration = 0.0;

    /// Of the budget that is nearest to its end, at most 1.
    [[nodiscard]] double fractionDone() const;
    [[nodiscard]] bool finished() const;
    /// What passes that have traced so many rays since the render began may yet trace before the nearest end, about. (A number of
    /// samples is no end here: a render that goes on to more of them must not differ from one that was asked for all.)
    [[nodiscard]] double raysLeft(double traced) const;
    [[nodiscard]] ProgressReport report(std::string_view stage) const;
};

}  // namespace pellucid

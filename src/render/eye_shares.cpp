// How the eye side decides about the samples of each pixel: by the noise that the film shows.
#include <algorithm>

#include <pellucid/math/hash.h>

#include "eye_side.h"
#include "sample_shares.h"

namespace pellucid {

namespace {

/// Iterations before pixels are told apart by their noise.
constexpr std::uint32_t kUniformIterations = 2;
/// Samples of a pixel in those, beside a caustic map: its photons take their time once an iteration, and what is noisy in
/// the first seconds comes from the eye. Of short budgets of time one: an iteration more is worth more.
constexpr std::uint8_t kFirstShare = 2;
constexpr double kShortBudget = 3.0;
/// Of the samples an iteration, from one decision to the next.
constexpr double kMostGrowth = 2.0;
/// Time of a ray of the caustic photons, with what is made of them, in units of an eye ray's; as measured.
constexpr double kPhotonRayTime = 1.75;
/// Of a budget, for one iteration: else it would be overrun; or as many seconds, which may be.
constexpr double kMostOfBudget = 0.04, kMostSeconds = 0.5;

}  // namespace

bool EyeSide::renewsShares(std::uint32_t samples) const noexcept {
    return view_.plan.adaptive && samples >= kUniformIterations && (samples & (samples - 1)) == 0;
}

std::optional<double> EyeSide::renewShares(Film& film, const CausticSide& caustics, std::uint32_t iteration) {
    const std::uint32_t n = film.samples();
    const std::optional<double> seconds = view_.request.budget.nominalSeconds();
    if (view_.plan.adaptive && view_.plan.causticMap && n == 0 && !(seconds && *seconds <= kShortBudget))
        film.setShares(std::vector<std::uint8_t>(film.pixels(), kFirstShare));
    if (!renewsShares(n)) return std::nullopt;
    const StageTimer timer(stage_);
    std::vector<PixelNoise> noise(film.pixels());
    double eyeRays = 0.0;
    for (std::size_t i = 0; i < noise.size(); ++i) {
        noise[i] = film.noise(i);
        if (noise[i].inside) eyeRays += static_cast<double>(noise[i].rays);
    }
    const double scale = view_.pixels.scale();
    ShareLimits limits;
    if (view_.plan.causticMap)
        limits.photonRays = kPhotonRayTime * static_cast<double>(caustics.raysSoFar()) / ((iteration + 1) * scale);
    // Step by step, as what is known of the noise grows.
    const double soFar = scale * static_cast<double>(film.taken()) / (n * static_cast<double>(film.pixels()));
    limits.mostMean = std::min(limits.mostMean, static_cast<float>(kMostGrowth * soFar));
    const Budget& b = view_.request.budget;
    const double once = stage_.seconds * static_cast<double>(film.pixels()) /
                        (scale * static_cast<double>(std::max<std::uint64_t>(1, film.taken())));
    if (b.seconds) {
        const bool brief = *b.seconds <= kShortBudget;
        const double affordable =
            std::max(kMostOfBudget * *b.seconds, brief ? 0.0 : kMostSeconds) / std::max(1e-9, once);
        limits.mostMean =
            std::min(limits.mostMean, std::max(static_cast<float>(affordable), brief ? 1.0F : float{kFirstShare}));
    }
    if (b.rays)
        limits.mostMean = static_cast<float>(std::min<double>(
            limits.mostMean, kMostOfBudget * static_cast<double>(*b.rays) / std::max(1.0, eyeRays * scale)));
    limits.fixedPhotons = !view_.plan.causticMap || view_.request.settings.causticPhotons >= 0;
    const SampleShares chosen = sampleShares(noise, film.shares(), view_.camera.width(), view_.camera.height(), limits,
                                             hashCombine(view_.request.seed, n));
    film.setShares(chosen.ofPixel);
    film.setWeight(film.weight() * chosen.lessNoise);
    if (limits.fixedPhotons) return std::nullopt;
    return chosen.photons;
}

}  // namespace pellucid

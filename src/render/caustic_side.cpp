#include "caustic_side.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <pellucid/transport/photon_trace.h>

#include "pass_keys.h"
#include "setting_choices.h"
#include "stages.h"

namespace pellucid {

namespace {

/// A pixel counts as at least this share of the image's mean where photons are weighed by need.
constexpr double kLeastLuminance = 0.1;
/// Photon paths of an iteration, whatever noise asks for.
constexpr double kFewestPaths = 4e3, kMostPaths = 4e6;
/// Iterations before the radii of kernels are corrected by noise and bias.
constexpr std::uint32_t kCorrectRadiiAfter = 8;

}  // namespace

CausticSide::CausticSide(const PreparedView& view) : view_(view) {
    if (view.plan.causticMap && view.plan.adaptiveRadius)
        radii_ = std::make_unique<KernelRadii>(view.camera.width(), view.camera.height(),
                                               radiusOptions(view.request.settings));
    const Settings& settings = view.request.settings;
    if (view.plan.causticMap && (view.plan.otherPhotons || settings.shrink == "chi2"))
        shrink_ = std::make_unique<ProgressiveRadii>(view.pixelCount(), shrinkNamed(settings.shrink), settings.alpha);
}

void CausticSide::pass(PhotonSource& source, const Film& film, std::uint32_t iteration) {
    const StageTimer timer(stage_);
    watching_ = iteration == 0;
    if (watching_) use_.emplace(view_.scene);
    const PhotonPassKey key{view_.request.seed, kCausticPass + iteration, source.paths(),
                            watching_ ? CausticUse::kWatchedPaths : 0};
    CausticPass pass = traceCausticPhotons(view_.scene, source.guide(), key, &view_.survey.visible, view_.workers,
                                           watching_ ? &use_->tally() : nullptr);
    addPhotonPass(stage_, pass);
    stage_.photonsStored += pass.photons.size();
    map_ = std::make_unique<CausticMap>(std::move(pass.photons), photonKernel(view_.request.settings.kernel),
                                        &view_.workers);
    if (watching_) use_->stored(std::move(pass.origins)), map_->watchUse();
    shrinkKernels(iteration);
    if (radii_) fitRadii(film, iteration);
    if (!source.learnsFrom(iteration)) return;
    if (radii_) weighByNeed(pass.useful, film);
    source.learn(std::move(pass.useful));
}

void CausticSide::countUse() {
    if (std::exchange(watching_, false)) use_->count(*map_);
}

/// r^2_{i+1} = r^2_i (i + alpha) / (i + 1) [KnausZwicker2011]
void CausticSide::shrinkKernels(std::uint32_t iteration) noexcept {
    if (iteration > 0) radiusScale_ *= (iteration + static_cast<double>(view_.plan.alpha)) / (iteration + 1.0);
}

/// Radii learn from the photons of iterations 0, 1, 3, 7, ... and are corrected after 8, 16, 32, ... by what the image shows.
/// Where pixels shrink them by themselves there is nothing to correct; of progressive photon mapping they are the first ones.
void CausticSide::fitRadii(const Film& film, std::uint32_t iteration) {
    if (view_.plan.otherPhotons ? iteration == 0 : isLearningIteration(iteration))
        radii_->learn(*map_, view_.survey.points, view_.workers);
    const std::uint32_t n = film.samples();
    if (shrink_ || n < kCorrectRadiiAfter || (n & (n - 1)) != 0) return;
    const double floor = kLeastLuminance * film.meanLuminance();
    radii_->correct(
        n,
        [&](int x, int y) {
            const PixelNoise noise = film.noise(view_.pixelIndex(x, y));
            const double scale =
                static_cast<double>(noise.luminance) * static_cast<double>(noise.luminance) + floor * floor;
            return KernelRadii::Shown{static_cast<double>(noise.photonVariance) / scale,
                                      static_cast<double>(noise.blur2) / scale};
        },
        view_.workers);
}

/// A photon weighs as much as the image wants it: with E of the caustics, L of the pixel and a kernel of radius r the relative
/// variance of a region is E / (n r^2 L^2) times the flux a photon; the least total asks for n ~ flux / (r L).
void CausticSide::weighByNeed(std::vector<UsefulEmission>& useful, const Film& film) const {
    double sum = 0.0;
    std::size_t seen = 0;
    std::vector<float> need(useful.size(), -1.0F);
    const double floor = kLeastLuminance * film.meanLuminance();
    for (std::size_t i = 0; i < useful.size(); ++i) {
        const auto projected = view_.camera.project(useful[i].landed, {0.5F, 0.5F});
        if (!projected) continue;
        const int x = static_cast<int>(projected->position.x), y = static_cast<int>(projected->position.y);
        if (x < 0 || y < 0 || x >= view_.camera.width() || y >= view_.camera.height()) continue;
        const double pixel = film.samples() > 0 ? film.luminanceAt(x, y) + floor : 1.0;
        need[i] = static_cast<float>(1.0 / (static_cast<double>(radii_->at(x, y)) * std::max(pixel, 1e-12)));
        sum += static_cast<double>(need[i]);
        ++seen;
    }
    const auto mean = static_cast<float>(seen > 0 ? sum / static_cast<double>(seen) : 1.0);
    for (std::size_t i = 0; i < useful.size(); ++i) useful[i].weight *= need[i] >= 0.0F ? need[i] : mean;
}

Maps CausticSide::maps(const PhotonSource& source) const noexcept {
    Maps maps;
    maps.causticChains = view_.plan.causticChains;
    maps.photonsPerEtendue = source.photonsPerEtendue();
    if (!map_) return maps;
    maps.caustic = map_.get();
    maps.causticRadiusMin = kLeastKernelRadius;
    maps.causticRadiusMax = kMaxCausticRadius * view_.scene.radius();
    return maps;
}

float CausticSide::kernelFootprints(int x, int y) const noexcept {
    const float shrunk = shrink_ ? shrink_->scale(view_.pixelIndex(x, y)) : static_cast<float>(std::sqrt(radiusScale_));
    return (radii_ ? radii_->at(x, y) : view_.plan.causticFootprints) * shrunk;
}

std::uint32_t CausticSide::pathsFor(double factor, std::uint32_t iterations) const noexcept {
    const std::uint32_t planned = view_.plan.mostCausticPaths;
    const double most = planned > 0 ? std::min<double>(planned, kMostPaths) : kMostPaths;
    const double paths = factor * static_cast<double>(emittedSoFar()) / iterations;
    return static_cast<std::uint32_t>(std::clamp(paths, std::min(kFewestPaths, most), most));
}

void CausticSide::saveTo(CheckpointState& state) const {
    state.causticRays = raysSoFar();
    state.causticEmitted = emittedSoFar();
    if (radii_) state.radii = radii_->save();
    if (shrink_) state.shrunk = shrink_->save();
}

bool CausticSide::restoreFrom(const CheckpointState& state) {
    raysBefore_ = state.causticRays;
    emittedBefore_ = state.causticEmitted;
    if (view_.plan.causticMap)
        for (std::uint32_t i = 0; i < state.iteration; ++i) shrinkKernels(i);
    return (!radii_ || radii_->restore(state.radii, view_.workers)) &&
           (!shrink_ || shrink_->restore(state.shrunk.data(), state.shrunk.size()));
}

}  // namespace pellucid

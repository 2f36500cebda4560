#include "renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <pellucid/base/error.h>

#include "checkpoint.h"
#include "point_cloud.h"

namespace pellucid {

namespace {

/// How much longer an iteration takes, about, whose samples have been shared out anew: they go where paths are long.
constexpr double kLongerRenewed = 1.3;

[[nodiscard]] bool asksFor(const RenderRequest& request, std::string_view layer) {
    return std::find(request.layers.begin(), request.layers.end(), layer) != request.layers.end();
}

}  // namespace

Renderer::Renderer(const Scene& scene, const RenderRequest& request, const Workers& workers, const Progress& progress)
    : progress_(progress),
      clock_(request.budget),
      view_(prepareView(scene, request, workers)),
      film_(view_.camera.width(), view_.camera.height()),
      source_(view_, std::exchange(view_.plan.training, {})),
      caustics_(view_),
      others_(view_),
      indirect_(view_),
      lights_(view_),
      eyes_(view_) {
    if (asksFor(request, "classes")) film_.keepStrings(scene.lobeKinds());
    if (!request.cacheFile.empty()) indirect_.load();
}

RenderResult Renderer::run() {
    const RenderRequest& request = view_.request;
    bool interrupted = request.resume && !resume();
    while (!interrupted && !pace().finished()) {
        interrupted = !iterate() || progress_.stopAsked();
        tell("rendering");
        saveWhenDue(interrupted);
    }
    save();
    indirect_.saveAtEnd();
    if (!request.pointsFolder.empty())
        writePointClouds(request.pointsFolder, indirect_.stored(), caustics_.photons(), view_.scene.normalisation());
    return result(interrupted);
}

RenderRecord Renderer::plan() {
    (void)iterate();
    return record();
}

bool Renderer::iterate() {
    const double once = indirect_.seconds(), began = clock_.elapsed();
    const bool whole = makeRecords();
    if (!whole && iteration_ > 0) return false;
    cutShort_ = !whole;
    shootPhotons();
    tracePixels();
    caustics_.countUse();
    secondsOfIteration_ = clock_.elapsed() - began - (indirect_.seconds() - once);
    ++iteration_;
    return whole;
}

bool Renderer::makeRecords() {
    const Pace now = pace();
    if (indirect_.due(now, eyes_.stage())) return indirect_.renew(caustics_.maps(source_), clock_, progress_);
    if (const double factor = indirect_.refinement(now, eyes_.stage()); factor > 1.0)
        return indirect_.refine(factor, caustics_.maps(source_), clock_, progress_);
    return true;
}

void Renderer::shootPhotons() {
    if (view_.plan.causticMap) caustics_.pass(source_, film_, iteration_);
    if (view_.plan.otherPhotons) others_.pass(iteration_);
}

void Renderer::tracePixels() {
    std::vector<LightSplat> splats;
    if (view_.plan.lightPass) splats = lights_.pass(source_, iteration_);
    if (view_.bidirectional()) return eyes_.bidirectionalPass(std::move(splats), film_);
    if (view_.plan.lightPass) film_.addSplats(splats, iteration_);
    if (view_.request.method == Method::Light) return film_.countSamples(1);
    renewShares();
    indirect_.served(eyes_.pass(eyeContext(), photons(), film_, clock_));
}

void Renderer::renewShares() {
    if (const auto factor = eyes_.renewShares(film_, caustics_, iteration_))
        source_.setPaths(caustics_.pathsFor(*factor, iteration_ + 1));
}

TransportContext Renderer::eyeContext() const noexcept {
    Maps maps = caustics_.maps(source_);
    indirect_.giveTo(maps);
    others_.giveTo(maps);
    return view_.context(maps);
}

Pace Renderer::pace() const {
    Pace pace{view_.request.budget, film_};
    pace.timeCap = view_.plan.timeCap;
    pace.iterations = iteration_;
    pace.samplesPerPixel = samplesPerPixel();
    pace.raysOnce = view_.pilot.rays + indirect_.rays();
    pace.rays =
        pace.raysOnce + caustics_.stage().rays + others_.stage().rays + lights_.stage().rays + eyes_.stage().rays;
    pace.seconds = clock_.elapsed();
    pace.secondsOfIteration = secondsOfIteration_ * (eyes_.renewsShares(film_.samples()) ? kLongerRenewed : 1.0);
    return pace;
}

std::uint32_t Renderer::samplesPerPixel() const {
    if (!view_.plan.adaptive) return film_.samples();
    return static_cast<std::uint32_t>(static_cast<double>(film_.taken()) * view_.pixels.scale() /
                                      static_cast<double>(film_.pixels()));
}

void Renderer::tell(std::string_view stage) const {
    if (progress_.report) progress_.report(pace().report(stage));
}

RenderResult Renderer::result(bool interrupted) const {
    RenderResult result;
    result.image = film_.image(view_.request.layers);
    indirect_.addLayers(result.image);
    result.interrupted = interrupted;
    result.record = record();
    return result;
}

RenderRecord Renderer::record() const {
    RenderRecord r;
    r.decisions = view_.plan.decisions;
    if (indirect_.decision()) r.decisions.push_back(*indirect_.decision());
    r.causticLinks = view_.plan.causticLinks;
    caustics_.tellUse(r.causticLinks);
    r.blindSpots = view_.plan.blindSpots;
    for (const StageRecord* s : {&view_.pilot, &indirect_.globalStage(), &indirect_.cacheStage(), &caustics_.stage(),
                                 &others_.stage(), &lights_.stage(), &eyes_.stage()})
        if (s != &others_.stage() || view_.plan.otherPhotons)
            r.stages.push_back(withMeanEnergy(*s, view_.scene.normalisation().scale()));
    r.iterations = iteration_;
    r.samplesPerPixel = samplesPerPixel();
    r.seconds = clock_.elapsed();
    r.errorEstimate = film_.relativeError();
    r.noiseEstimate = std::sqrt(film_.relativeNoise2());
    r.blurEstimate = std::sqrt(film_.relativeBlur2());
    r.recordsEstimate = std::sqrt(film_.relativeRecordNoise2());
    r.nonfinite = film_.nonfinite();
    r.resolved = resolvedSettings(view_.request.settings, view_.plan);
    r.resolved.causticPhotons = static_cast<int>(source_.paths());
    r.resolved.guiding = source_.guided() ? "on" : "off";
    r.threads = view_.workers.threads();
    r.reuse = indirect_.reuse();
    r.texels = lights_.texels();
    return r;
}

void Renderer::save() const {
    if (view_.request.checkpoint.empty() || cutShort_) return;
    CheckpointState state;
    state.iteration = iteration_;
    state.film = film_.save();
    source_.saveTo(state);
    caustics_.saveTo(state);
    others_.saveTo(state);
    eyes_.saveTo(state);
    state.generations = indirect_.state();
    writeCheckpoint(view_.request.checkpoint, checkpointKey(view_.scene, view_.request, view_.camera), state);
}

void Renderer::saveWhenDue(bool now) {
    constexpr double kSecondsBetween = 10.0;
    if (!now && clock_.elapsed() - lastSave_ < kSecondsBetween) return;
    save();
    lastSave_ = clock_.elapsed();
}

/// The continued image has the bits of an uninterrupted one.
bool Renderer::resume() {
    const auto state =
        readCheckpoint(view_.request.checkpoint, checkpointKey(view_.scene, view_.request, view_.camera));
    if (!state) return true;
    if (!film_.restore(state->film) || !source_.restoreFrom(*state) || !caustics_.restoreFrom(*state) ||
        !others_.restoreFrom(*state) || !eyes_.restoreFrom(*state))
        throw Error(ErrorKind::BadInput, "the checkpoint does not fit this image", view_.request.checkpoint.string(),
                    "delete it or render without --resume");
    iteration_ = state->iteration;
    return indirect_.restoreFrom(state->generations, caustics_.maps(source_), clock_, progress_);
}

}  // namespace pellucid

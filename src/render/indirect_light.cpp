#include "indirect_light.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <pellucid/transport/caustic_map.h>

#include "cache_layers.h"
#include "record_balance.h"

namespace pellucid {

namespace {

/// A new generation of records is due when the eye passes since the last have cost this many times as much as it did.
constexpr double kGenerationShare = 1.0;
/// Where indirect light is less than this part of the image, the next generation comes later in proportion, by up to this.
constexpr double kMuchIndirect = 0.25, kMostPatience = 10.0;
/// How much longer the next generation takes, about.
constexpr double kGenerationGrowth = 1.5;
/// When what noise records and eye leave is looked at: after this iteration, and then every so many.
constexpr std::uint32_t kFirstLook = 2, kLooks = 4;
/// Of a budget of time: a cache that is not full by then stays as it is, and what it lacks is traced.
constexpr double kCacheShare = 0.7, kLaterCacheShare = 0.9;

[[nodiscard]] std::size_t placesOf(const LearntLight& light) noexcept { return light.map ? light.map->points() : 0; }
[[nodiscard]] std::size_t recordsOf(const LearntLight& light) noexcept {
    return light.cache ? light.cache->records().size() : 0;
}

}  // namespace

/// Sizes that nobody asked for follow the clock, the memory and the image, and the file holds its own.
CacheKey fileKey(const PreparedView& view) {
    Settings settings = resolvedSettings(view.request.settings, view.plan);
    const Settings& asked = view.request.settings;
    settings.globalPhotons = asked.globalPhotons;
    settings.gatherRays = asked.gatherRays;
    settings.cacheError = asked.cacheError;
    return cacheKey(view.scene, settings, view.plan.causticMap || view.plan.causticChains);
}

/// What was loaded is saved as soon as this view has added to it: a later generation would know this view alone.
void IndirectLight::load() {
    reuse_.asked = true;
    if (!view_.plan.cache) return;
    known_ = readCacheFile(view_.request.cacheFile, fileKey(view_), view_.scene);
    loaded_ = known_.has_value();
    raysLoaded_ = loaded_ ? known_->rays : 0.0;
}

/// If there is more to say than was read.
void IndirectLight::save() const {
    if (view_.request.cacheFile.empty() || !light_.cache || light_.rays == raysLoaded_) return;
    writeCacheFile(view_.request.cacheFile, fileKey(view_), light_);
}

void IndirectLight::startFrom(std::optional<LearntLight> known, std::uint32_t generation) {
    known_ = std::move(known);
    state_.next = generation;
}

bool IndirectLight::due(const Pace& pace, const StageRecord& eyes) const {
    if (!view_.plan.cache || pace.iterations == 0) return view_.plan.cache;
    if (frozen_) return false;
    if (state_.raysSince <= kGenerationShare * state_.raysOfGeneration) return false;
    return state_.raysSince > kGenerationShare * patience(pace) * state_.raysOfGeneration &&
           hasRoomForNext(pace, eyes, 0.0);
}

/// Where little light is indirect its records may be the worse.
double IndirectLight::patience(const Pace& pace) const {
    return std::clamp(kMuchIndirect / std::max(pace.film.indirectShare(), 1e-6), 1.0, kMostPatience);
}

/// Near the end of a budget a new one would not be used enough. `raysBefore`: of the eye, until it begins.
bool IndirectLight::hasRoomForNext(const Pace& pace, const StageRecord& eyes, double raysBefore) const {
    const double perRay = eyes.seconds / std::max(1.0, static_cast<double>(eyes.rays));
    const double asLearnt = perRay * state_.raysOfGeneration;  // if it was loaded
    const double next = std::max(secondsOfGeneration_, loaded_ ? asLearnt : 0.0) * kGenerationGrowth;
    constexpr double kToUse = 1.0 + kGenerationShare;
    if (pace.budget.seconds && pace.seconds + perRay * raysBefore + kToUse * next > *pace.budget.seconds) return false;
    const double raysToUse = raysBefore + kToUse * kGenerationGrowth * state_.raysOfGeneration;
    return !pace.budget.rays || static_cast<double>(pace.rays) + raysToUse <= static_cast<double>(*pace.budget.rays);
}

double IndirectLight::refinement(const Pace& pace, const StageRecord& eyes) const {
    const bool own = light_.cache && light_.views == 1 && !frozen_ && view_.request.cacheFile.empty();
    if (!own || !view_.plan.growRays || (pace.iterations != kFirstLook && pace.iterations % kLooks != 0)) return 1.0;
    RecordBalance b;
    b.recordNoise2 = pace.film.relativeRecordNoise2();
    b.recordRays = state_.recordRays;
    b.eyeNoise2 = pace.film.relativeNoise2();
    b.eyeRays = state_.raysServed;
    b.raysLeft = pace.raysLeft(state_.raysServed);
    const double untilNext =
        std::max(0.0, kGenerationShare * patience(pace) * state_.raysOfGeneration - state_.raysSince);
    if (b.raysLeft > untilNext && hasRoomForNext(pace, eyes, untilNext)) b.raysLeft = untilNext;
    return std::max(1.0, raysOfBetterRecords(b) / std::max(1.0, recordRaysOfGeneration_));
}

bool IndirectLight::refine(double factor, const Maps& maps, RenderClock& clock, const Progress& progress) {
    const GenerationState before = state_;
    const WallClock::time_point began = WallClock::now();
    LearntLight light = light_;
    light.cache = nullptr;
    light.views = 0;
    ++light.refinements;
    light.size.gatherRays = static_cast<int>(factor * light.size.gatherRays);
    const auto cut = [&clock, &progress] { return progress.stopAsked() || clock.past(kLaterCacheShare); };
    const std::uint64_t raysBefore = rays();
    CacheBuild build = makeRecords(light, guide_.get(), maps, clock, cut);
    const bool whole = !cut();
    if (!whole && progress.stopAsked()) {
        state_ = before;
        return false;
    }
    state_.raysOfGeneration = light_.rays = light.rays += static_cast<double>(rays() - raysBefore);
    secondsOfGeneration_ += secondsSince(began);
    if (!whole) return true;  // complete records that are noisier rather than half of these
    cacheStage_.records += build.cache->records().size();
    light.cache = std::move(build.cache);
    light.views = 1;
    plain_ = std::move(build.plain);
    state_.leastGatherRays = light.size.gatherRays;
    state_.refinements = light.refinements;
    decision_ = {"records made again", fmt::format("{} rays", light.size.gatherRays),
                 fmt::format("those of {} rays left more noise than the eye would", light_.size.gatherRays)};
    light_ = std::move(light);
    return true;
}

LearntLight IndirectLight::nextGeneration() {
    LearntLight light = known_ ? *std::exchange(known_, std::nullopt) : LearntLight{};
    if (light.cache) return light;
    light.seed = view_.request.seed;
    light.generation = state_.next;
    light.size = view_.plan.generation(state_.next);
    light.size.gatherRays = std::max(light.size.gatherRays, state_.leastGatherRays);
    return light;
}

bool IndirectLight::renew(const Maps& maps, RenderClock& clock, const Progress& progress) {
    return makeGeneration(0, maps, clock, progress);
}

bool IndirectLight::makeGeneration(std::uint32_t refinements, const Maps& maps, RenderClock& clock,
                                   const Progress& progress) {
    if (frozen_) {
        useFrozen();
        return true;
    }
    LearntLight light = nextGeneration();
    light.refinements = refinements;
    const std::uint64_t raysBefore = rays();
    const WallClock::time_point began = WallClock::now();
    const GenerationState stateBefore = state_;
    const bool first = !light_.cache;
    LearntLight before = std::exchange(light_, {});
    const auto cut = [&clock, &progress, first] {
        return progress.stopAsked() || clock.past(first ? kCacheShare : kLaterCacheShare);
    };
    const std::size_t places = placesOf(light), records = recordsOf(light);
    const std::uint64_t view = hashOf(view_.survey);
    bool whole = std::find(light.seen.begin(), light.seen.end(), view) != light.seen.end();
    if (!whole && !cut()) {
        guide_ = view_.plan.globalMap ? makeMap(light, maps) : nullptr;
        CacheBuild build = makeRecords(light, guide_.get(), maps, clock, cut);
        whole = !cut();
        if (whole || first) {
            cacheStage_.records += build.cache->records().size() - records;
            light.cache = std::move(build.cache);
            plain_ = std::move(build.plain);
            if (whole) light.seen.push_back(view);
            ++light.views;
        }
    }
    const bool stopped = !whole && progress.stopAsked();
    // Whole records of the last generation rather than half of this one's.
    light_ = whole || first ? std::move(light) : std::move(before);
    if (stopped && !first) {
        state_ = stateBefore;
        return false;
    }
    state_.raysOfGeneration = light_.rays += static_cast<double>(rays() - raysBefore);
    state_.raysSince = 0.0;
    state_.refinements = light_.refinements;
    state_.next = light_.generation + 1;
    secondsOfGeneration_ = secondsSince(began);
    if (first && light_.map) reuse_.placesReused = places, reuse_.placesNew = placesOf(light_) - places;
    if (first) reuse_.recordsReused = records, reuse_.recordsNew = recordsOf(light_) - records;
    if (first && loaded_) save();
    return !stopped;
}

/// With what its photons tell gather rays, if they were shot and that is asked for.
std::unique_ptr<const GatherGuide> IndirectLight::makeMap(LearntLight& light, const Maps& maps) {
    const StageTimer timer(globalStage_);
    const GlobalPass pass = learnMap(view_.context(maps), view_.survey, light, view_.workers);
    globalStage_.rays += pass.rays;
    globalStage_.photonsEmitted += pass.emitted;
    if (pass.emitted > 0) addEnergy(globalStage_, pass.energy);
    globalStage_.photonsStored += pass.photons.size();
    if (pass.photons.empty() || !view_.plan.gatherGuide) return nullptr;
    return std::make_unique<const GatherGuide>(pass.photons, kMaxMapRadius * view_.scene.radius(), view_.workers);
}

CacheBuild IndirectLight::makeRecords(const LearntLight& light, const GatherGuide* guide, const Maps& maps,
                                      RenderClock& clock, const std::function<bool()>& cut) {
    const StageTimer timer(cacheStage_, clock, view_.pixels.scale());
    // Gather rays leave to the caustic map what it will hold, also before its first pass.
    const CausticMap none{PhotonList{}};
    Maps ofGather = maps;
    ofGather.global = light.map.get();
    if (view_.plan.causticMap) ofGather.caustic = &none;
    CacheBuild build = buildCache(view_.context(ofGather), view_.survey, view_.camera.width(), view_.plan, light.size,
                                  light.gatherSeed(), guide, view_.workers, cut,
                                  light.cache ? std::make_unique<IrradianceCache>(*light.cache) : nullptr, light.views);
    const std::uint64_t rays = view_.pixels.ofWholeImage(build.rays);
    cacheStage_.rays += rays;
    recordRaysOfGeneration_ = static_cast<double>(rays);
    state_.recordRays += recordRaysOfGeneration_;
    return build;
}

void IndirectLight::useFrozen() {
    light_ = *frozen_;
    reuse_ = {true, recordsOf(light_), 0, placesOf(light_), 0};
    state_.raysOfGeneration = light_.rays;
    state_.next = light_.generation + 1;
}

void IndirectLight::giveTo(Maps& maps) const noexcept {
    maps.global = light_.map.get();
    maps.cache = light_.cache.get();
}

StoredPoints IndirectLight::stored() const {
    StoredPoints points;
    if (light_.cache) points.records = light_.cache->records();
    if (light_.map) points.places = light_.map->places();
    return points;
}

void IndirectLight::addLayers(Image& image) const {
    if (!light_.cache) return;
    addCacheLayers(
        image, view_.request.layers,
        {*light_.cache, view_.survey, plain_, view_.camera, light_.views, 1.0 / view_.scene.normalisation().scale()},
        view_.workers);
}

bool IndirectLight::restoreFrom(const GenerationState& state, const Maps& maps, RenderClock& clock,
                                const Progress& progress) {
    bool whole = true;
    if (view_.plan.cache && state.next > 0) {
        state_ = state;
        --state_.next;
        whole = makeGeneration(state.refinements, maps, clock, progress);
    }
    state_ = state;
    light_.rays = state.raysOfGeneration;  // with those of records that were made again since
    return whole;
}

}  // namespace pellucid

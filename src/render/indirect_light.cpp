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
    generation_ = generation;
}

bool IndirectLight::due(const Pace& pace, const StageRecord& eyes) const {
    if (!view_.plan.cache || pace.iterations == 0) return view_.plan.cache;
    if (frozen_) return false;
    if (raysSince_ <= kGenerationShare * raysOfGeneration_) return false;
    return raysSince_ > kGenerationShare * patience(pace) * raysOfGeneration_ && hasRoomForNext(pace, eyes, 0.0);
}

/// Where little light is indirect its records may be the worse.
double IndirectLight::patience(const Pace& pace) const {
    return std::clamp(kMuchIndirect / std::max(pace.film.indirectShare(), 1e-6), 1.0, kMostPatience);
}

/// Near the end of a budget a new one would not be used enough. `raysBefore`: of the eye, until it begins.
bool IndirectLight::hasRoomForNext(const Pace& pace, const StageRecord& eyes, double raysBefore) const {
    const double perRay = eyes.seconds / std::max(1.0, static_cast<double>(eyes.rays));
    const double asLearnt = perRay * raysOfGeneration_;  // if it was loaded
    const double next = std::max(secondsOfGeneration_, loaded_ ? asLearnt : 0.0) * kGenerationGrowth;
    constexpr double kToUse = 1.0 + kGenerationShare;
    if (pace.budget.seconds && pace.seconds + perRay * raysBefore + kToUse * next > *pace.budget.seconds) return false;
    const double raysToUse = raysBefore + kToUse * kGenerationGrowth * raysOfGeneration_;
    return !pace.budget.rays || static_cast<double>(pace.rays) + raysToUse <= static_cast<double>(*pace.budget.rays);
}

double IndirectLight::refinement(const Pace& pace, const StageRecord& eyes) const {
    const bool own = light_.cache && light_.views == 1 && !frozen_ && view_.request.cacheFile.empty();
    if (!own || !view_.plan.growRays || (pace.iterations != kFirstLook && pace.iterations % kLooks != 0)) return 1.0;
    RecordBalance b;
    b.recordNoise2 = pace.film.relativeRecordNoise2();
    b.recordRays = recordRays_;
    b.eyeNoise2 = pace.film.relativeNoise2();
    b.eyeRays = raysServed_;
    b.raysLeft = pace.raysLeft(raysServed_);
    const double untilNext = std::max(0.0, kGenerationShare * patience(pace) * raysOfGeneration_ - raysSince_);
    if (b.raysLeft > untilNext && hasRoomForNext(pace, eyes, untilNext)) b.raysLeft = untilNext;
    return std::max(1.0, raysOfBetterRecords(b) / std::max(1.0, recordRaysOfGeneration_));
}

void IndirectLight::refine(double factor, const Maps& maps, RenderClock& clock, const Progress& progress) {
    LearntLight light = light_;
    light.cache = nullptr;
    light.views = 0;
    ++light.refinements;
    light.size.gatherRays = static_cast<int>(factor * light.size.gatherRays);
    const auto cut = [&clock, &progress] { return progress.stopAsked() || clock.past(kLaterCacheShare); };
    const std::uint64_t raysBefore = rays();
    CacheBuild build = makeRecords(light, guide_.get(), maps, clock, cut);
    light_.rays = light.rays += static_cast<double>(rays() - raysBefore);
    raysOfGeneration_ = light_.rays;
    if (cut()) return;  // whole records that are noisier rather than half of these
    cacheStage_.records += build.cache->records().size();
    light.cache = std::move(build.cache);
    light.views = 1;
    plain_ = std::move(build.plain);
    leastRays_ = light.size.gatherRays;
    decision_ = {"records made again", fmt::format("{} rays", leastRays_),
                 fmt::format("those of {} rays left more noise than the eye would", light_.size.gatherRays)};
    light_ = std::move(light);
}

LearntLight IndirectLight::nextGeneration() {
    LearntLight light = known_ ? *std::exchange(known_, std::nullopt) : LearntLight{};
    if (light.cache) return light;
    light.seed = view_.request.seed;
    light.generation = generation_;
    light.size = view_.plan.generation(generation_);
    light.size.gatherRays = std::max(light.size.gatherRays, leastRays_);
    light.refinements = std::exchange(refinements_, 0);
    return light;
}

void IndirectLight::renew(const Maps& maps, RenderClock& clock, const Progress& progress) {
    if (frozen_) return useFrozen();
    const std::uint64_t raysBefore = rays();
    const WallClock::time_point began = WallClock::now();
    LearntLight light = nextGeneration();
    const bool first = !light_.cache;
    LearntLight before = std::exchange(light_, {});
    const auto cut = [&clock, &progress, first] {
        return progress.stopAsked() || clock.past(first ? kCacheShare : kLaterCacheShare);
    };
    const std::size_t places = placesOf(light), records = recordsOf(light);
    const std::uint64_t view = hashOf(view_.survey);
    const bool complete = std::find(light.seen.begin(), light.seen.end(), view) != light.seen.end();
    if (!complete && cut()) {
        if (!first) light = std::move(before);  // too late to begin
    } else if (!complete) {
        guide_ = view_.plan.globalMap ? makeMap(light, maps) : nullptr;
        CacheBuild build = makeRecords(light, guide_.get(), maps, clock, cut);
        const bool whole = !cut();
        if (whole || first) {
            cacheStage_.records += build.cache->records().size() - records;
            light.cache = std::move(build.cache);
            plain_ = std::move(build.plain);
            if (whole) light.seen.push_back(view);
            ++light.views;
        } else {
            light = std::move(before);  // whole records of the last generation rather than half of this one's
        }
    }
    light.rays += static_cast<double>(rays() - raysBefore);
    if (first && light.map) reuse_.placesReused = places, reuse_.placesNew = placesOf(light) - places;
    if (first) reuse_.recordsReused = records, reuse_.recordsNew = recordsOf(light) - records;
    light_ = std::move(light);
    raysOfGeneration_ = light_.rays;
    raysSince_ = 0.0;
    secondsOfGeneration_ = secondsSince(began);
    generation_ = light_.generation + 1;
    if (first && loaded_) save();
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
    recordRays_ += recordRaysOfGeneration_;
    return build;
}

void IndirectLight::useFrozen() {
    light_ = *frozen_;
    reuse_ = {true, recordsOf(light_), 0, placesOf(light_), 0};
    raysOfGeneration_ = light_.rays;
    generation_ = light_.generation + 1;
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

void IndirectLight::saveTo(CheckpointState& state) const noexcept {
    state.generation = generation_;
    state.leastGatherRays = leastRays_;
    state.refinements = light_.refinements;
    state.recordRays = recordRays_;
    state.raysOfGeneration = raysOfGeneration_;
    state.raysSince = raysSince_;
    state.raysServed = raysServed_;
}

void IndirectLight::restoreFrom(const CheckpointState& state, const Maps& maps, RenderClock& clock,
                                const Progress& progress) {
    if (view_.plan.cache && state.generation > 0) {
        generation_ = state.generation - 1;
        leastRays_ = state.leastGatherRays;
        refinements_ = state.refinements;
        renew(maps, clock, progress);
    }
    recordRays_ = state.recordRays;
    light_.rays = raysOfGeneration_ = state.raysOfGeneration;  // with those of records that were made again since
    raysSince_ = state.raysSince;
    raysServed_ = state.raysServed;
}

}  // namespace pellucid

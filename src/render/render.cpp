#include <pellucid/render/render.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numeric>
#include <tuple>
#include <utility>

#include <pellucid/base/error.h>
#include <pellucid/render/film.h>
#include <pellucid/render/plan.h>
#include <pellucid/render/views.h>
#include <pellucid/transport/bidirectional.h>
#include <pellucid/transport/caustic_map.h>
#include <pellucid/transport/kernel_radius.h>
#include <pellucid/transport/photon_trace.h>
#include <pellucid/transport/radiance_map.h>
#include <pellucid/transport/texel_irradiance.h>

#include "cache_builder.h"
#include "cache_file.h"
#include "checkpoint.h"
#include "endless.h"
#include "learnt_light.h"
#include "point_cloud.h"
#include "sample_shares.h"

namespace pellucid {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTile = 16;
constexpr std::uint64_t kCausticPass = 1ULL << 40U, kLightPass = 3ULL << 40U,
                        kBidirectionalPass = 5ULL << 40U;  // 2, 4: learnt_light.cpp
/// A new generation of records is due when the eye passes since the last have cost this many times as much as it did.
constexpr double kGenerationShare = 1.5;
/// Where indirect light is less than this part of the image, the next generation comes later in proportion, by up to this.
constexpr double kMuchIndirect = 0.25, kMostPatience = 10.0;
/// How much longer the next generation takes, about.
constexpr double kGenerationGrowth = 1.5;
/// Of a budget of time: a cache that is not full by then stays as it is, and what it lacks is traced.
constexpr double kCacheShare = 0.7, kLaterCacheShare = 0.9;
/// The guide learns from each pass until it holds this many useful starts.
constexpr std::size_t kTrainingLimit = 400'000;
/// A pixel counts as at least this share of the image's mean where photons are weighed by need.
constexpr double kLeastLuminance = 0.1;
constexpr float kMaxCausticRadius = 0.05F;  ///< of the scene's radius
constexpr double kDefaultError = 0.05;
/// Iterations before pixels are told apart by their noise.
constexpr std::uint32_t kUniformIterations = 4;
/// Samples of a pixel in those, beside a caustic map: its photons take their time once an iteration, and where the first
/// seconds are noisy it is from the eye. Of short budgets of time one: an iteration more is worth more.
constexpr std::uint8_t kFirstShare = 2;
constexpr double kShortBudget = 3.0;
/// Caustic photon paths of an iteration, whatever noise asks for.
constexpr double kFewestPaths = 4e3, kMostPaths = 4e6;
/// Iterations before the radii of kernels are corrected by noise and bias.
constexpr std::uint32_t kCorrectRadiiAfter = 8;
/// Time of a ray of the caustic photons, with what is made of them, in units of an eye ray's; as measured.
constexpr double kPhotonRayTime = 1.75;
/// Kept of a budget for the files, about.
constexpr double kSecondsToWritePixel = 6e-7;
/// Of a budget, for one iteration: else it would be overrun.
constexpr double kMostOfBudget = 0.04;

[[nodiscard]] double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Adds wall time to a stage while it lives, `scale` times.
class StageTimer {
public:
    explicit StageTimer(StageRecord& stage, double scale = 1.0) : stage_(stage), scale_(scale), start_(Clock::now()) {}
    ~StageTimer() { stage_.seconds += scale_ * secondsSince(start_); }
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;

private:
    StageRecord& stage_;
    double scale_;
    Clock::time_point start_;
};

[[nodiscard]] TransportOptions transportOptions(const RenderRequest& request) {
    TransportOptions o;
    o.powerHeuristic = request.settings.misHeuristic == "power";
    const auto& [directions, lights] = std::tie(request.settings.directions, request.settings.lightStrategy);
    o.directions = directions == "uniform"  ? Directions::Uniform
                   : directions == "cosine" ? Directions::Cosine
                                            : Directions::Bsdf;
    o.lights = lights == "none"  ? LightStrategy::Chance
               : lights == "nee" ? LightStrategy::NextEvent
                                 : LightStrategy::Both;
    o.rouletteThreshold = static_cast<float>(request.settings.rouletteThreshold);
    o.maxDepth = request.settings.maxDepth;
    return o;
}

void addEnergy(StageRecord& stage, const EnergyBalance& pass) {
    stage.energy.add(pass);
    ++stage.photonPasses;
}

/// The stage with its energy as the mean of its passes, in watts: powers carry the square of the scene's scale.
[[nodiscard]] StageRecord withMeanEnergy(const StageRecord& stage, double scale) {
    StageRecord mean = stage;
    mean.energy = {};
    if (stage.photonPasses > 0) mean.energy.add(stage.energy, 1.0 / (stage.photonPasses * scale * scale));
    return mean;
}

[[nodiscard]] PhotonKernel photonKernel(const std::string& name) {
    if (name == "uniform") return PhotonKernel::Uniform;
    if (name == "cone") return PhotonKernel::Cone;
    return name == "biweight" ? PhotonKernel::Biweight : PhotonKernel::Epanechnikov;
}

[[nodiscard]] KernelRadiusOptions radiusOptions(const Settings& settings) {
    KernelRadiusOptions options;
    options.enough *= photonsWanted(photonKernel(settings.kernel));
    return options;
}

[[nodiscard]] SamplerKind samplerKind(const std::string& name) {
    if (name == "independent") return SamplerKind::Independent;
    if (name == "stratified") return SamplerKind::Stratified;
    return name == "halton" ? SamplerKind::Halton : SamplerKind::Sobol;
}

[[nodiscard]] std::vector<TracedVertex> tracedVertices(const Subpath& path) {
    std::vector<TracedVertex> list;
    for (const PathVertex& v : path.vertices()) {
        TracedVertex t;
        t.position = v.hit.point.position;
        t.normal = v.bsdf.shadingNormal();
        t.distance = v.hit.distance;
        t.geometry = v.hit.point.geometry;
        t.primitive = v.hit.point.primitive;
        t.material = v.hit.point.material;
        t.kinds = v.bsdf.kinds();
        t.backSide = v.bsdf.backSide();
        t.throughput = v.throughput;
        list.push_back(t);
    }
    return list;
}

/// The loop of iterations: each one leaves a usable image.
class Renderer {
public:
    Renderer(const Scene& scene, const RenderRequest& request, const Workers& workers, const Progress& progress)
        : scene_(scene),
          request_(request),
          workers_(workers),
          progress_(progress),
          start_(Clock::now()),
          camera_(scene.camera(request.camera, request.width, request.height, request.settings.aperture,
                               request.settings.focus)),
          context_{scene, transportOptions(request), {}},
          film_(camera_.width(), camera_.height()) {}

    /// The pilot, and one iteration for what each pass costs.
    [[nodiscard]] RenderRecord plan() {
        prepare();
        iterate();
        ++iteration_;
        return record();
    }

    [[nodiscard]] SampleReplay replay(int x, int y, std::uint32_t sample) {
        if (x < 0 || y < 0 || x >= camera_.width() || y >= camera_.height())
            throw Error(ErrorKind::Usage, "the image has no pixel " + std::to_string(x) + "," + std::to_string(y),
                        "--debug-sample",
                        "it is " + std::to_string(camera_.width()) + "x" + std::to_string(camera_.height()));
        if (request_.method == Method::Light)
            throw Error(ErrorKind::Usage, "light tracing has no samples of a pixel", "--debug-sample",
                        "give another --method");
        prepare();
        // Without maps a sample depends on nothing that was before it.
        if (!plan_.causticMap && !plan_.cache && !plan_.adaptive)
            film_.countSamples(sample);
        else
            for (; film_.samples() < sample && !progress_.stopAsked(); ++iteration_) {
                iterate();
                tell("iterations before the sample");
            }
        makeMaps();
        SampleReplay replay;
        replay.width = camera_.width();
        replay.height = camera_.height();
        FirstHit first;
        if (bidirectional()) {
            Bidirectional paths(scene_, camera_, context_.options, static_cast<std::uint32_t>(film_.pixels()));
            std::vector<LightSplat> splats;
            replay.radiance =
                sampleBidirectional(paths, pixelIndex(x, y), glm::vec2(static_cast<float>(x), static_cast<float>(y)),
                                    splats, first, nullptr);
            replay.vertices = tracedVertices(paths.eyePath());
            replay.lightVertices = tracedVertices(paths.lightPath());
            return replay;
        }
        // Of the pixel's samples in this iteration the first one that is not finite, else the first.
        renewShares();
        Walk walk(context_);
        const int share = film_.share(pixelIndex(x, y));
        for (int k = 0; k < share; ++k) {
            SampleReplay one;
            walk.writeTo(&one.vertices);
            one.radiance = samplePixel(walk, x, y, k, first);
            const bool finite = isFinite(one.radiance.total());
            if (k > 0 && finite) continue;
            replay.vertices = std::move(one.vertices);
            replay.radiance = one.radiance;
            if (!finite) break;
        }
        return replay;
    }

    [[nodiscard]] RenderResult run() {
        prepare();
        if (!request_.checkpoint.empty() && request_.resume) resume();
        bool interrupted = false;
        while (!interrupted && !finished()) {
            iterate();
            ++iteration_;
            tell("rendering");
            interrupted = progress_.stopAsked();
            if (!request_.checkpoint.empty()) saveWhenDue(interrupted);
        }
        if (!request_.checkpoint.empty()) save();
        if (!loaded_) saveLight();
        if (!request_.pointsFolder.empty())
            writePointClouds(request_.pointsFolder,
                             light_.cache ? light_.cache->records() : std::vector<IrradianceRecord>(),
                             causticMap_ ? causticMap_->photons() : PhotonList(), scene_.normalisation());
        RenderResult result;
        result.image = film_.image(request_.layers);
        addRecordsLayer(result.image);
        result.interrupted = interrupted;
        result.record = record();
        return result;
    }

    /// For a flythrough: whether the plan of this view has a caustic map.
    [[nodiscard]] bool wantsCausticMap() {
        prepare();
        return plan_.causticMap;
    }
    /// What is known and what this view adds to it (in `generation`, where nothing is); as it was where the view has no cache.
    [[nodiscard]] std::optional<LearntLight> learn(std::optional<LearntLight> known, std::uint32_t generation) {
        prepare();
        if (!plan_.cache) return known;
        known_ = std::move(known);
        generation_ = generation;
        renewGeneration();
        return std::move(light_);
    }
    [[nodiscard]] std::optional<LearntLight> fromFile(const std::filesystem::path& file) {
        prepare();
        return readCacheFile(file, fileKey(), scene_.bounds());
    }
    void toFile(const std::filesystem::path& file, const LearntLight& light) {
        prepare();
        writeCacheFile(file, fileKey(), light);
    }
    /// All frames look at `light` and nothing is added.
    void freeze(const LearntLight& light) { frozen_ = light; }

private:
    void prepare();
    void iterate();
    [[nodiscard]] bool generationDue() const;
    void renewGeneration();
    void useFrozen();
    [[nodiscard]] CacheKey fileKey() const {
        return cacheKey(scene_, resolvedSettings(request_.settings, plan_), plan_.causticMap || plan_.causticChains);
    }
    void loadLight();
    void saveLight() const;
    void causticPass();
    void fitRadii();
    void lightPass();
    void eyePass();
    void renewShares();
    void setCausticPaths(std::uint32_t paths);
    /// With those before a break, which decide alike after it.
    [[nodiscard]] std::uint64_t causticRaysSoFar() const noexcept { return causticRaysBefore_ + causticStage_.rays; }
    [[nodiscard]] std::uint64_t causticEmittedSoFar() const noexcept {
        return causticEmittedBefore_ + causticStage_.photonsEmitted;
    }
    void makeMaps();
    [[nodiscard]] LayeredRadiance samplePixel(Walk& walk, int x, int y, int number, FirstHit& first,
                                              StringSums* strings = nullptr) const;
    [[nodiscard]] std::uint32_t samplesPerPixel() const;
    void bidirectionalPass();
    [[nodiscard]] bool bidirectional() const noexcept { return request_.method == Method::Bdpt || plan_.bidirectional; }
    [[nodiscard]] LayeredRadiance sampleBidirectional(Bidirectional& paths, std::size_t pixel, const glm::vec2& corner,
                                                      std::vector<LightSplat>& splats, FirstHit& first,
                                                      StringSums* strings) const;
    template <class Body>
    void forTiles(const Body& body) const;
    [[nodiscard]] std::size_t tiles() const;
    [[nodiscard]] bool finished() const;
    void keepWindows();
    [[nodiscard]] std::uint64_t ofWholeImage(std::uint64_t rays) const;
    [[nodiscard]] std::uint64_t raysSoFar() const;
    [[nodiscard]] bool outOfTime(double share) const {
        return request_.budget.seconds && elapsed() > share * *request_.budget.seconds;
    }
    /// With what the passes over pixels would have taken for the whole image.
    [[nodiscard]] double elapsed() const {
        const double overPixels = cacheStage_.seconds + eyeStage_.seconds;
        return secondsSince(start_) + request_.budget.startedSecondsAgo + overPixels * (1.0 - 1.0 / windowScale_);
    }
    [[nodiscard]] std::size_t pixelIndex(int x, int y) const noexcept {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width()) + static_cast<std::size_t>(x);
    }
    [[nodiscard]] RenderRecord record() const;
    void tell(std::string_view stage) const;
    /// Iterations 0, 1, 3, 7, ...: guide and radii learn from their photons.
    [[nodiscard]] bool learningIteration() const noexcept { return (iteration_ & (iteration_ + 1)) == 0; }
    [[nodiscard]] float kernelFootprints(int x, int y) const noexcept {
        return (kernelRadii_ ? kernelRadii_->at(x, y) : plan_.causticFootprints) *
               static_cast<float>(std::sqrt(radiusScale_));
    }
    void learn(std::vector<UsefulEmission> useful);
    void weighByNeed(std::vector<UsefulEmission>& useful) const;
    void addRecordsLayer(Image& image) const;
    void save() const;
    void saveWhenDue(bool now);
    void resume();
    [[nodiscard]] CheckpointKey checkpointKey() const;
    [[nodiscard]] double fractionDone() const;

    const Scene& scene_;
    const RenderRequest& request_;
    const Workers& workers_;
    const Progress& progress_;
    Clock::time_point start_;
    Camera camera_;
    TransportContext context_;
    Film film_;
    Survey survey_;
    Plan plan_;
    std::unique_ptr<EmissionGuide> guide_;
    std::unique_ptr<KernelRadii> kernelRadii_;  ///< none: one radius for all pixels
    std::unique_ptr<CausticMap> causticMap_;
    std::unique_ptr<TexelIrradiance> texels_;
    std::vector<LightSplat> lightSplats_;
    LearntLight light_;                  ///< of the running generation
    std::optional<LearntLight> known_;   ///< to start from
    std::optional<LearntLight> frozen_;  ///< of a flythrough: for the whole render
    bool loaded_ = false;
    double raysLoaded_ = 0.0;
    ReuseReport reuse_;
    double radiusScale_ = 1.0;                                        ///< squared, of the caustic kernel
    std::vector<bool> inWindow_;                                      ///< by pixel; empty: all are
    double windowScale_ = 1.0;                                        ///< pixels of the image / pixels in windows
    std::uint64_t causticRaysBefore_ = 0, causticEmittedBefore_ = 0;  ///< before a break
    std::uint32_t iteration_ = 0, generation_ = 0;
    double raysOfGeneration_ = 0.0, raysSince_ = 0.0, secondsOfGeneration_ = 0.0, secondsOfIteration_ = 0.0;
    double lastSave_ = 0.0;
    StageRecord pilotStage_{"pilot"}, causticStage_{"caustic photons"}, globalStage_{"global photons"},
        cacheStage_{"irradiance cache"}, lightStage_{"light tracing"}, eyeStage_{"eye pass"};
};

void Renderer::prepare() {
    const StageTimer timer(pilotStage_);
    const auto& layers = request_.layers;
    if (std::find(layers.begin(), layers.end(), "classes") != layers.end()) film_.keepStrings(scene_.lobeKinds());
    if (request_.method != Method::Path && request_.method != Method::Bdpt) {
        survey_ = survey(context_, camera_, request_.seed,
                         std::max(KernelRadiusOptions{}.largest, static_cast<float>(request_.settings.causticRadius)),
                         kMaxCausticRadius * scene_.radius(), workers_);
        pilotStage_.rays += survey_.rays;
    }
    plan_ = makePlan(scene_, camera_, request_, survey_, workers_);
    if (auto remark = endlessRemark(scene_, camera_)) plan_.blindSpots.push_back(*remark);
    pilotStage_.rays += plan_.pilotRays;
    pilotStage_.photonsEmitted += plan_.pilotPhotons;
    if (plan_.causticMap && plan_.adaptiveRadius)
        kernelRadii_ =
            std::make_unique<KernelRadii>(camera_.width(), camera_.height(), radiusOptions(request_.settings));
    if (request_.method == Method::Reference) context_.options.left = {plan_.lightPass, plan_.texelWidth > 0.0F};
    if (plan_.texelWidth > 0.0F) texels_ = std::make_unique<TexelIrradiance>(scene_, camera_, plan_.texelWidth);
    if (plan_.causticMap || plan_.lightPass) guide_ = std::make_unique<EmissionGuide>(scene_.lights(), plan_.training);
    context_.options.splitLampChains = plan_.splitLampChains;
    context_.maps.causticChains = plan_.causticChains;
    setCausticPaths(plan_.causticPaths);
    if (plan_.adaptive && plan_.causticMap && request_.budget.seconds.value_or(2.0 * kShortBudget) > kShortBudget)
        film_.setShares(std::vector<std::uint8_t>(film_.pixels(), kFirstShare));
    if (!request_.windows.empty()) keepWindows();
    if (!request_.cacheFile.empty()) loadLight();
}

/// After the plan, which is that of the whole image.
void Renderer::keepWindows() {
    inWindow_.assign(film_.pixels(), false);
    for (const PixelWindow& w : request_.windows)
        for (int y = std::max(0, w.y0); y < std::min(w.y1, camera_.height()); ++y)
            for (int x = std::max(0, w.x0); x < std::min(w.x1, camera_.width()); ++x)
                inWindow_[static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width()) +
                          static_cast<std::size_t>(x)] = true;
    const auto inside = std::count(inWindow_.begin(), inWindow_.end(), true);
    windowScale_ = static_cast<double>(film_.pixels()) / static_cast<double>(std::max<std::ptrdiff_t>(1, inside));
    for (std::size_t i = 0; i < survey_.points.size(); ++i)
        if (!inWindow_[i]) survey_.points[i].valid = false;
}

std::uint64_t Renderer::ofWholeImage(std::uint64_t rays) const {
    return static_cast<std::uint64_t>(std::llround(static_cast<double>(rays) * windowScale_));
}

std::uint64_t Renderer::raysSoFar() const {
    std::uint64_t rays = 0;
    for (const StageRecord* s : {&pilotStage_, &globalStage_, &cacheStage_, &causticStage_, &lightStage_, &eyeStage_})
        rays += s->rays;
    return rays;
}

bool Renderer::generationDue() const {
    if (!plan_.cache || iteration_ == 0) return plan_.cache;
    if (frozen_) return false;
    if (raysSince_ <= kGenerationShare * raysOfGeneration_) return false;
    // Where little light is indirect its records may be the worse.
    const double patience = std::clamp(kMuchIndirect / std::max(film_.indirectShare(), 1e-6), 1.0, kMostPatience);
    if (raysSince_ <= kGenerationShare * patience * raysOfGeneration_) return false;
    // Near the end of a budget of time a new one would not be used enough.
    const double asLearnt =
        eyeStage_.seconds * raysOfGeneration_ / std::max(1.0, static_cast<double>(eyeStage_.rays));  // if it was loaded
    const double next = std::max(secondsOfGeneration_, loaded_ ? asLearnt : 0.0) * kGenerationGrowth;
    return !request_.budget.seconds || elapsed() + (1.0 + kGenerationShare) * next <= *request_.budget.seconds;
}

/// What the eye paths of this iteration read.
void Renderer::makeMaps() {
    if (generationDue()) renewGeneration();
    if (plan_.causticMap) causticPass();
}

void Renderer::iterate() {
    const double once = globalStage_.seconds + cacheStage_.seconds, began = elapsed();
    makeMaps();
    if (plan_.lightPass) lightPass();
    if (bidirectional())
        bidirectionalPass();
    else if (request_.method != Method::Light)
        eyePass();
    else
        film_.countSamples(1);
    secondsOfIteration_ = elapsed() - began - (globalStage_.seconds + cacheStage_.seconds - once);
}

/// Fresh global photons and fresh records, with an error bound that tightens; or what other views have learnt, and more of it.
void Renderer::renewGeneration() {
    if (frozen_) return useFrozen();
    const std::uint64_t raysBefore = globalStage_.rays + cacheStage_.rays;
    const Clock::time_point began = Clock::now();
    LearntLight light = known_ ? *std::exchange(known_, std::nullopt) : LearntLight{};
    if (!light.cache) {
        light.seed = request_.seed;
        light.generation = generation_;
        light.size = plan_.generation(generation_);
    }
    const bool first = !light_.cache;
    LearntLight before = std::exchange(light_, {});
    const auto cut = [this, first] {
        return progress_.stopAsked() || outOfTime(first ? kCacheShare : kLaterCacheShare);
    };
    const std::size_t places = light.map ? light.map->points() : 0,
                      records = light.cache ? light.cache->records().size() : 0;
    const std::uint64_t view = hashOf(survey_);
    const bool complete = std::find(light.seen.begin(), light.seen.end(), view) != light.seen.end();
    context_.maps.cache = nullptr;
    context_.maps.global = nullptr;
    if (plan_.globalMap && !complete) {
        const StageTimer timer(globalStage_);
        const GlobalPass pass = learnMap(context_, survey_, light, workers_);
        globalStage_.rays += pass.rays;
        globalStage_.photonsEmitted += pass.emitted;
        if (pass.emitted > 0) addEnergy(globalStage_, pass.energy);
        globalStage_.photonsStored += pass.photons.size();
    }
    context_.maps.global = light.map.get();
    // Gather rays leave to the caustic map what it will hold, also before its first pass.
    const CausticMap none{PhotonList{}};
    if (plan_.causticMap) context_.maps.caustic = &none;
    if (!complete) {
        const StageTimer timer(cacheStage_, windowScale_);
        CacheBuild build =
            buildCache(context_, survey_, camera_.width(), plan_, light.size, light.gatherSeed(), workers_, cut,
                       light.cache ? std::make_unique<IrradianceCache>(*light.cache) : nullptr);
        const bool whole = !cut();
        if (!whole && !first)
            light = std::move(before);  // whole records of the last generation rather than half of this one's
        else
            light.cache = std::move(build.cache);
        cacheStage_.rays += ofWholeImage(build.rays);
        if (whole || first) {
            cacheStage_.records += light.cache->records().size() - records;
            if (whole) light.seen.push_back(view);
            ++light.views;
        } else {
            raysSince_ = 0.0;
        }
    }
    context_.maps.caustic = causticMap_.get();
    context_.maps.cache = light.cache.get();
    context_.maps.global = light.map.get();
    light.rays += static_cast<double>(globalStage_.rays + cacheStage_.rays - raysBefore);
    if (first && light.map) reuse_.placesReused = places, reuse_.placesNew = light.map->points() - places;
    if (first) reuse_.recordsReused = records, reuse_.recordsNew = light.cache->records().size() - records;
    light_ = std::move(light);
    raysOfGeneration_ = light_.rays;
    raysSince_ = 0.0;
    secondsOfGeneration_ = secondsSince(began);
    generation_ = light_.generation + 1;
    if (first && loaded_) saveLight();
}

void Renderer::useFrozen() {
    light_ = *frozen_;
    context_.maps.global = light_.map.get();
    context_.maps.cache = light_.cache.get();
    reuse_ = {true, light_.cache->records().size(), 0, light_.map ? light_.map->points() : 0, 0};
    raysOfGeneration_ = light_.rays;
    generation_ = light_.generation + 1;
}

/// What was loaded is saved as soon as this view has added to it: a later generation would know this view alone.
void Renderer::loadLight() {
    reuse_.asked = true;
    if (!plan_.cache) return;
    known_ = readCacheFile(request_.cacheFile, fileKey(), scene_.bounds());
    loaded_ = known_.has_value();
    raysLoaded_ = loaded_ ? known_->rays : 0.0;
}

void Renderer::saveLight() const {
    if (request_.cacheFile.empty() || !light_.cache || light_.rays == raysLoaded_) return;
    writeCacheFile(request_.cacheFile, fileKey(), light_);
}

/// A photon weighs as much as the image wants it: with E of the caustics, L of the pixel and a kernel of radius r the relative
/// variance of a region is E / (n r^2 L^2) times the flux a photon; the least total asks for n ~ flux / (r L).
void Renderer::weighByNeed(std::vector<UsefulEmission>& useful) const {
    if (!kernelRadii_) return;
    double sum = 0.0;
    std::size_t seen = 0;
    std::vector<float> need(useful.size(), -1.0F);
    const double floor = kLeastLuminance * film_.meanLuminance();
    for (std::size_t i = 0; i < useful.size(); ++i) {
        const auto film = camera_.project(useful[i].landed, {0.5F, 0.5F});
        if (!film) continue;
        const int x = static_cast<int>(film->position.x), y = static_cast<int>(film->position.y);
        if (x < 0 || y < 0 || x >= camera_.width() || y >= camera_.height()) continue;
        const double pixel = film_.samples() > 0 ? film_.luminanceAt(x, y) + floor : 1.0;
        need[i] = static_cast<float>(1.0 / (static_cast<double>(kernelRadii_->at(x, y)) * std::max(pixel, 1e-12)));
        sum += static_cast<double>(need[i]);
        ++seen;
    }
    const auto mean = static_cast<float>(seen > 0 ? sum / static_cast<double>(seen) : 1.0);
    for (std::size_t i = 0; i < useful.size(); ++i) useful[i].weight *= need[i] >= 0.0F ? need[i] : mean;
}

void Renderer::learn(std::vector<UsefulEmission> useful) {
    if (request_.settings.guiding == "off" || plan_.training.size() >= kTrainingLimit || !learningIteration()) return;
    weighByNeed(useful);
    plan_.training = std::move(useful);
    guide_ = std::make_unique<EmissionGuide>(scene_.lights(), plan_.training);
}

void Renderer::causticPass() {
    const StageTimer timer(causticStage_);
    CausticPass pass = traceCausticPhotons(
        scene_, *guide_, {request_.seed, kCausticPass + iteration_, plan_.causticPaths}, &survey_.visible, workers_);
    causticStage_.rays += pass.rays;
    causticStage_.photonsEmitted += pass.emitted;
    addEnergy(causticStage_, pass.energy);
    causticStage_.photonsStored += pass.photons.size();
    causticMap_ = std::make_unique<CausticMap>(std::move(pass.photons), photonKernel(request_.settings.kernel));
    context_.maps.caustic = causticMap_.get();
    // r^2_{i+1} = r^2_i (i + alpha) / (i + 1) [KnausZwicker2011]
    if (iteration_ > 0) radiusScale_ *= (iteration_ + static_cast<double>(plan_.alpha)) / (iteration_ + 1.0);
    if (kernelRadii_) fitRadii();
    learn(std::move(pass.useful));
    context_.maps.causticRadiusMin = 4e-6F;
    context_.maps.causticRadiusMax = kMaxCausticRadius * scene_.radius();
}

/// Radii learn from the photons of iterations 0, 1, 3, 7, ... and are corrected after 8, 16, 32, ... by what the image shows.
void Renderer::fitRadii() {
    if (learningIteration()) kernelRadii_->learn(*causticMap_, survey_.points, workers_);
    const std::uint32_t n = film_.samples();
    if (n < kCorrectRadiiAfter || (n & (n - 1)) != 0) return;
    const double floor = kLeastLuminance * film_.meanLuminance();
    kernelRadii_->correct(
        n,
        [&](int x, int y) {
            const PixelNoise noise = film_.noise(pixelIndex(x, y));
            const double scale =
                static_cast<double>(noise.luminance) * static_cast<double>(noise.luminance) + floor * floor;
            return KernelRadii::Shown{static_cast<double>(noise.photonVariance) / scale,
                                      static_cast<double>(noise.blur2) / scale};
        },
        workers_);
}

void Renderer::lightPass() {
    const StageTimer timer(lightStage_);
    if (texels_) texels_->look(request_.seed, iteration_, workers_);
    LightPass pass =
        traceLightPaths(scene_, camera_, *guide_, {request_.seed, kLightPass + iteration_, plan_.causticPaths},
                        workers_, texels_ ? &survey_.visible : nullptr);
    lightStage_.rays += pass.rays;
    lightStage_.photonsEmitted += pass.emitted;
    addEnergy(lightStage_, pass.energy);
    lightStage_.photonsStored += pass.splats.size();
    if (texels_) {
        texels_->deposit(pass.arrivals, iteration_);
        texels_->resolve(iteration_, pass.splats);
    }
    lightSplats_ = std::move(pass.splats);
    if (!plan_.bidirectional) film_.addSplats(lightSplats_, iteration_);
    learn(std::move(pass.useful));
}

/// Sample `number` of this iteration: keyed by seed, pixel and how many went before, whatever was sampled elsewhere.
LayeredRadiance Renderer::samplePixel(Walk& walk, int x, int y, int number, FirstHit& first,
                                      StringSums* strings) const {
    const std::size_t pixel = pixelIndex(x, y);
    const std::uint32_t index =
        (plan_.adaptive ? film_.taken(pixel) : film_.samples()) + static_cast<std::uint32_t>(number);
    Sampler sampler(request_.seed, pixel, index, samplerKind(request_.settings.sampler));
    const glm::vec2 jitter = sampler.next2D(), lens = sampler.next2D();
    const CameraRay ray = camera_.ray(glm::vec2(static_cast<float>(x), static_cast<float>(y)) + jitter, lens);
    return walk.fromEye({ray.ray, ray.footprintAtOrigin, ray.footprintSpread, Rgb(0.0F), kernelFootprints(x, y)},
                        sampler, &first, strings);
}

/// After iterations 4, 8, 16, ...: samples go where the noise is.
void Renderer::renewShares() {
    const std::uint32_t n = film_.samples();
    if (!plan_.adaptive || n < kUniformIterations || (n & (n - 1)) != 0) return;
    std::vector<PixelNoise> noise(film_.pixels());
    double eyeRays = 0.0;
    for (std::size_t i = 0; i < noise.size(); ++i) {
        noise[i] = film_.noise(i);
        if (noise[i].inside) eyeRays += static_cast<double>(noise[i].rays);
    }
    ShareLimits limits;
    if (plan_.causticMap)
        limits.photonRays =
            kPhotonRayTime * static_cast<double>(causticRaysSoFar()) / ((iteration_ + 1) * windowScale_);
    const Budget& b = request_.budget;
    const double once = eyeStage_.seconds * static_cast<double>(film_.pixels()) /
                        (windowScale_ * static_cast<double>(std::max<std::uint64_t>(1, film_.taken())));
    if (b.seconds)
        limits.mostMean =
            static_cast<float>(std::min<double>(limits.mostMean, kMostOfBudget * *b.seconds / std::max(1e-9, once)));
    if (b.rays)
        limits.mostMean = static_cast<float>(std::min<double>(
            limits.mostMean, kMostOfBudget * static_cast<double>(*b.rays) / std::max(1.0, eyeRays * windowScale_)));
    limits.fixedPhotons = !plan_.causticMap || request_.settings.causticPhotons >= 0;
    const SampleShares chosen =
        sampleShares(noise, camera_.width(), camera_.height(), limits, hashCombine(request_.seed, n));
    film_.setShares(chosen.ofPixel);
    if (limits.fixedPhotons) return;
    const double most = plan_.mostCausticPaths > 0 ? std::min<double>(plan_.mostCausticPaths, kMostPaths) : kMostPaths;
    const double paths = chosen.photons * static_cast<double>(causticEmittedSoFar()) / (iteration_ + 1);
    setCausticPaths(static_cast<std::uint32_t>(std::clamp(paths, std::min(kFewestPaths, most), most)));
}

void Renderer::setCausticPaths(std::uint32_t paths) {
    plan_.causticPaths = paths;
    context_.maps.photonsPerEtendue = static_cast<float>(plan_.causticPaths * plan_.guideGain);
}

std::uint32_t Renderer::samplesPerPixel() const {
    if (!plan_.adaptive) return film_.samples();
    return static_cast<std::uint32_t>(static_cast<double>(film_.taken()) * windowScale_ /
                                      static_cast<double>(film_.pixels()));
}

std::size_t Renderer::tiles() const {
    return static_cast<std::size_t>((camera_.width() + kTile - 1) / kTile) *
           static_cast<std::size_t>((camera_.height() + kTile - 1) / kTile);
}

/// Calls body(tile, pixels of the tile as (index, film position of its corner) callback) in parallel.
template <class Body>
void Renderer::forTiles(const Body& body) const {
    const int tilesX = (camera_.width() + kTile - 1) / kTile;
    workers_.forEach(tiles(), 1, [&](std::size_t tile) {
        const int x0 = static_cast<int>(tile) % tilesX * kTile, y0 = static_cast<int>(tile) / tilesX * kTile;
        body(tile, [&](const auto& visit) {
            for (int y = y0; y < std::min(y0 + kTile, camera_.height()); ++y)
                for (int x = x0; x < std::min(x0 + kTile, camera_.width()); ++x)
                    visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width()) +
                              static_cast<std::size_t>(x),
                          glm::vec2(static_cast<float>(x), static_cast<float>(y)));
        });
    });
}

void Renderer::eyePass() {
    const StageTimer timer(eyeStage_, windowScale_);
    renewShares();
    std::vector<std::uint64_t> rays(tiles(), 0);
    forTiles([&](std::size_t tile, const auto& forPixels) {
        Walk walk(context_);
        StringSums strings, ofSample;
        forPixels([&](std::size_t pixel, const glm::vec2& corner) {
            if (!inWindow_.empty() && !inWindow_[pixel]) return;
            const std::uint64_t before = walk.rays();
            const int share = film_.share(pixel);
            LayeredRadiance sum;
            FirstHit firsts;
            strings.clear();
            if (film_.keepsStrings()) sum.strings = &strings;
            for (int k = 0; k < share; ++k) {
                FirstHit first;
                ofSample.clear();
                const LayeredRadiance radiance =
                    samplePixel(walk, static_cast<int>(corner.x), static_cast<int>(corner.y), k, first,
                                film_.keepsStrings() ? &ofSample : nullptr);
                if (!film_.admit(pixel, film_.samples(), radiance)) continue;
                sum.addShare(radiance, 1.0F / static_cast<float>(share));
                firsts.addShare(first, 1.0F / static_cast<float>(share));
            }
            film_.add(pixel, film_.samples(), sum, firsts, share, walk.rays() - before);
        });
        rays[tile] = walk.rays();
    });
    film_.countSamples(1);
    const std::uint64_t total = ofWholeImage(std::accumulate(rays.begin(), rays.end(), std::uint64_t{0}));
    eyeStage_.rays += total;
    raysSince_ += static_cast<double>(total);
}

/// As samplePixel, with a light path of its own number beside the eye path.
LayeredRadiance Renderer::sampleBidirectional(Bidirectional& paths, std::size_t pixel, const glm::vec2& corner,
                                              std::vector<LightSplat>& splats, FirstHit& first,
                                              StringSums* strings) const {
    const SamplerKind numbers = samplerKind(request_.settings.sampler);
    Sampler eye(request_.seed, pixel, film_.samples(), numbers);
    Sampler light(request_.seed, kBidirectionalPass + film_.samples(), static_cast<std::uint32_t>(pixel), numbers);
    const glm::vec2 jitter = eye.next2D(), lens = eye.next2D();
    return paths.sample(camera_.ray(corner + jitter, lens).ray, eye, light, splats, &first, strings);
}

/// An eye path and a light path for every pixel. Splats wait in their tile and are added in the order of the tiles.
void Renderer::bidirectionalPass() {
    const StageTimer timer(eyeStage_);
    std::vector<std::uint64_t> rays(tiles(), 0);
    std::vector<std::vector<LightSplat>> splats(tiles());
    forTiles([&](std::size_t tile, const auto& forPixels) {
        Bidirectional paths(scene_, camera_, context_.options, static_cast<std::uint32_t>(film_.pixels()));
        StringSums strings;
        forPixels([&](std::size_t pixel, const glm::vec2& corner) {
            FirstHit first;
            strings.clear();
            const LayeredRadiance radiance = sampleBidirectional(paths, pixel, corner, splats[tile], first,
                                                                 film_.keepsStrings() ? &strings : nullptr);
            film_.add(pixel, film_.samples(), radiance, first);
        });
        rays[tile] = paths.rays();
    });
    std::vector<LightSplat> all = std::move(lightSplats_);  // of a light pass before this one
    lightSplats_.clear();
    for (const auto& s : splats) all.insert(all.end(), s.begin(), s.end());
    film_.addSplats(all, film_.samples());
    film_.countSamples(1);
    eyeStage_.rays += std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
    eyeStage_.photonsEmitted += film_.pixels();
}

double Renderer::fractionDone() const {
    const Budget& b = request_.budget;
    double fraction = 0.0;
    if (b.samples)
        fraction = std::max(fraction, static_cast<double>(samplesPerPixel()) / std::max<std::uint32_t>(1, *b.samples));
    if (b.seconds) fraction = std::max(fraction, elapsed() / std::max(1e-3, *b.seconds));
    if (b.rays)
        fraction = std::max(
            fraction, static_cast<double>(raysSoFar()) / static_cast<double>(std::max<std::uint64_t>(1, *b.rays)));
    if (!b.samples && !b.seconds && !b.rays) {
        const double target = b.error.value_or(kDefaultError), now = film_.relativeError();
        fraction = std::max(now > 0.0 ? std::pow(target / now, 2.0) : 1.0, elapsed() / plan_.timeCap);
    }
    return std::min(1.0, fraction);
}

bool Renderer::finished() const {
    const Budget& b = request_.budget;
    if (b.samples && samplesPerPixel() >= *b.samples) return true;
    if (iteration_ == 0) return false;
    const double writing = kSecondsToWritePixel * static_cast<double>(film_.pixels());
    if (b.seconds && elapsed() + 0.5 * secondsOfIteration_ + writing >= *b.seconds) return true;
    if (b.rays) {
        const std::uint64_t once = pilotStage_.rays + globalStage_.rays + cacheStage_.rays, all = raysSoFar();
        if (all + (all - once) / (2 * iteration_) >= *b.rays) return true;
    }
    const bool errorGiven = b.error || (!b.seconds && !b.samples && !b.rays);
    if (errorGiven && film_.samples() >= 4 && film_.relativeError() <= b.error.value_or(kDefaultError)) return true;
    return plan_.timeCap > 0.0 && elapsed() >= plan_.timeCap;
}

void Renderer::tell(std::string_view stage) const {
    if (!progress_.report) return;
    ProgressReport r;
    r.stage = stage;
    r.fraction = fractionDone();
    r.secondsElapsed = elapsed();
    if (r.fraction > 0.0) r.secondsLeft = r.secondsElapsed * (1.0 / r.fraction - 1.0);
    r.samplesPerSecond =
        static_cast<double>(samplesPerPixel()) * static_cast<double>(film_.pixels()) / std::max(1e-6, r.secondsElapsed);
    progress_.report(r);
}

RenderRecord Renderer::record() const {
    RenderRecord r;
    r.decisions = plan_.decisions;
    r.causticLinks = plan_.causticLinks;
    r.blindSpots = plan_.blindSpots;
    for (const StageRecord* s : {&pilotStage_, &globalStage_, &cacheStage_, &causticStage_, &lightStage_, &eyeStage_})
        r.stages.push_back(withMeanEnergy(*s, scene_.normalisation().scale()));
    r.iterations = iteration_;
    r.samplesPerPixel = samplesPerPixel();
    r.seconds = elapsed();
    r.errorEstimate = film_.relativeError();
    r.noiseEstimate = std::sqrt(film_.relativeNoise2());
    r.blurEstimate = std::sqrt(film_.relativeBlur2());
    r.nonfinite = film_.nonfinite();
    r.resolved = resolvedSettings(request_.settings, plan_);
    r.threads = workers_.threads();
    r.reuse = reuse_;
    if (texels_)
        r.texels = {texels_->texels(), static_cast<double>(plan_.texelWidth) / scene_.normalisation().scale(),
                    texels_->extrapolated()};
    return r;
}

/// records.Y: how many records of the last generation lie in each pixel.
void Renderer::addRecordsLayer(Image& image) const {
    bool wanted = false;
    for (const std::string& l : request_.layers) wanted = wanted || l == "records" || l == "all";
    if (!wanted || !light_.cache) return;
    std::vector<std::string> names = image.channelNames();
    names.emplace_back("records.Y");
    Image wider(image.width(), image.height(), names);
    for (std::size_t i = 0; i < image.pixels(); ++i)
        for (int c = 0; c < image.channels(); ++c) wider.at(i, c) = image.at(i, c);
    const int channel = wider.channels() - 1;
    for (const IrradianceRecord& r : light_.cache->records()) {
        const auto film = camera_.project(r.position, {0.5F, 0.5F});
        if (!film) continue;
        const int x = static_cast<int>(film->position.x), y = static_cast<int>(film->position.y);
        if (x < 0 || y < 0 || x >= image.width() || y >= image.height()) continue;
        wider.at(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width()) + static_cast<std::size_t>(x),
                 channel) += 1.0F;
    }
    image = std::move(wider);
}

CheckpointKey Renderer::checkpointKey() const {
    std::string key = scene_.hash() + "|" + std::to_string(static_cast<int>(request_.method)) + "|" +
                      std::to_string(request_.seed) + "|" + request_.camera + "|" + std::to_string(camera_.width()) +
                      "x" + std::to_string(camera_.height());
    for (const auto& [name, value] : settingsAsText(request_.settings)) key += "|" + name + "=" + value;
    for (const PixelWindow& w : request_.windows)
        for (const int side : {w.x0, w.y0, w.x1, w.y1}) key += "|" + std::to_string(side);
    return {key};
}

void Renderer::save() const {
    CheckpointState state{iteration_, generation_, raysOfGeneration_,  raysSince_,         film_.save(),
                          {},         {},          plan_.causticPaths, causticRaysSoFar(), causticEmittedSoFar()};
    state.training.resize(plan_.training.size() * sizeof(UsefulEmission));
    if (!plan_.training.empty()) std::memcpy(state.training.data(), plan_.training.data(), state.training.size());
    if (kernelRadii_) state.radii = kernelRadii_->save();
    writeCheckpoint(request_.checkpoint, checkpointKey(), state);
}

void Renderer::saveWhenDue(bool now) {
    constexpr double kSecondsBetween = 10.0;
    if (!now && elapsed() - lastSave_ < kSecondsBetween) return;
    save();
    lastSave_ = elapsed();
}

/// The records of the running generation are made again: keyed by seed and generation, they are the same. So the continued
/// image has the bits of an uninterrupted one.
void Renderer::resume() {
    const auto state = readCheckpoint(request_.checkpoint, checkpointKey());
    if (!state) return;
    setCausticPaths(state->causticPaths);
    causticRaysBefore_ = state->causticRays;
    causticEmittedBefore_ = state->causticEmitted;
    if (!film_.restore(state->film) || state->training.size() % sizeof(UsefulEmission) != 0 ||
        (kernelRadii_ && !kernelRadii_->restore(state->radii, workers_)))
        throw Error(ErrorKind::BadInput, "the checkpoint does not fit this image", request_.checkpoint.string(),
                    "delete it or render without --resume");
    plan_.training.resize(state->training.size() / sizeof(UsefulEmission));
    if (!plan_.training.empty()) std::memcpy(plan_.training.data(), state->training.data(), state->training.size());
    if (guide_) guide_ = std::make_unique<EmissionGuide>(scene_.lights(), plan_.training);
    if (plan_.cache && state->generation > 0) {
        generation_ = state->generation - 1;
        renewGeneration();
    }
    for (iteration_ = 0; iteration_ < state->iteration; ++iteration_)
        if (plan_.causticMap && iteration_ > 0)
            radiusScale_ *= (iteration_ + static_cast<double>(plan_.alpha)) / (iteration_ + 1.0);
    raysOfGeneration_ = state->raysOfGeneration;
    raysSince_ = state->raysSince;
}

}  // namespace

RenderResult render(const Scene& scene, const RenderRequest& request, const Workers& workers, const Progress& progress,
                    const LogSink& log) {
    (void)log;
    return Renderer(scene, request, workers, progress).run();
}

void renderViews(const Scene& scene, const RenderRequest& request, const std::vector<std::string>& cameras,
                 const FrameDone& done, const Workers& workers, const Progress& progress) {
    RenderRequest frame = request;
    frame.cacheFile.clear();
    const Clock::time_point start = Clock::now();
    std::size_t rendered = 0;
    Progress ofAll = progress;
    if (progress.report)
        ofAll.report = [&](ProgressReport r) {
            r.fraction = (static_cast<double>(rendered) + r.fraction) / static_cast<double>(cameras.size());
            r.secondsElapsed = secondsSince(start);
            if (r.fraction > 0.0) r.secondsLeft = r.secondsElapsed * (1.0 / r.fraction - 1.0);
            progress.report(r);
        };
    const auto forViews = [&](std::size_t passes, const auto& body) {
        for (std::size_t i = 0; i < passes * cameras.size() && !progress.stopAsked(); ++i) {
            frame.camera = cameras[i % cameras.size()];
            body(i);
        }
    };
    // One plan of the caustic map for all: records leave to it what it holds.
    forViews(1, [&](std::size_t) {
        if (frame.settings.causticMap == "auto" && Renderer(scene, frame, workers, progress).wantsCausticMap())
            frame.settings.causticMap = "on";
    });
    std::optional<LearntLight> light;
    if (!request.cacheFile.empty() && !cameras.empty()) {
        frame.camera = cameras.front();
        light = Renderer(scene, frame, workers, progress).fromFile(request.cacheFile);
    }
    const double before = light ? light->rays : 0.0;
    // Twice: what a later view adds shrinks the records of an earlier one beside it.
    constexpr std::size_t kSweeps = 2;
    const std::uint32_t generation = cameras.size() >= 8   ? 2
                                     : cameras.size() >= 3 ? 1
                                                           : 0;  // the more views share the cost the better
    forViews(kSweeps, [&](std::size_t i) {
        if (i >= cameras.size() && (!light || light->rays == before)) return;
        if (i == cameras.size()) light->seen.clear();
        light = Renderer(scene, frame, workers, progress).learn(std::move(light), generation);
    });
    if (!request.cacheFile.empty() && light && light->rays > before) {
        frame.camera = cameras.front();
        Renderer(scene, frame, workers, progress).toFile(request.cacheFile, *light);
    }
    forViews(1, [&](std::size_t i) {
        Renderer renderer(scene, frame, workers, ofAll);
        if (light) renderer.freeze(*light);
        done(i, renderer.run());
        rendered = i + 1;
    });
}

SampleReplay replaySample(const Scene& scene, const RenderRequest& request, int x, int y, std::uint32_t sample,
                          const Workers& workers, const Progress& progress) {
    return Renderer(scene, request, workers, progress).replay(x, y, sample);
}

RenderRecord planOnly(const Scene& scene, const RenderRequest& request, const Workers& workers, const LogSink& log) {
    (void)log;
    return Renderer(scene, request, workers, {}).plan();
}

}  // namespace pellucid

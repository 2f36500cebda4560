#include <pellucid/render/render.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <tuple>

#include <pellucid/base/error.h>
#include <pellucid/render/film.h>
#include <pellucid/render/plan.h>
#include <pellucid/transport/bidirectional.h>
#include <pellucid/transport/caustic_map.h>
#include <pellucid/transport/kernel_radius.h>
#include <pellucid/transport/photon_trace.h>
#include <pellucid/transport/radiance_map.h>
#include <pellucid/transport/texel_irradiance.h>

#include "cache_builder.h"
#include "checkpoint.h"

namespace pellucid {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTile = 16;
constexpr std::uint64_t kCausticPass = 1ULL << 40U, kGlobalPass = 2ULL << 40U, kLightPass = 3ULL << 40U, kCachePass = 4ULL << 40U,
                        kBidirectionalPass = 5ULL << 40U;
/// A new generation of records is due when the eye passes since the last have cost this many times as much as it did.
constexpr double kGenerationShare = 1.5;
/// Ward's a falls from generation to generation by this power of their number, so that the cache's bias vanishes.
constexpr double kErrorPower = 0.25;
/// The guide learns from each pass until it holds this many useful starts.
constexpr std::size_t kTrainingLimit = 400'000;
constexpr float kMaxCausticRadius = 0.05F;  ///< of the scene's radius
constexpr double kDefaultError = 0.05;

[[nodiscard]] double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Adds wall time to a stage while it lives.
class StageTimer {
public:
    explicit StageTimer(StageRecord& stage) : stage_(stage), start_(Clock::now()) {}
    ~StageTimer() { stage_.seconds += secondsSince(start_); }
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;

private:
    StageRecord& stage_;
    Clock::time_point start_;
};

[[nodiscard]] TransportOptions transportOptions(const RenderRequest& request) {
    TransportOptions o;
    o.powerHeuristic = request.settings.misHeuristic == "power";
    const auto& [directions, lights] = std::tie(request.settings.directions, request.settings.lightStrategy);
    o.directions = directions == "uniform" ? Directions::Uniform : directions == "cosine" ? Directions::Cosine : Directions::Bsdf;
    o.lights = lights == "none" ? LightStrategy::Chance : lights == "nee" ? LightStrategy::NextEvent : LightStrategy::Both;
    o.rouletteThreshold = static_cast<float>(request.settings.rouletteThreshold);
    o.maxDepth = request.settings.maxDepth;
    return o;
}

[[nodiscard]] SamplerKind samplerKind(const std::string& name) {
    if (name == "independent") return SamplerKind::Independent;
    if (name == "stratified") return SamplerKind::Stratified;
    return name == "halton" ? SamplerKind::Halton : SamplerKind::Sobol;
}

/// The loop of iterations: each one leaves a usable image.
class Renderer {
public:
    Renderer(const Scene& scene, const RenderRequest& request, const Workers& workers, const Progress& progress)
        : scene_(scene), request_(request), workers_(workers), progress_(progress), start_(Clock::now()),
          camera_(scene.camera(request.camera, request.width, request.height, request.settings.aperture, request.settings.focus)),
          context_{scene, transportOptions(request), {}}, film_(camera_.width(), camera_.height()) {}

    [[nodiscard]] RenderRecord plan() {
        prepare();
        return record();
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
        RenderResult result;
        result.image = film_.image(request_.layers);
        addRecordsLayer(result.image);
        result.interrupted = interrupted;
        result.record = record();
        return result;
    }

private:
    void prepare();
    void iterate();
    void renewGeneration();
    void causticPass();
    void lightPass();
    void eyePass();
    void bidirectionalPass();
    template <class Body>
    void forTiles(const Body& body) const;
    [[nodiscard]] std::size_t tiles() const;
    [[nodiscard]] bool finished() const;
    [[nodiscard]] double elapsed() const { return secondsSince(start_) + request_.budget.startedSecondsAgo; }
    [[nodiscard]] RenderRecord record() const;
    void tell(std::string_view stage) const;
    /// Iterations 0, 1, 3, 7, ...: guide and radii learn from their photons.
    [[nodiscard]] bool learningIteration() const noexcept { return (iteration_ & (iteration_ + 1)) == 0; }
    [[nodiscard]] float kernelFootprints(int x, int y) const noexcept {
        return (kernelRadii_ ? kernelRadii_->at(x, y) : plan_.causticFootprints) * static_cast<float>(std::sqrt(radiusScale_));
    }
    void learn(const std::vector<UsefulEmission>& useful);
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
    std::unique_ptr<RadianceMap> globalMap_;
    std::unique_ptr<TexelIrradiance> texels_;
    std::vector<LightSplat> lightSplats_;
    std::unique_ptr<IrradianceCache> cache_;
    double radiusScale_ = 1.0;         ///< squared, of the caustic kernel
    std::uint32_t iteration_ = 0, generation_ = 0;
    double raysOfGeneration_ = 0.0, raysSince_ = 0.0;
    double lastSave_ = 0.0;
    StageRecord pilotStage_{"pilot"}, causticStage_{"caustic photons"}, globalStage_{"global photons"}, cacheStage_{"irradiance cache"},
        lightStage_{"light tracing"}, eyeStage_{"eye pass"};
};

void Renderer::prepare() {
    const StageTimer timer(pilotStage_);
    const auto& layers = request_.layers;
    if (std::find(layers.begin(), layers.end(), "classes") != layers.end()) film_.keepStrings(scene_.lobeKinds());
    if (request_.method != Method::Path && request_.method != Method::Bdpt) {
        survey_ = survey(context_, camera_, request_.seed, workers_);
        pilotStage_.rays += survey_.rays;
    }
    plan_ = makePlan(scene_, camera_, request_, survey_, workers_);
    pilotStage_.rays += plan_.pilotRays;
    pilotStage_.photonsEmitted += plan_.pilotPhotons;
    if (plan_.causticMap && plan_.adaptiveRadius) kernelRadii_ = std::make_unique<KernelRadii>(camera_.width(), camera_.height(), KernelRadiusOptions{});
    if (request_.method == Method::Reference) context_.options.left = {plan_.lightPass, plan_.texelWidth > 0.0F};
    if (plan_.texelWidth > 0.0F) texels_ = std::make_unique<TexelIrradiance>(scene_, camera_, plan_.texelWidth);
    if (plan_.causticMap || plan_.lightPass) guide_ = std::make_unique<EmissionGuide>(scene_.lights(), plan_.training);
}

void Renderer::iterate() {
    if (plan_.cache && (iteration_ == 0 || raysSince_ > kGenerationShare * raysOfGeneration_)) renewGeneration();
    if (plan_.causticMap) causticPass();
    if (plan_.lightPass) lightPass();
    if (request_.method == Method::Bdpt || plan_.bidirectional) bidirectionalPass();
    else if (request_.method != Method::Light) eyePass();
    else film_.countSamples(1);
}

/// Fresh global photons and fresh records, with an error bound that tightens.
void Renderer::renewGeneration() {
    const std::uint64_t raysBefore = globalStage_.rays + cacheStage_.rays;
    context_.maps.cache = nullptr;
    context_.maps.global = nullptr;
    if (plan_.globalMap) {
        const StageTimer timer(globalStage_);
        const GlobalPass pass = traceGlobalPhotons(scene_, {request_.seed, kGlobalPass + generation_, plan_.globalPaths}, workers_);
        RadianceMapOptions options;
        options.maxRadius = 0.1F * scene_.radius();
        options.seed = hashCombine(request_.seed, kGlobalPass + generation_);
        globalMap_ = std::make_unique<RadianceMap>(scene_, pass.photons, options, workers_);
        context_.maps.global = globalMap_.get();
        globalStage_.rays += pass.rays + globalMap_->rays();
        globalStage_.photonsEmitted += pass.emitted;
        globalStage_.photonsStored += pass.photons.size();
    }
    // Gather rays leave to the caustic map what it will hold, also before its first pass.
    const CausticMap none{PhotonList{}};
    if (plan_.causticMap) context_.maps.caustic = &none;
    {
        const StageTimer timer(cacheStage_);
        const auto error = static_cast<float>(static_cast<double>(plan_.cacheError) * std::pow(generation_ + 1.0, -kErrorPower));
        CacheBuild build = buildCache(context_, survey_, camera_.width(), plan_, error, hashCombine(request_.seed, kCachePass + generation_),
                                      workers_, [this] { return progress_.stopAsked(); });
        cache_ = std::move(build.cache);
        cacheStage_.rays += build.rays;
        cacheStage_.records += cache_->records().size();
    }
    context_.maps.caustic = causticMap_.get();
    context_.maps.cache = cache_.get();
    raysOfGeneration_ = static_cast<double>(globalStage_.rays + cacheStage_.rays - raysBefore);
    raysSince_ = 0.0;
    ++generation_;
}

void Renderer::learn(const std::vector<UsefulEmission>& useful) {
    if (request_.settings.guiding == "off" || plan_.training.size() >= kTrainingLimit || !learningIteration()) return;
    plan_.training = useful;
    guide_ = std::make_unique<EmissionGuide>(scene_.lights(), plan_.training);
}

void Renderer::causticPass() {
    const StageTimer timer(causticStage_);
    CausticPass pass = traceCausticPhotons(scene_, *guide_, {request_.seed, kCausticPass + iteration_, plan_.causticPaths}, &survey_.visible, workers_);
    causticStage_.rays += pass.rays;
    causticStage_.photonsEmitted += pass.emitted;
    causticStage_.photonsStored += pass.photons.size();
    learn(pass.useful);
    causticMap_ = std::make_unique<CausticMap>(std::move(pass.photons));
    context_.maps.caustic = causticMap_.get();
    // r^2_{i+1} = r^2_i (i + alpha) / (i + 1) [KnausZwicker2011]
    if (iteration_ > 0) radiusScale_ *= (iteration_ + static_cast<double>(plan_.alpha)) / (iteration_ + 1.0);
    if (kernelRadii_ && learningIteration()) kernelRadii_->learn(*causticMap_, survey_.points, workers_);
    context_.maps.causticRadiusMin = 4e-6F;
    context_.maps.causticRadiusMax = kMaxCausticRadius * scene_.radius();
}

void Renderer::lightPass() {
    const StageTimer timer(lightStage_);
    if (texels_) texels_->look(request_.seed, iteration_, workers_);
    LightPass pass = traceLightPaths(scene_, camera_, *guide_, {request_.seed, kLightPass + iteration_, plan_.causticPaths}, workers_,
                                     texels_ ? &survey_.visible : nullptr);
    lightStage_.rays += pass.rays;
    lightStage_.photonsEmitted += pass.emitted;
    lightStage_.photonsStored += pass.splats.size();
    if (texels_) {
        texels_->deposit(pass.arrivals, iteration_);
        texels_->resolve(iteration_, pass.splats);
    }
    lightSplats_ = std::move(pass.splats);
    if (!plan_.bidirectional) film_.addSplats(lightSplats_, iteration_);
    learn(pass.useful);
}

std::size_t Renderer::tiles() const {
    return static_cast<std::size_t>((camera_.width() + kTile - 1) / kTile) * static_cast<std::size_t>((camera_.height() + kTile - 1) / kTile);
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
                    visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width()) + static_cast<std::size_t>(x),
                          glm::vec2(static_cast<float>(x), static_cast<float>(y)));
        });
    });
}

void Renderer::eyePass() {
    const StageTimer timer(eyeStage_);
    const SamplerKind numbers = samplerKind(request_.settings.sampler);
    std::vector<std::uint64_t> rays(tiles(), 0);
    forTiles([&](std::size_t tile, const auto& forPixels) {
        Walk walk(context_);
        StringSums strings;
        forPixels([&](std::size_t pixel, const glm::vec2& corner) {
            Sampler sampler(request_.seed, pixel, film_.samples(), numbers);
            const glm::vec2 jitter = sampler.next2D(), lens = sampler.next2D();
            const CameraRay ray = camera_.ray(corner + jitter, lens);
            FirstHit first;
            strings.clear();
            const LayeredRadiance radiance =
                walk.fromEye({ray.ray, ray.footprintAtOrigin, ray.footprintSpread, Rgb(0.0F),
                              kernelFootprints(static_cast<int>(corner.x), static_cast<int>(corner.y))}, sampler, &first,
                             film_.keepsStrings() ? &strings : nullptr);
            film_.add(pixel, film_.samples(), radiance, first);
        });
        rays[tile] = walk.rays();
    });
    film_.countSamples(1);
    const std::uint64_t total = std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
    eyeStage_.rays += total;
    raysSince_ += static_cast<double>(total);
}

/// An eye path and a light path for every pixel. Splats wait in their tile and are added in the order of the tiles.
void Renderer::bidirectionalPass() {
    const StageTimer timer(eyeStage_);
    const SamplerKind numbers = samplerKind(request_.settings.sampler);
    std::vector<std::uint64_t> rays(tiles(), 0);
    std::vector<std::vector<LightSplat>> splats(tiles());
    forTiles([&](std::size_t tile, const auto& forPixels) {
        Bidirectional paths(scene_, camera_, context_.options, static_cast<std::uint32_t>(film_.pixels()));
        StringSums strings;
        forPixels([&](std::size_t pixel, const glm::vec2& corner) {
            Sampler eye(request_.seed, pixel, film_.samples(), numbers);
            Sampler light(request_.seed, kBidirectionalPass + film_.samples(), static_cast<std::uint32_t>(pixel), numbers);
            const glm::vec2 jitter = eye.next2D(), lens = eye.next2D();
            FirstHit first;
            strings.clear();
            const LayeredRadiance radiance =
                paths.sample(camera_.ray(corner + jitter, lens).ray, eye, light, splats[tile], &first, film_.keepsStrings() ? &strings : nullptr);
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
    if (b.samples) fraction = std::max(fraction, static_cast<double>(film_.samples()) / std::max<std::uint32_t>(1, *b.samples));
    if (b.seconds) fraction = std::max(fraction, elapsed() / std::max(1e-3, *b.seconds));
    if (!b.samples && !b.seconds) {
        const double target = b.error.value_or(kDefaultError), now = film_.relativeError();
        fraction = std::max(now > 0.0 ? std::pow(target / now, 2.0) : 1.0, elapsed() / plan_.timeCap);
    }
    return std::min(1.0, fraction);
}

bool Renderer::finished() const {
    const Budget& b = request_.budget;
    if (b.samples && film_.samples() >= *b.samples) return true;
    if (iteration_ == 0) return false;
    const double perIteration = (secondsSince(start_) - pilotStage_.seconds - globalStage_.seconds - cacheStage_.seconds) / iteration_;
    if (b.seconds && elapsed() + 0.5 * perIteration >= *b.seconds) return true;
    const bool errorGiven = b.error || (!b.seconds && !b.samples);
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
    r.samplesPerSecond = static_cast<double>(film_.samples()) * static_cast<double>(film_.pixels()) / std::max(1e-6, r.secondsElapsed);
    progress_.report(r);
}

RenderRecord Renderer::record() const {
    RenderRecord r;
    r.decisions = plan_.decisions;
    r.blindSpots = plan_.blindSpots;
    for (const StageRecord* s : {&pilotStage_, &globalStage_, &cacheStage_, &causticStage_, &lightStage_, &eyeStage_}) r.stages.push_back(*s);
    r.iterations = iteration_;
    r.samplesPerPixel = film_.samples();
    r.seconds = elapsed();
    r.errorEstimate = film_.relativeError();
    r.nonfinite = film_.nonfinite();
    r.resolved = resolvedSettings(request_.settings, plan_);
    r.threads = workers_.threads();
    if (texels_) r.texels = {texels_->texels(), static_cast<double>(plan_.texelWidth) / scene_.normalisation().scale(), texels_->extrapolated()};
    return r;
}

/// records.Y: how many records of the last generation lie in each pixel.
void Renderer::addRecordsLayer(Image& image) const {
    bool wanted = false;
    for (const std::string& l : request_.layers) wanted = wanted || l == "records" || l == "all";
    if (!wanted || !cache_) return;
    std::vector<std::string> names = image.channelNames();
    names.emplace_back("records.Y");
    Image wider(image.width(), image.height(), names);
    for (std::size_t i = 0; i < image.pixels(); ++i)
        for (int c = 0; c < image.channels(); ++c) wider.at(i, c) = image.at(i, c);
    const int channel = wider.channels() - 1;
    for (const IrradianceRecord& r : cache_->records()) {
        const auto film = camera_.project(r.position, {0.5F, 0.5F});
        if (!film) continue;
        const int x = static_cast<int>(film->position.x), y = static_cast<int>(film->position.y);
        if (x < 0 || y < 0 || x >= image.width() || y >= image.height()) continue;
        wider.at(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width()) + static_cast<std::size_t>(x), channel) += 1.0F;
    }
    image = std::move(wider);
}

CheckpointKey Renderer::checkpointKey() const {
    std::string key = scene_.hash() + "|" + std::to_string(static_cast<int>(request_.method)) + "|" + std::to_string(request_.seed) + "|" +
                      request_.camera + "|" + std::to_string(camera_.width()) + "x" + std::to_string(camera_.height());
    for (const auto& [name, value] : settingsAsText(request_.settings)) key += "|" + name + "=" + value;
    return {key};
}

void Renderer::save() const { writeCheckpoint(request_.checkpoint, checkpointKey(), {iteration_, generation_, raysOfGeneration_, raysSince_, film_.save()}); }

void Renderer::saveWhenDue(bool now) {
    constexpr double kSecondsBetween = 10.0;
    if (!now && elapsed() - lastSave_ < kSecondsBetween) return;
    save();
    lastSave_ = elapsed();
}

/// Repeats what the eye passes need but the file does not hold (the guide's lessons, the records of the running generation):
/// all of it is keyed by seed and iteration, so the continued image has the bits of an uninterrupted one.
void Renderer::resume() {
    const auto state = readCheckpoint(request_.checkpoint, checkpointKey());
    if (!state) return;
    if (!film_.restore(state->film))
        throw Error(ErrorKind::BadInput, "the checkpoint does not fit this image", request_.checkpoint.string(), "delete it or render without --resume");
    if (plan_.cache && state->generation > 0) {
        generation_ = state->generation - 1;
        renewGeneration();
    }
    for (iteration_ = 0; iteration_ < state->iteration; ++iteration_) {
        if (plan_.causticMap && iteration_ > 0) radiusScale_ *= (iteration_ + static_cast<double>(plan_.alpha)) / (iteration_ + 1.0);
        if (!learningIteration() || !guide_) continue;
        if (plan_.causticMap) {
            CausticPass pass = traceCausticPhotons(scene_, *guide_, {request_.seed, kCausticPass + iteration_, plan_.causticPaths}, &survey_.visible, workers_);
            learn(pass.useful);
            if (kernelRadii_) kernelRadii_->learn(CausticMap(std::move(pass.photons)), survey_.points, workers_);
        }
        if (plan_.lightPass)
            learn(traceLightPaths(scene_, camera_, *guide_, {request_.seed, kLightPass + iteration_, plan_.causticPaths}, workers_, texels_ ? &survey_.visible : nullptr).useful);
    }
    raysOfGeneration_ = state->raysOfGeneration;
    raysSince_ = state->raysSince;
}

}  // namespace

RenderResult render(const Scene& scene, const RenderRequest& request, const Workers& workers, const Progress& progress, const LogSink& log) {
    (void)log;
    return Renderer(scene, request, workers, progress).run();
}

RenderRecord planOnly(const Scene& scene, const RenderRequest& request, const Workers& workers, const LogSink& log) {
    (void)log;
    return Renderer(scene, request, workers, {}).plan();
}

}  // namespace pellucid

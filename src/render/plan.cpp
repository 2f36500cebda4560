#include <pellucid/render/plan.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <pellucid/render/caustic_links.h>
#include <pellucid/transport/caster_aim.h>
#include <pellucid/transport/photon_trace.h>
#include <pellucid/transport/walk.h>

#include "caustic_choice.h"
#include "photon_memory.h"
#include "stages.h"
#include "visible_survey.h"

namespace pellucid {

namespace {

/// Pilot photons, then again this many times more where the first saw nothing useful.
constexpr std::uint32_t kPilotPaths = 60'000;
constexpr std::uint32_t kPilotRetryFactor = 10;
constexpr double kEnoughUseful = 400;
/// With fewer useful photons in the first look the next one is aimed at the casters.
constexpr double kFewUseful = 100;
constexpr std::uint64_t kPilotRounds = 6;
/// Of a budget of time, for the pilot: then it makes do with what it found.
constexpr double kPilotShare = 0.03;
/// Photons of a budget of fewer seconds are fewer in proportion, down to a share: a first picture is worth more than a fine one.
constexpr double kShortBudget = 2.5, kLeastOfShort = 0.2;
constexpr std::uint64_t kPilotPass = 0x70696c6f74ULL;
constexpr std::uint32_t kGlobalPaths = 75'000;
/// Caustic photon paths an iteration: so many that this many are useful, between two bounds.
constexpr double kUsefulPerPixel = 0.3, kPathsPerPixel = 0.5, kMostPathsPerPixel = 2.0;
constexpr double kOtherPathsPerPixel = 1.0;
constexpr float kSpacingOfImage = 0.1F;  ///< of its shorter side: the largest radius of a record
constexpr double kDefaultTimeCap = 120.0;

[[nodiscard]] bool isOff(const std::string& choice) { return choice == "off"; }
[[nodiscard]] bool isOn(const std::string& choice) { return choice == "on"; }

void decide(Plan& plan, std::string name, std::string choice, std::string reason, bool overridden = false) {
    plan.decisions.push_back({std::move(name), std::move(choice), std::move(reason), overridden});
}

[[nodiscard]] std::uint32_t withinShortBudget(double paths, const Budget& budget) {
    const double left = budget.seconds.value_or(kShortBudget) - budget.startedSecondsAgo;
    const double share = budget.seconds ? std::clamp(left / kShortBudget, kLeastOfShort, 1.0) : 1.0;
    return static_cast<std::uint32_t>(share * paths);
}

/// Of the paths that would be useful if they started without guide.
[[nodiscard]] double shareWithoutGuide(const std::vector<UsefulEmission>& useful, std::uint32_t paths) {
    double sum = 0.0;
    for (const UsefulEmission& e : useful) sum += 1.0 / static_cast<double>(e.density);
    return sum / paths;
}

/// Trains emission guiding; returns how many pilot photons were useful.
[[nodiscard]] std::size_t pilotCaustics(Plan& plan, const Scene& scene, const RenderRequest& request,
                                        const Survey& seen, const Workers& workers) {
    std::vector<UsefulEmission> useful;
    std::uint32_t paths = kPilotPaths;
    double unguided = 0.0;
    bool aimed = false;
    CasterTally tally(scene);
    const WallClock::time_point began = WallClock::now();
    const std::optional<double>& budget = request.budget.seconds;
    for (std::uint64_t attempt = 0; attempt < kPilotRounds; ++attempt) {
        const EmissionGuide guide(scene.lights(), useful);
        CausticPass pass = traceCausticPhotons(scene, guide, {request.seed, kPilotPass + attempt, paths}, &seen.visible,
                                               workers, &tally);
        plan.pilotRays += pass.rays;
        plan.pilotPhotons += pass.emitted;
        // Each guided look replaces the one before: its sample is the better one. Enough when it hardly finds more.
        const auto before = static_cast<double>(useful.size()), now = static_cast<double>(pass.useful.size());
        if (now == 0.0 && attempt > 1) break;  // what it began with was better
        useful = std::move(pass.useful);
        plan.usefulShare = now / paths;
        if (!(unguided > 0.0)) unguided = shareWithoutGuide(useful, paths);
        if (attempt == 0 && now < kFewUseful) {
            useful = aimAtCasters(scene, request.seed, workers);
            aimed = true;
            continue;
        }
        if (now == 0.0)
            paths = kPilotPaths * kPilotRetryFactor;
        else if (now >= kEnoughUseful && now < 1.3 * before && !aimed)
            break;
        if (now > 0.0 && budget && secondsSince(began) > kPilotShare * *budget) break;
        aimed = false;
    }
    plan.training = std::move(useful);
    plan.guideGain =
        unguided > 0.0 && !isOff(request.settings.guiding) ? std::max(1.0, plan.usefulShare / unguided) : 1.0;
    plan.causticLinks = causticLinks(scene, tally, seen.receivers);
    return plan.training.size();
}

void planCaustics(Plan& plan, const Scene& scene, const RenderRequest& request, const Survey& seen,
                  const Workers& workers) {
    const Settings& s = request.settings;
    const LobeKinds kinds = scene.lobeKinds();
    if (isOff(s.causticMap)) return decide(plan, "caustic map", "off", "asked for; its class is path traced", true);
    if ((kinds & kSpecular) == kNoLobe)
        return decide(plan, "caustic map", "off",
                      fmt::format("no material casts caustics: roughness above {} and no glass", s.castRoughness));
    if (seen.receivers == 0) return decide(plan, "caustic map", "off", "the camera sees no diffuse surface");
    if (s.causticMap == "auto" && !isOn(s.chance) && !isOff(s.cache) && request.method == Method::Photon)
        if (const auto reason = causticsLeftToEyePaths(scene)) {
            plan.causticsToEyePaths = true;
            return decide(plan, "caustic map", "off", *reason);
        }
    const std::size_t useful = pilotCaustics(plan, scene, request, seen, workers);
    if (useful == 0 && !isOn(s.causticMap) && request.method == Method::Photon)
        return decide(plan, "caustic map", "off",
                      fmt::format("0 of {} pilot photons arrived where the camera looks", plan.pilotPhotons));
    plan.causticMap = true;
    const double perPixel =
        std::clamp(kUsefulPerPixel / std::max(plan.usefulShare, 1e-6), kPathsPerPixel, kMostPathsPerPixel);
    const auto wanted = static_cast<double>(seen.points.size()) * perPixel;
    plan.causticPaths = s.causticPhotons >= 0 ? static_cast<std::uint32_t>(s.causticPhotons)
                                              : withinShortBudget(std::clamp(wanted, 2e4, 4e6), request.budget);
    const FittedPaths fitted = fitCausticPaths(plan.causticPaths, plan, scene, request, seen, workers);
    plan.causticPaths = fitted.paths;
    plan.mostCausticPaths = fitted.most;
    if (s.causticRadius > 0.0) {
        plan.adaptiveRadius = false;
        plan.causticFootprints = static_cast<float>(s.causticRadius);
    }
    plan.alpha = static_cast<float>(s.alpha);
    if (isOff(s.guiding)) plan.training.clear();
    decide(plan, "caustic map", "on", fmt::format("{} of {} pilot photons are useful", useful, plan.pilotPhotons),
           isOn(s.causticMap));
    decide(
        plan, "caustic photons", fmt::format("{} paths an iteration", plan.causticPaths),
        fmt::format("{:.2g} a pixel", static_cast<double>(plan.causticPaths) / static_cast<double>(seen.points.size())),
        s.causticPhotons >= 0);
    if (!fitted.remark.empty()) decide(plan, "caustic photons", "fewer", fitted.remark, true);
    if (s.kernel != Settings{}.kernel) decide(plan, "kernel", s.kernel, "asked for", true);
    decide(plan, "kernel radius",
           plan.adaptiveRadius ? "pixel by pixel" : fmt::format("{:.2f} pixel footprints", plan.causticFootprints),
           plan.adaptiveRadius ? "grows until it holds 60 photons or meets an edge" : "asked for",
           !plan.adaptiveRadius);
    decide(plan, "emission guiding", isOff(s.guiding) ? "off" : "on",
           fmt::format("{} useful starts in {} cells", useful, EmissionGuide(scene.lights(), plan.training).cells()),
           isOff(s.guiding));
}

void planIndirect(Plan& plan, const Scene& scene, const RenderRequest& request, const Survey& seen,
                  const Workers& workers) {
    const Settings& s = request.settings;
    if (isOff(s.cache)) {
        decide(plan, "irradiance cache", "off", "asked for; indirect light is path traced", true);
        return;
    }
    if (seen.receivers == 0) {
        decide(plan, "irradiance cache", "off", "the camera sees no diffuse surface");
        decide(plan, "global map", "off", "nothing gathers from it");
        return;
    }
    plan.cache = plan.globalMap = true;
    plan.globalPaths = s.globalPhotons >= 0 ? static_cast<std::uint32_t>(s.globalPhotons)
                                            : withinShortBudget(kGlobalPaths, request.budget);
    const FittedPaths fitted = fitGlobalPaths(plan.globalPaths, plan, scene, request, workers);
    plan.globalPaths = fitted.paths;
    plan.mostGlobalPaths = fitted.most;
    plan.growPhotons = s.globalPhotons < 0;
    plan.growRays = s.gatherRays <= 0;
    plan.globalMap = plan.globalPaths > 0;
    plan.cacheChoice = isOn(s.cacheChoice);
    plan.cacheMetric = s.cacheMetric == "ward"        ? CacheMetric::Ward
                       : s.cacheMetric == "tabellion" ? CacheMetric::Tabellion
                                                      : CacheMetric::Hessian;
    if (s.cacheError > 0.0) plan.cacheError = static_cast<float>(s.cacheError);
    if (s.gatherRays > 0) plan.gatherRays = s.gatherRays;
    if (s.minSpacing > 0.0) plan.minSpacing = static_cast<float>(s.minSpacing);
    if (s.maxSpacing > 0.0) plan.maxSpacing = std::max(static_cast<float>(s.maxSpacing), plan.minSpacing);
    const double share = 100.0 * static_cast<double>(seen.receivers) / static_cast<double>(seen.points.size());
    decide(plan, "irradiance cache", "on", fmt::format("{:.1f} % of the pixels end at a diffuse surface", share),
           isOn(s.cache));
    decide(plan, "global map", plan.globalMap ? "on" : "off",
           fmt::format("{} photon paths for the first generation of records{}", plan.globalPaths,
                       plan.growPhotons ? ", half as many more for each next" : ""),
           s.globalPhotons >= 0);
    if (!fitted.remark.empty()) decide(plan, "global photons", "fewer", fitted.remark, true);
}

/// Progressive photon mapping: what the caustic map does not hold.
void planOthers(Plan& plan, const Scene& scene, const RenderRequest& request, const Survey& seen,
                const Workers& workers) {
    const int asked = request.settings.globalPhotons;
    if (seen.receivers == 0) return decide(plan, "other photons", "off", "the camera sees no diffuse surface");
    plan.otherPhotons = true;
    const double wanted = kOtherPathsPerPixel * static_cast<double>(seen.points.size());
    plan.globalPaths =
        asked >= 0 ? static_cast<std::uint32_t>(asked) : static_cast<std::uint32_t>(std::clamp(wanted, 2e4, 4e6));
    const FittedPaths fitted = fitOtherPaths(plan.globalPaths, scene, request, seen, workers);
    plan.globalPaths = fitted.paths;
    decide(plan, "other photons", fmt::format("{} paths an iteration", plan.globalPaths),
           fmt::format("{:.2g} a pixel; what came directly is sampled from the lamps",
                       static_cast<double>(plan.globalPaths) / static_cast<double>(seen.points.size())),
           asked >= 0);
    if (!fitted.remark.empty()) decide(plan, "other photons", "fewer", fitted.remark, true);
}

[[nodiscard]] std::size_t pointLikeLights(const Lights& lights) {
    std::size_t count = 0;
    for (std::uint32_t l = 0; l < lights.count(); ++l) {
        const LightKind k = lights.kind(l);
        if (k == LightKind::Point || k == LightKind::Spot || k == LightKind::Directional) ++count;
    }
    return count;
}

/// What a reference adds to light tracing where caustics are.
void planReference(Plan& plan, const Scene& scene, const RenderRequest& request, const Survey& seen) {
    const std::size_t delta = pointLikeLights(scene.lights());
    plan.bidirectional = delta > 0;
    decide(plan, "eye paths", plan.bidirectional ? "bidirectional" : "path tracing",
           fmt::format("{} point-like light{}{}", delta, delta == 1 ? "" : "s",
                       delta > 0 ? ": path tracing sees nothing that their caustics light" : ""));
    if (seen.receivers == 0) return;
    plan.texelWidth = static_cast<float>(request.settings.texelWidth) * seen.medianFootprint;
    decide(plan, "texel irradiance", plan.texelWidth > 0.0F ? "on" : "off",
           fmt::format(
               "caustics in mirrors and through glass by texels {} pixel footprints wide and half that, extrapolated",
               request.settings.texelWidth),
           request.settings.texelWidth == 0.0);
}

/// How the eye's samples are spread. The baselines stay plain unless told otherwise.
void planEyePaths(Plan& plan, const Scene& scene, const RenderRequest& request) {
    const Settings& s = request.settings;
    const bool traces = request.method != Method::Light && request.method != Method::Bdpt && !plan.bidirectional;
    if (!traces) return;
    const bool plain = request.method == Method::Path;
    bool glass = false, seenLamps = scene.environment() != nullptr;
    for (const Material& m : scene.surfaces().materials()) glass = glass || m.transmission > 0.0F;
    for (std::uint32_t l = 0; l < scene.lights().count(); ++l)
        seenLamps = seenLamps || scene.lights().kind(l) == LightKind::Triangle;
    plan.splitLampChains = glass && seenLamps && (isOn(s.split) || (!plain && !isOff(s.split)));
    if (glass && seenLamps && !(plain && !isOn(s.split)))
        decide(plan, "lamps through glass", plan.splitLampChains ? "both ways" : "by chance",
               "the scene has glass, and lamps that can be seen", s.split != "auto");
    const bool progressive = request.method == Method::Sppm;  // each pixel counts its photons once an iteration
    plan.adaptive = !progressive && (isOn(s.adaptive) || (!plain && !isOff(s.adaptive) && !request.budget.samples));
    if (progressive) {
        decide(plan, "samples of a pixel", "one an iteration", "its radius follows the photons that it meets");
    } else if (!plain || plan.adaptive)
        decide(plan, "samples of a pixel", plan.adaptive ? "by its noise" : "alike",
               request.budget.samples ? "their number is asked for" : "learnt after iterations 2, 4, 8, 16, ...",
               s.adaptive != "auto");
}

/// Which classes the method cannot see: no sampler of its makes such a path.
void findBlindSpots(Plan& plan, const Scene& scene, const RenderRequest& request) {
    const std::size_t delta = pointLikeLights(scene.lights());
    const bool casts = (scene.lobeKinds() & kSpecular) != kNoLobe;
    if (delta > 0 && request.method == Method::Path && request.settings.lightStrategy == "none")
        plan.blindSpots.push_back(
            fmt::format("{} point-like light{}: path.lights=none meets lamps by chance, and these never", delta,
                        delta == 1 ? "" : "s"));
    if (!casts || delta == 0) return;
    const std::string which =
        fmt::format("{} point-like light{} and surfaces that cast caustics: ", delta, delta == 1 ? "" : "s");
    if (request.method == Method::Path)
        plan.blindSpots.push_back(which + "path tracing sees none of their caustics (E .. D S+ L)");
    if (request.method == Method::Reference)
        plan.blindSpots.push_back(
            which + (plan.texelWidth > 0.0F
                         ? "caustics of caustics that are themselves seen in a perfect mirror or through smooth glass "
                           "(E S+ D S+ D S+ L) and caustics on rough metal seen so are missing"
                         : "caustics that are themselves seen through glass or in a mirror (E S+ D S+ L) are missing"));
    if (request.method == Method::Bdpt)
        plan.blindSpots.push_back(which +
                                  "bidirectional path tracing sees none of their caustics behind perfect mirrors or "
                                  "smooth glass (E S+ D S+ L)");
    if ((request.method == Method::Photon || request.method == Method::Sppm) && !plan.causticMap &&
        !plan.causticsToEyePaths)
        plan.blindSpots.push_back(which + "the caustic map is off and path tracing sees none of it");
}

}  // namespace

GenerationSize Plan::generation(std::uint32_t number) const noexcept {
    constexpr double kPhotonGrowth = 1.5, kErrorPower = 0.25, kMostPhotons = 1e7;
    constexpr std::uint32_t kRayDoublings = 2;
    GenerationSize size{globalPaths, gatherRays, 0.0F};
    if (growPhotons)
        size.globalPaths =
            static_cast<std::uint32_t>(std::min(globalPaths * std::pow(kPhotonGrowth, number), kMostPhotons));
    if (mostGlobalPaths > 0) size.globalPaths = std::min(size.globalPaths, mostGlobalPaths);
    if (growRays) size.gatherRays <<= std::min(number, kRayDoublings);
    size.cacheError = static_cast<float>(static_cast<double>(cacheError) * std::pow(number + 1.0, -kErrorPower));
    return size;
}

Plan makePlan(const Scene& scene, const Camera& camera, const RenderRequest& request, const Survey& seen,
              const Workers& workers) {
    Plan plan;
    plan.alpha = static_cast<float>(request.settings.alpha);
    if (request.method == Method::Photon) {
        planCaustics(plan, scene, request, seen, workers);
        planIndirect(plan, scene, request, seen, workers);
    } else if (request.method == Method::Sppm) {
        planCaustics(plan, scene, request, seen, workers);
        planOthers(plan, scene, request, seen, workers);
    } else if (request.method == Method::Bdpt) {
        decide(plan, "light paths", fmt::format("{} a pass", camera.width() * camera.height()),
               "one for each eye path: connected to it vertex by vertex, and splatted on the whole image");
    } else if (request.method != Method::Path) {
        if ((scene.lobeKinds() & kSpecular) == kNoLobe) {
            decide(plan, "light tracing", "off", "no material casts caustics");
        } else {
            plan.lightPass = true;
            const std::size_t useful = pilotCaustics(plan, scene, request, seen, workers);
            plan.causticPaths =
                static_cast<std::uint32_t>(std::clamp(static_cast<double>(seen.points.size()), 2e4, 4e6));
            decide(plan, "light tracing", fmt::format("{} paths an iteration", plan.causticPaths),
                   fmt::format("{} of {} pilot photons are useful", useful, plan.pilotPhotons));
            if (request.method == Method::Reference) planReference(plan, scene, request, seen);
        }
    } else {
        decide(plan, "photons, cache", "off", "path tracing needs none");
    }
    const bool casts = (scene.lobeKinds() & kSpecular) != kNoLobe;
    plan.causticChains = (plan.cache || plan.otherPhotons) && casts &&
                         (plan.causticMap ? isOn(request.settings.chance)
                                          : isOff(request.settings.causticMap) || plan.causticsToEyePaths);
    const bool photons = request.method != Method::Path && request.method != Method::Bdpt;
    if (photons && plan.causticLinks.empty())
        plan.causticLinks = causticLinks(scene, CasterTally(scene), seen.receivers);
    if (photons && plan.pilotPhotons == 0 && plan.causticChains)
        for (CausticLink& link : plan.causticLinks)
            if (link.reason == kNoPilotPath) link.reason = "no photons: eye paths carry it, as the caustic map is off";
    planEyePaths(plan, scene, request);
    findBlindSpots(plan, scene, request);
    const Budget& b = request.budget;
    if (!b.seconds && !b.samples && !b.rays) {
        plan.timeCap = kDefaultTimeCap;
        decide(plan, "budget", fmt::format("relative error {}", b.error.value_or(0.05)),
               fmt::format("at most {} seconds", kDefaultTimeCap));
    }
    return plan;
}

Settings resolvedSettings(const Settings& asked, const Plan& plan) {
    Settings s = asked;
    s.causticMap = plan.causticMap ? "on" : "off";
    s.cache = plan.cache ? "on" : "off";
    s.guiding = plan.training.empty() ? "off" : "on";
    s.split = plan.splitLampChains ? "on" : "off";
    s.adaptive = plan.adaptive ? "on" : "off";
    s.causticPhotons = static_cast<int>(plan.causticPaths);
    s.globalPhotons = static_cast<int>(plan.globalPaths);
    if (!plan.adaptiveRadius) s.causticRadius = static_cast<double>(plan.causticFootprints);
    s.cacheError = static_cast<double>(plan.cacheError);
    s.gatherRays = plan.gatherRays;
    s.minSpacing = static_cast<double>(plan.minSpacing);
    s.maxSpacing = static_cast<double>(plan.maxSpacing);
    return s;
}

}  // namespace pellucid

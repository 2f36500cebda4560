// The plan's photons: a pilot finds where useful ones start, and each pass gets its size.
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <pellucid/render/caustic_links.h>
#include <pellucid/transport/caster_aim.h>
#include <pellucid/transport/photon_trace.h>

#include "caustic_choice.h"
#include "eye_pilot.h"
#include "learnt_light.h"
#include "photon_memory.h"
#include "plan_parts.h"
#include "setting_choices.h"
#include "stages.h"

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
constexpr double kShortBudget = 2.5, kShortForPilot = 8.0, kLeastOfShort = 0.2;
constexpr std::uint64_t kPilotPass = 0x70696c6f74ULL;
/// Global photon paths. With a budget of time fewer in proportion, down to a share, where the camera sees fewer receivers than so
/// many pixels.
constexpr std::uint32_t kGlobalPaths = 75'000;
constexpr double kManyReceivers = 4'000, kLeastOfGlobal = 0.1;
/// Of the shorter side of the image: the largest radius of a record.
constexpr float kMostOfSide = 0.125F;
/// Caustic photon paths an iteration: so many that this many are useful, between two bounds; all for a pixel that sees a
/// receiver.
constexpr double kUsefulPerPixel = 0.3, kPathsPerPixel = 0.5, kMostPathsPerPixel = 2.0;
/// Where fewer are useful than this share, the pass keeps rare bright paths out of the image and does little else: with a budget
/// of time it is smaller in proportion, down to a share.
constexpr double kHopefulShare = 0.005, kLeastOfHopeless = 0.2;
constexpr double kOtherPathsPerPixel = 1.0;
/// Pixels of a pilot of eye paths. With less of their noise from indirect diffuse light look-ups cost more than they save:
/// as measured on scenes under skies.
constexpr std::size_t kEyePilotPixels = 2048;
constexpr double kLeastIndirect = 0.08;
/// Rays of the first generation of records: of each global photon path, of each place of their map, and of all records.
constexpr double kRaysOfGlobalPath = 2.0, kRaysOfPlace = 12.0, kRaysOfRecords = 100'000.0;
/// So large a part of the noise has to go with them, for the share of the budget that they take: paths that meet records are
/// shorter, too.
constexpr double kNoiseForTime = 0.7;

/// A large image has time for few generations of records before its budget of time is over: its first one is finer, by up to so
/// many times as many rays, from so many pixels on and so many seconds a pixel on. [docs/benchmarks.md]
constexpr double kMostFiner = 2.0, kLargeImage = 131'072, kSecondsAPixel = 1.5e-5, kErrorOfRays = -0.25;

void sizeFirstGeneration(Plan& plan, const Settings& asked, const Budget& budget, std::size_t pixels) {
    const auto count = static_cast<double>(pixels);
    const auto seconds = budget.nominalSeconds();
    const bool hurried = seconds && *seconds < kSecondsAPixel * count;
    const double finer = hurried ? 1.0 : std::clamp(count / kLargeImage, 1.0, kMostFiner);
    plan.gatherRays =
        asked.gatherRays > 0 ? asked.gatherRays : static_cast<int>(finer * static_cast<double>(plan.gatherRays));
    plan.cacheError = static_cast<float>(asked.cacheError > 0.0
                                             ? asked.cacheError
                                             : static_cast<double>(plan.cacheError) * std::pow(finer, kErrorOfRays));
    const bool byName = asked.gatherRays > 0 || asked.cacheError > 0.0;
    decide(plan, "first records", fmt::format("{} rays, error {:.2g}", plan.gatherRays, plan.cacheError),
           byName        ? "asked for"
           : finer > 1.0 ? "so large an image sees few generations: its first is finer"
                         : "each generation is finer than the one before",
           byName);
}

[[nodiscard]] std::uint32_t withinShortBudget(double paths, const Budget& budget, double shortSeconds = kShortBudget) {
    const double share = budget.nominalSeconds().value_or(shortSeconds) / shortSeconds;
    return static_cast<std::uint32_t>(std::clamp(share, kLeastOfShort, 1.0) * paths);
}

/// Of the budget, what the first generation of records takes.
[[nodiscard]] double shareOfFirstRecords(std::uint32_t globalPaths, const EyePilot& pilot, const Budget& budget) {
    const double rays = kRaysOfGlobalPath * globalPaths + kRaysOfPlace * placesBeside(globalPaths) + kRaysOfRecords;
    if (budget.rays) return rays / static_cast<double>(std::max<std::uint64_t>(1, *budget.rays));
    if (!budget.seconds || pilot.rays == 0) return 0.0;
    const double seconds = rays * pilot.seconds / static_cast<double>(pilot.rays);
    return seconds / std::max(1e-3, *budget.seconds - budget.startedSecondsAgo);
}

/// Of the paths that would be useful if they started without guide.
[[nodiscard]] double shareWithoutGuide(const std::vector<UsefulEmission>& useful, std::uint32_t paths) {
    double sum = 0.0;
    for (const UsefulEmission& e : useful) sum += 1.0 / static_cast<double>(e.density);
    return sum / paths;
}

/// Whether path tracing would lose what caustics light in turn: E .. D D S+ L from lights that cannot be met.
[[nodiscard]] bool lightsReachCastersByPhotonsAlone(const Scene& scene) {
    return (scene.lobeKinds() & kSpecular) != kNoLobe && pointLikeLights(scene.lights()) > 0;
}

}  // namespace

std::size_t pilotCaustics(Plan& plan, const Scene& scene, const RenderRequest& request, const Survey& seen,
                          const Workers& workers) {
    std::vector<UsefulEmission> useful;
    std::uint32_t paths = withinShortBudget(kPilotPaths, request.budget, kShortForPilot);
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
    const double hope =
        request.budget.nominalSeconds() ? std::clamp(plan.usefulShare / kHopefulShare, kLeastOfHopeless, 1.0) : 1.0;
    const double wanted = hope * pathsOfPass(static_cast<double>(seen.receivers) * perPixel);
    plan.causticPaths = s.causticPhotons >= 0 ? static_cast<std::uint32_t>(s.causticPhotons)
                                              : withinShortBudget(wanted, request.budget);
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

void planIndirect(Plan& plan, const Scene& scene, const Camera& camera, const RenderRequest& request,
                  const Survey& seen, const Workers& workers) {
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
    const double ofGlobal = request.budget.nominalSeconds()
                                ? std::clamp(static_cast<double>(seen.receivers) / kManyReceivers, kLeastOfGlobal, 1.0)
                                : 1.0;
    plan.globalPaths = s.globalPhotons >= 0 ? static_cast<std::uint32_t>(s.globalPhotons)
                                            : withinShortBudget(ofGlobal * kGlobalPaths, request.budget);
    double share = 1.0;
    if (!isOn(s.cache) && request.cacheFile.empty() && !lightsReachCastersByPhotonsAlone(scene)) {
        const TransportContext context{scene, transportOptions(s), {}};
        const EyePilot pilot = pilotEyePaths(context, camera, request.seed, plan.causticMap, kEyePilotPixels, workers);
        plan.pilotRays += pilot.rays;
        share = pilot.indirectShare;
        const double ofBudget = shareOfFirstRecords(plan.globalPaths, pilot, request.budget);
        if (const double limit = std::clamp(kNoiseForTime * ofBudget, kLeastIndirect, 1.0); share < limit) {
            plan.globalPaths = 0;
            decide(
                plan, "irradiance cache", "off",
                fmt::format(
                    "{:.1f} % of path tracing's noise is indirect diffuse light (limit {:.0f} %{}): it is path traced",
                    100.0 * share, 100.0 * limit,
                    limit > kLeastIndirect
                        ? fmt::format(", as the first records would take {:.0f} % of the budget", 100.0 * ofBudget)
                        : ""));
            return decide(plan, "global map", "off", "nothing gathers from it");
        }
    }
    plan.cache = plan.globalMap = true;
    const FittedPaths fitted = fitGlobalPaths(plan.globalPaths, plan, scene, request, workers);
    plan.globalPaths = fitted.paths;
    plan.mostGlobalPaths = fitted.most;
    plan.growPhotons = s.globalPhotons < 0;
    plan.growRays = s.gatherRays <= 0;
    plan.shrinkSpacing = !(s.minSpacing > 0.0);
    plan.globalMap = plan.globalPaths > 0;
    plan.cacheChoice = isOn(s.cacheChoice);
    plan.gatherGuide = isOn(s.cacheGuide);
    plan.cacheMetric = s.cacheMetric == "ward"        ? CacheMetric::Ward
                       : s.cacheMetric == "tabellion" ? CacheMetric::Tabellion
                                                      : CacheMetric::Hessian;
    if (s.minSpacing > 0.0) plan.minSpacing = static_cast<float>(s.minSpacing);
    // A record of few rays in the open may see nothing at all; it must not say so to half of a small image.
    const float ofSide = kMostOfSide * static_cast<float>(std::min(camera.width(), camera.height()));
    const float most = s.maxSpacing > 0.0 ? static_cast<float>(s.maxSpacing) : std::min(plan.maxSpacing, ofSide);
    plan.maxSpacing = std::max(most, plan.minSpacing);
    const double receivers = 100.0 * static_cast<double>(seen.receivers) / static_cast<double>(seen.points.size());
    decide(plan, "irradiance cache", "on",
           fmt::format("{:.1f} % of the pixels end at a diffuse surface{}", receivers,
                       share < 1.0
                           ? fmt::format(", {:.0f} % of path tracing's noise is indirect diffuse light", 100.0 * share)
                           : ""),
           isOn(s.cache));
    decide(plan, "global map", plan.globalMap ? "on" : "off",
           fmt::format("{} photon paths for the first generation of records{}", plan.globalPaths,
                       plan.growPhotons ? ", half as many more for each next" : ""),
           s.globalPhotons >= 0);
    if (!fitted.remark.empty()) decide(plan, "global photons", "fewer", fitted.remark, true);
    sizeFirstGeneration(plan, s, request.budget, seen.points.size());
}

void planOthers(Plan& plan, const Scene& scene, const RenderRequest& request, const Survey& seen,
                const Workers& workers) {
    const int asked = request.settings.globalPhotons;
    if (seen.receivers == 0) return decide(plan, "other photons", "off", "the camera sees no diffuse surface");
    plan.otherPhotons = true;
    const double wanted = kOtherPathsPerPixel * static_cast<double>(seen.points.size());
    plan.globalPaths = asked >= 0 ? static_cast<std::uint32_t>(asked) : pathsOfPass(wanted);
    const FittedPaths fitted = fitOtherPaths(plan.globalPaths, scene, request, seen, workers);
    plan.globalPaths = fitted.paths;
    decide(plan, "other photons", fmt::format("{} paths an iteration", plan.globalPaths),
           fmt::format("{:.2g} a pixel; what came directly is sampled from the lamps",
                       static_cast<double>(plan.globalPaths) / static_cast<double>(seen.points.size())),
           asked >= 0);
    if (!fitted.remark.empty()) decide(plan, "other photons", "fewer", fitted.remark, true);
}

}  // namespace pellucid

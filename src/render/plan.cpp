#include <pellucid/render/plan.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <pellucid/render/caustic_links.h>
#include <pellucid/transport/walk.h>

#include "plan_parts.h"

namespace pellucid {

namespace {

constexpr double kDefaultTimeCap = 120.0;

/// What a reference adds to light tracing where caustics are. What those light in turn (E D D S+ L) path tracing sees by the
/// rare chance to meet a small lamp: light paths that are joined with eye paths carry it. From an environment they seldom
/// come where they are wanted.
void planReference(Plan& plan, const Scene& scene, const RenderRequest& request, const Survey& seen) {
    const std::size_t delta = pointLikeLights(scene.lights());
    const std::string& asked = request.settings.referencePaths;
    const bool sky = scene.environment() != nullptr;
    const bool seesNone = seen.receivers == 0;
    plan.bidirectional = asked == "bdpt" || (asked == "auto" && (delta > 0 || (!sky && !seesNone)));
    decide(plan, "eye paths", plan.bidirectional ? "bidirectional" : "path tracing",
           delta > 0  ? fmt::format("{} point-like light{}: path tracing sees nothing that their caustics light", delta,
                                   delta == 1 ? "" : "s")
           : seesNone ? "the camera sees no diffuse surface"
           : sky      ? "an environment shines: few paths from it come to where they are wanted"
                      : "what caustics light in turn path tracing meets by rare chance",
           asked != "auto");
    if (seesNone) return;
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
    if (request.method == Method::Light) return;
    const bool plain = request.method == Method::Path || request.method == Method::Bdpt;
    bool glass = false, seenLamps = scene.environment() != nullptr;
    for (const Material& m : scene.surfaces().materials()) glass = glass || m.transmission > 0.0F;
    for (std::uint32_t l = 0; l < scene.lights().count(); ++l)
        seenLamps = seenLamps || scene.lights().kind(l) == LightKind::Triangle;
    const bool both = glass && (isOn(s.split) || (!plain && !isOff(s.split)));
    const bool oneWay = request.method == Method::Sppm;  // whose pixels count the photons of one place
    const bool twoSided = request.method == Method::Bdpt || plan.bidirectional;
    plan.splitGlass = both && !oneWay && !twoSided;
    plan.splitLampChains = both && seenLamps && (oneWay || twoSided);  // else those that split meet the lamps as well
    if (glass && !(plain && !isOn(s.split)))
        decide(plan, "eye paths at glass", both ? "both ways" : "by chance",
               seenLamps ? "the scene has glass, and lamps that can be seen" : "the scene has glass",
               s.split != "auto");
    if (request.method == Method::Bdpt || plan.bidirectional) return;
    const bool progressive = request.method == Method::Sppm;  // each pixel counts its photons once an iteration
    plan.adaptive = !progressive && (isOn(s.adaptive) || (!plain && !isOff(s.adaptive) && !request.budget.samples));
    if (progressive) {
        decide(plan, "samples of a pixel", "one an iteration", "its radius follows the photons that it meets");
    } else if (!plain || plan.adaptive)
        decide(plan, "samples of a pixel", plan.adaptive ? "by its noise" : "alike",
               request.budget.samples ? "their number is asked for" : "learnt after iterations 2, 4, 8, 16, ...",
               s.adaptive != "auto");
}

/// What materials and lights alone switch on.
void planScene(Plan& plan, const Scene& scene) {
    const SurfaceModel& surfaces = scene.surfaces();
    std::size_t absorb = 0, disperse = 0;
    for (std::uint32_t m = 0; m < surfaces.materials().size(); ++m) {
        const Material& material = surfaces.materials()[m];
        if (material.transmission > 0.0F && material.thickness > 0.0F && !isBlack(material.absorption)) ++absorb;
        if (surfaces.disperses(m)) ++disperse;
    }
    const bool sky = scene.environment() != nullptr;
    decide(plan, "environment sampling", sky ? "on" : "off",
           sky ? "directions by its radiance and by the cosine" : "the scene has no environment");
    decide(plan, "absorption in glass", absorb > 0 ? "on" : "off",
           fmt::format("{} material{} of bodies that absorb", absorb, absorb == 1 ? "" : "s"));
    decide(plan, "dispersion", disperse > 0 ? "on" : "off",
           fmt::format("{} material{} of smooth glass with a dispersion{}", disperse, disperse == 1 ? "" : "s",
                       disperse > 0 ? ": chains over it have one wavelength each" : ""));
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
    if (request.method == Method::Reference && !plan.bidirectional)
        plan.blindSpots.push_back(which +
                                  "reference.eye_paths=path sees nothing that their caustics light (E .. D D S+ L)");
    if (request.method == Method::Reference)
        plan.blindSpots.push_back(
            which + (plan.texelWidth > 0.0F
                         ? "what caustics make over casters twice and more, seen in a perfect mirror or through smooth "
                           "glass (E S+ D S+ D S+ D S+ L), and caustics on rough metal seen so are missing"
                         : "caustics that are themselves seen through glass or in a mirror (E S+ D S+ L) are missing"));
    if (request.method == Method::Bdpt)
        plan.blindSpots.push_back(which +
                                  "bidirectional path tracing sees none of their caustics behind perfect mirrors or "
                                  "smooth glass (E S+ D S+ L)");
    if (request.method != Method::Photon && request.method != Method::Sppm) return;
    if (!plan.causticMap && !plan.causticsToEyePaths)
        plan.blindSpots.push_back(which + "the caustic map is off and path tracing sees none of it");
    else if (plan.causticMap && (scene.lobeKinds() & kGlossy) != kNoLobe)
        plan.blindSpots.push_back(which +
                                  "photons are looked up by diffuse reflection alone; what rough metal and rough coats "
                                  "reflect of these caustics (E .. G S+ L) is missing, --method reference shows it");
}

}  // namespace

std::size_t pointLikeLights(const Lights& lights) {
    std::size_t count = 0;
    for (std::uint32_t l = 0; l < lights.count(); ++l) {
        const LightKind k = lights.kind(l);
        if (k == LightKind::Point || k == LightKind::Spot || k == LightKind::Directional) ++count;
    }
    return count;
}

GenerationSize Plan::generation(std::uint32_t number) const noexcept {
    constexpr double kPhotonGrowth = 1.5, kErrorPower = 0.25, kMostPhotons = 1e7;
    constexpr std::uint32_t kRayDoublings = 2, kSpacingHalvings = 3;
    constexpr int kMostRays = 512;
    GenerationSize size{globalPaths, gatherRays, 0.0F, minSpacing};
    if (growPhotons)
        size.globalPaths =
            static_cast<std::uint32_t>(std::min(globalPaths * std::pow(kPhotonGrowth, number), kMostPhotons));
    if (mostGlobalPaths > 0) size.globalPaths = std::min(size.globalPaths, mostGlobalPaths);
    if (growRays) size.gatherRays = std::min(gatherRays << std::min(number, kRayDoublings), kMostRays);
    size.cacheError = static_cast<float>(static_cast<double>(cacheError) * std::pow(number + 1.0, -kErrorPower));
    if (shrinkSpacing)
        size.minSpacing = minSpacing * std::exp2(-static_cast<float>(std::min(number, kSpacingHalvings)));
    return size;
}

Plan makePlan(const Scene& scene, const Camera& camera, const RenderRequest& request, const Survey& seen,
              const Workers& workers) {
    Plan plan;
    plan.alpha = static_cast<float>(request.settings.alpha);
    if (request.method == Method::Photon) {
        planCaustics(plan, scene, request, seen, workers);
        planIndirect(plan, scene, camera, request, seen, workers);
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
            plan.lightPass = true;  // unguided where one look a pixel met no receiver: there may be a small one
            const std::size_t useful = seen.receivers > 0 ? pilotCaustics(plan, scene, request, seen, workers) : 0;
            plan.causticPaths = pathsOfPass(static_cast<double>(seen.points.size()));
            decide(plan, "light tracing", fmt::format("{} paths an iteration", plan.causticPaths),
                   seen.receivers > 0 ? fmt::format("{} of {} pilot photons are useful", useful, plan.pilotPhotons)
                                      : "unguided: the camera sees no diffuse surface");
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
    planScene(plan, scene);
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
    s.split = plan.splitLampChains || plan.splitGlass ? "on" : "off";
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

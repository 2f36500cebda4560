// Energy: what the lamps emit in a photon pass ends somewhere, and in the shares that the materials say.
#include <cmath>

#include <pellucid/math/constants.h>
#include <pellucid/transport/light_trace.h>
#include <pellucid/transport/photon_trace.h>

#include "check_cases.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

constexpr std::uint32_t kPaths = 20'000;
constexpr double kRounding = 1e-9;

/// Every kind of surface that light can end at or pass: matt, clear and tinted glass, smooth and rough metal, a hole.
[[nodiscard]] SceneBuilder mixture() {
    SceneBuilder b;
    b.square({0, 0, 0}, {0, 0, 1}, 1.0, lambert(0.6F));
    b.quad({-1, 1, 0}, {2, 0, 0}, {0, 0, 1.5}, mirror(0.8F, 0.4F));
    b.quad({1, -1, 0}, {0, 0, 1.5}, {0, 2, 0}, mirror(0.7F));
    b.sphere({0.3, 0, 0.35}, 0.3, 24, glass(1.5F), true);
    b.box({-0.8, -0.4, 0.1}, {-0.3, 0.2, 0.5}, glass(1.5F, 2.0F));
    b.quad({-0.4, -0.3, 1.4}, {0, 0.5, 0}, {0.5, 0, 0}, lamp(6.0F));
    b.point({0.5, -0.5, 1.2}, 0.7);
    b.perspective({-0.8, -2.2, 1.1}, {0.05, 0.1, 0.3}, 0.7);
    return b;
}
/// Of the mixture's two lamps: pi A L from one side, and 4 pi I.
constexpr double kPower = kPiD * 0.25 * 6.0 + 4.0 * kPiD * 0.7;

struct Passes {
    EnergyBalance global, caustic, light;
    double photonFlux = 0.0;  ///< of the caustic photons
};
[[nodiscard]] Passes passes(const CheckContext& context, const Scene& scene, std::uint64_t seed) {
    const EmissionGuide unguided(scene.lights(), {});
    const CausticPass pilot = traceCausticPhotons(scene, unguided, {seed, 0, kPaths}, nullptr, context.workers);
    const EmissionGuide guide(scene.lights(), pilot.useful);
    const CausticPass caustic = traceCausticPhotons(scene, guide, {seed, 1, kPaths}, nullptr, context.workers);
    Passes result;
    result.caustic = caustic.energy;
    for (const Photon& p : caustic.photons)
        result.photonFlux +=
            (static_cast<double>(p.flux.r) + static_cast<double>(p.flux.g) + static_cast<double>(p.flux.b)) / 3.0;
    result.global = traceGlobalPhotons(scene, {seed, 2, kPaths}, context.workers).energy;
    const Camera camera = scene.camera("", 16, 16);
    result.light = traceLightPaths(scene, camera, guide, {seed, 3, kPaths}, context.workers).energy;
    return result;
}

std::vector<Finding> balance(const CheckContext& context) {
    const Scene scene = makeScene(context, mixture().description());
    const double watts = 1.0 / (scene.normalisation().scale() * scene.normalisation().scale());
    std::vector<Finding> all;
    const Passes once = passes(context, scene, context.seed);
    all.push_back(exact("emitted less all sinks, share, global pass", 0.0, once.global.residual(), kRounding));
    all.push_back(exact("the same, caustic pass", 0.0, once.caustic.residual(), kRounding));
    all.push_back(exact("the same, light tracing", 0.0, once.light.residual(), kRounding));
    all.push_back(exact("flux of the stored photons over `stored`", 1.0, once.photonFlux / once.caustic.stored, 1e-5));
    const auto seeds = [&](const char* quantity, double expected, double resolution, auto&& value) {
        all.push_back(measureSeeds(context, quantity, expected, 0.0, resolution,
                                   [&](std::uint64_t seed) { return value(passes(context, scene, seed)); }));
    };
    seeds("watts emitted, global pass", kPower, 0.05, [&](const Passes& p) { return p.global.emitted * watts; });
    seeds("watts emitted, caustic pass (guided)", kPower, 0.05,
          [&](const Passes& p) { return p.caustic.emitted * watts; });
    seeds("roulette's share, global pass", 0.0, 0.01,
          [](const Passes& p) { return p.global.roulette / p.global.emitted; });
    seeds("roulette's share, caustic pass", 0.0, 0.01,
          [](const Passes& p) { return p.caustic.roulette / p.caustic.emitted; });
    return all;
}

/// Where the shares are known: clear glass takes nothing, a matt floor of reflectance rho takes 1 - rho of what arrives.
std::vector<Finding> shares(const CheckContext& context) {
    SceneBuilder clear;
    clear.sphere(glm::dvec3(0.0), 0.5, 32, glass(1.5F), true);
    clear.point({0, 0, 2}, 1.0);
    clear.perspective({0, -3, 0}, glm::dvec3(0.0), 0.7);
    const Scene glassScene = makeScene(context, clear.description());
    SceneBuilder closed;
    closed.box(glm::dvec3(-1.0), glm::dvec3(1.0), lambert(0.25F), true);
    closed.point({0.2, 0.1, 0.3}, 1.0);
    closed.perspective({0.1, -0.2, 0.3}, {0.9, 0.5, -0.4}, 1.6);
    const Scene room = makeScene(context, closed.description());
    // A thousand bounces between flat faces: what is dropped at each for grazing would be missed in the end.
    SceneBuilder bright;
    bright.box(glm::dvec3(-1.0), glm::dvec3(1.0), lambert(0.999F), true);
    bright.point({0.2, 0.1, 0.3}, 1.0);
    bright.perspective({0.1, -0.2, 0.3}, {0.9, 0.5, -0.4}, 1.6);
    const EnergyBalance endless =
        traceGlobalPhotons(makeScene(context, bright.description()), {context.seed, 0, 200}, context.workers).energy;
    const auto global = [&context](const Scene& scene, std::uint64_t seed) {
        return traceGlobalPhotons(scene, {seed, 0, kPaths}, context.workers).energy;
    };
    return {measureSeeds(context, "share absorbed by clear glass", 0.0, 1e-6, 1e-3,
                         [&](std::uint64_t seed) {
                             const EnergyBalance e = global(glassScene, seed);
                             return e.absorbed / e.emitted;
                         }),
            measureSeeds(context, "share that escapes past clear glass", 1.0, 1e-3, 1e-3,
                         [&](std::uint64_t seed) {
                             const EnergyBalance e = global(glassScene, seed);
                             return e.escaped / e.emitted;
                         }),
            measureSeeds(context, "share absorbed in a closed room", 1.0, 1e-4, 0.02,
                         [&](std::uint64_t seed) {
                             const EnergyBalance e = global(room, seed);
                             return e.absorbed / e.emitted;
                         }),
            exact("share dropped or escaped over 1000 bounces between flat faces", 0.0,
                  (endless.dropped + endless.escaped) / endless.emitted, 0.0)};
}

}  // namespace

void addEnergy(Cases& cases) {
    cases.push_back(
        {"energy-of-photon-passes", CheckGroup::Energy,
         "emitted = escaped + absorbed + stored + left to others + roulette + dropped; lamps emit pi A L and 4 pi I",
         "energy conservation", true, balance});
    cases.push_back({"energy-shares", CheckGroup::Energy,
                     "clear glass takes nothing, a closed room everything and grazing light nothing",
                     "energy conservation", true, shares});
}

}  // namespace pellucid::check

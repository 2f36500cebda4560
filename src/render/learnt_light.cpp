#include "learnt_light.h"

#include <algorithm>
#include <bit>
#include <vector>

#include <pellucid/math/hash.h>

#include "pass_keys.h"

namespace pellucid {

namespace {

/// Where the global map is evaluated for gather rays: a place costs as much as ten photon paths, and the records of a first
/// generation ask few. [docs/benchmarks.md]
constexpr std::uint32_t kPathsOfPlace = 5, kFewestPlaces = 10'000, kMostPlaces = 60'000;
/// A map serves as it is when at most this share of the places that a view wants is missing.
constexpr double kMayMiss = 0.01;

}  // namespace

std::uint64_t LearntLight::gatherSeed() const noexcept {
    const std::uint64_t pass = refinements == 0 ? kCachePass : hashCombine(kRefinedPass, refinements);
    const std::uint64_t first = hashCombine(seed, pass + generation);
    return views == 0 ? first : hashCombine(first, views);
}

std::uint64_t hashOf(const Survey& survey) noexcept {
    std::uint64_t hash = survey.points.size();
    for (const GatherPoint& p : survey.points)
        if (p.valid)
            for (glm::length_t a = 0; a < 3; ++a) hash = hashCombine(hash, std::bit_cast<std::uint32_t>(p.position[a]));
    return hash;
}

std::uint32_t placesBeside(std::uint32_t globalPaths) noexcept {
    return std::clamp(globalPaths / kPathsOfPlace, kFewestPlaces, kMostPlaces);
}

GlobalPass learnMap(const TransportContext& context, const Survey& seen, LearntLight& light, const Workers& workers) {
    RadianceMapOptions options;
    options.maxRadius = kMaxMapRadius * context.scene.radius();
    options.seed = hashCombine(light.seed, kGlobalPass + light.generation);
    std::vector<GatherPoint> places =
        findPlaces(context, seen.points, placesBeside(light.size.globalPaths), options.seed, workers);
    if (light.map) {
        std::vector<std::uint8_t> missing(places.size(), 0);
        workers.forEach(places.size(), 256, [&](std::size_t i) {
            missing[i] = light.map->covers(places[i].position, places[i].geometricNormal) ? 0 : 1;
        });
        const auto count = static_cast<double>(std::count(missing.begin(), missing.end(), std::uint8_t{1}));
        if (count <= kMayMiss * static_cast<double>(places.size())) return {};
        std::vector<GatherPoint> kept;
        for (std::size_t i = 0; i < places.size(); ++i)
            if (missing[i] != 0) kept.push_back(places[i]);
        places = std::move(kept);
    }
    GlobalPass pass = traceGlobalPhotons(context.scene,
                                         {light.seed, kGlobalPass + light.generation, light.size.globalPaths}, workers);
    auto map = std::make_shared<RadianceMap>(context.scene, pass.photons, places, options, workers, light.map.get());
    pass.rays += map->rays();
    light.map = std::move(map);
    return pass;
}

}  // namespace pellucid

/// What one view has learnt of the light and another can use: the global map's places and the cache's records of one
/// generation. Neither depends on the camera but by where it stands; a further view adds what it lacks, made from the same
/// photons. (Caustic photons are fresh in every iteration: there is nothing to keep.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <pellucid/render/plan.h>
#include <pellucid/transport/irradiance_cache.h>
#include <pellucid/transport/photon_trace.h>
#include <pellucid/transport/radiance_map.h>

namespace pellucid {

/// Of the scene's radius: the largest kernel of the map.
constexpr float kMaxMapRadius = 0.1F;

struct LearntLight {
    std::uint64_t seed = 0;  ///< of photons, places and gather rays
    std::uint32_t generation = 0;
    std::uint32_t views = 0;  ///< that have added to it
    GenerationSize size;
    std::uint32_t refinements = 0;           ///< its records were made again so often, with more rays of the same map
    double rays = 0.0;                       ///< that it took
    std::vector<std::uint64_t> seen;         ///< hashes of the surveys that it is complete for
    std::shared_ptr<const RadianceMap> map;  ///< null: there is none
    std::shared_ptr<const IrradianceCache> cache;  ///< null: nothing is learnt yet

    /// Differs by generation and by the number of views before: no two views gather with the same numbers.
    [[nodiscard]] std::uint64_t gatherSeed() const noexcept;
};

/// How much of it came from elsewhere.
struct LearntCounts {
    std::size_t recordsReused = 0, recordsNew = 0, placesReused = 0, placesNew = 0;
};

/// Tells views apart by the points that they see.
[[nodiscard]] std::uint64_t hashOf(const Survey& survey) noexcept;

/// Tries at places of the global map of so many photon paths.
[[nodiscard]] std::uint32_t placesBeside(std::uint32_t globalPaths) noexcept;

/// Gives `light` a map for what is seen: a new one, or more places of the one that it has, where gather rays from here would
/// land and hardly find any. Returns the photon pass, with the rays of all; empty when the map that is there serves.
[[nodiscard]] GlobalPass learnMap(const TransportContext& context, const Survey& seen, LearntLight& light,
                                  const Workers& workers);

}  // namespace pellucid

/// The plan: what this scene needs and what is left out, each with its reason and number. Decided from materials, lights and
/// a short pilot; counted in rays and photons, never in seconds, so that the same scene and seed give the same plan.
#pragma once

#include <string>
#include <vector>

#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>
#include <pellucid/transport/cache_metric.h>
#include <pellucid/transport/emission_guide.h>
#include <pellucid/transport/visible_cells.h>
#include <pellucid/transport/walk.h>

namespace pellucid {

struct Receiver {
    glm::vec3 position{0.0F};
    float footprint = 0.0F;  ///< of a pixel there, scene units
};

/// What the camera sees at D vertices: a walk a pixel, through its middle.
struct Survey {
    std::vector<GatherPoint> points;  ///< by pixel, the first; not valid where no D vertex was found
    /// Receivers behind those, over other lobes of their surfaces: through half-clear glass, in the gloss of a floor.
    std::vector<Receiver> beyond;
    std::size_t receivers = 0;     ///< pixels with a valid one
    float medianFootprint = 0.0F;  ///< of a pixel there, scene units
    VisibleCells visible{1.0F};    ///< around points and receivers, as far as kernels reach
    std::uint64_t rays = 0;
};

/// What one generation of the cache is made with.
struct GenerationSize {
    std::uint32_t globalPaths = 0;
    int gatherRays = 0;       ///< a record
    float cacheError = 0.0F;  ///< Ward's a
    float minSpacing = 0.0F;  ///< of records, in footprints
};

struct Plan {
    bool causticMap = false, globalMap = false, cache = false, lightPass = false;
    bool otherPhotons = false;       ///< progressive photon mapping: a map of them beside the caustics'
    std::uint32_t causticPaths = 0;  ///< an iteration
    std::uint32_t globalPaths = 0;   ///< for the first generation of the cache; of an iteration for the other photons
    bool adaptiveRadius = true;      ///< of the caustic kernel, pixel by pixel
    float causticFootprints = 2.5F;  ///< kernel radius of the first iteration where it is not
    /// The caustic kernel's area shrinks by (i + alpha) / (i + 1) in iteration i.
    float alpha = 2.0F / 3.0F;
    /// Ward's a, in the first generation.
    float cacheError = 0.25F;
    CacheMetric cacheMetric = CacheMetric::Hessian;
    bool cacheChoice = true;             ///< where records do not pay, points gather for themselves
    bool gatherGuide = true;             ///< more gather rays where photons come from
    int gatherRays = 128;                ///< a record, in the first generation
    std::uint32_t mostCausticPaths = 0;  ///< of any iteration, for photon.memory; 0: no limit
    std::uint32_t mostGlobalPaths = 0;   ///< of any generation, for photon.memory; 0: no limit
    /// From generation to generation.
    bool growPhotons = true, growRays = true, shrinkSpacing = true;
    float minSpacing = 3.0F, maxSpacing = 40.0F;  ///< of records, in footprints; the least of the first generation
    bool causticsToEyePaths = false;  ///< where they see more than photons would: then there is no caustic map
    bool causticChains = false;    ///< beside the cache eye paths follow S chains to the lamps, alone or with a share
    bool bidirectional = false;    ///< eye paths meet light paths
    float texelWidth = 0.0F;       ///< of the texel irradiance, scene units; 0: off
    bool splitLampChains = false;  ///< only lamps seen through smooth glass: both ways at each interface
    bool splitGlass = false;       ///< all that is seen through it
    bool adaptive = false;         ///< pixels take samples by their noise
    std::vector<UsefulEmission> training;
    std::vector<Decision> decisions;
    std::vector<CausticLink> causticLinks;
    std::vector<std::string> blindSpots;
    double timeCap = 0.0;  ///< seconds, for a render that has only an error to reach; 0: none
    std::uint64_t pilotRays = 0, pilotPhotons = 0;
    double usefulShare = 0.0;  ///< of the photon paths, in the last look of the pilot
    double guideGain = 1.0;    ///< that share over the one without guide

    /// A quick first generation, then ever better ones: more photons and rays, a smaller error and spacing, so that the bias of
    /// map and cache vanishes as time goes on. What was set by name stays, but for the error.
    [[nodiscard]] GenerationSize generation(std::uint32_t number) const noexcept;
};

/// `kernelFootprints`, `largestKernel` (scene units): how far kernels may reach from what is seen.
[[nodiscard]] Survey survey(const TransportContext& context, const Camera& camera, std::uint64_t seed,
                            float kernelFootprints, float largestKernel, const Workers& workers);

[[nodiscard]] Plan makePlan(const Scene& scene, const Camera& camera, const RenderRequest& request, const Survey& seen,
                            const Workers& workers);

/// The settings with every automatic choice replaced by what the plan decided.
[[nodiscard]] Settings resolvedSettings(const Settings& asked, const Plan& plan);

}  // namespace pellucid

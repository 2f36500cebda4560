/// The hemisphere gather that makes one irradiance record: M x N stratified cosine-distributed rays give the irradiance, its
/// two gradients [WardHeckbert1992, signs and sums as in docs/theory.md], how far the record may speak, by the metric of
/// `cache.metric`, and where something stands in its way.
#pragma once

#include <cstdint>

#include <pellucid/transport/cache_metric.h>
#include <pellucid/transport/gather_guide.h>
#include <pellucid/transport/irradiance_cache.h>
#include <pellucid/transport/walk.h>

namespace pellucid {

struct GatherOptions {
    int rays = 400;                            ///< about; rounded to M x N with N about pi M
    float minRadius = 0.0F, maxRadius = 1.0F;  ///< bounds of R, scene units
    std::uint64_t seed = 0;
    CacheMetric metric = CacheMetric::Ward;
    float sceneRadius = 1.0F;            ///< the unit of the Hessian's radii
    float reach = 1.0F;                  ///< of the radius: how far look-ups may lie
    const GatherGuide* guide = nullptr;  ///< more rays where photons come from; null: one a stratum
};

/// `point` must be valid; the record is of its normal without normal maps. `key` identifies the record among all of the render.
/// `light` receives what came by direction (null: nobody asks). Returns a record with bounded radius.
[[nodiscard]] IrradianceRecord gatherRecord(Walk& walk, const GatherPoint& point, const GatherOptions& options,
                                            std::uint64_t key, LightByDirection* light = nullptr);

}  // namespace pellucid

/// The irradiance cache to look at, pixel by pixel: `records.Y`, how many records lie in a pixel; and of the records that
/// speak at what a pixel sees, averaged by weight:
///   record_radius.Y    how far they speak at most, metres
///   record_gradient.Y  |grad E| / E, per metre
///   record_age.Y       views that have added to the cache since they were made; 0: they are this view's own
///   record_reuse.Y     pixels of this image that they speak to
/// record_reason.Y says why none speaks (0: some do): 1 blocked, 2 distance and normal together, 3 normals differ, 4 behind,
/// 5 too far, 6 there is none, 7 plain gather is cheaper there, 8 the pixel ends at no diffuse surface.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <pellucid/math/image.h>
#include <pellucid/render/plan.h>
#include <pellucid/scene/camera.h>
#include <pellucid/transport/irradiance_cache.h>

namespace pellucid {

struct CacheView {
    const IrradianceCache& cache;
    const Survey& seen;
    const std::vector<std::uint8_t>& plain;  ///< by pixel: left to plain gather; empty: none is
    const Camera& camera;
    std::uint32_t views = 0;     ///< that have added to the cache
    double metresPerUnit = 1.0;  ///< of the scene
};

/// Adds those of the layers that are asked for ("all": every one).
void addCacheLayers(Image& image, const std::vector<std::string>& layers, const CacheView& view,
                    const Workers& workers);

}  // namespace pellucid

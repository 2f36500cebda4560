/// Rotational and translational gradients of the irradiance from the rays of one gather. [WardHeckbert1992]
#pragma once

#include <pellucid/math/frame.h>
#include <pellucid/transport/irradiance_cache.h>

#include "gather_grid.h"

namespace pellucid {

void addRotation(const GatherGrid& g, const Frame& frame, IrradianceRecord& record);

/// Occluders nearer than `nearestKept` (a record never speaks farther than that from them) would give slopes that no record
/// may use.
void addTranslation(const GatherGrid& g, const Frame& frame, float nearestKept, IrradianceRecord& record);

/// The gradient of the mean over the colour channels.
[[nodiscard]] glm::vec3 meanSlope(const IrradianceRecord& record) noexcept;

}  // namespace pellucid

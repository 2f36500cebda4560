/// How far a record may speak: its radius by the metric, and in which azimuths something stands in the way.
#pragma once

#include <pellucid/math/frame.h>
#include <pellucid/transport/final_gather.h>

#include "gather_grid.h"

namespace pellucid {

/// Radius (and, by Hessian, shape) within the options' bounds; the gradient shrinks where a bound has raised the radius.
void setRadius(const GatherGrid& g, const Frame& frame, const GatherOptions& options, IrradianceRecord& record);

/// Marks the azimuths in which the rays met something within the record's reach, low enough to stand between it and a point
/// of its plane.
void setBlocked(const GatherGrid& g, const Frame& frame, float reach, IrradianceRecord& record);

}  // namespace pellucid

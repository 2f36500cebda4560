/// Where photons are of use: within the reach of the kernels of what the camera sees.
#pragma once

#include <vector>

#include <pellucid/transport/visible_cells.h>
#include <pellucid/transport/walk.h>

namespace pellucid {

/// `footprints`, `largest` (scene units): how far kernels may reach from the points.
[[nodiscard]] VisibleCells visibleWithin(const std::vector<GatherPoint>& points, float footprints, float largest);

}  // namespace pellucid

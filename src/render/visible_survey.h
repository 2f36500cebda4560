/// Where photons are of use: within the reach of the kernels of what the camera sees.
#pragma once

#include <pellucid/render/plan.h>

namespace pellucid {

/// `footprints`, `largest` (scene units): how far kernels may reach from the survey's points and from what lies beyond.
[[nodiscard]] VisibleCells visibleWithin(const Survey& seen, float footprints, float largest);

}  // namespace pellucid

/// Where a kernel may leave its surface: told from what the neighbouring pixels see, so that only there somebody has to look.
#pragma once

#include <vector>

#include <pellucid/transport/walk.h>

namespace pellucid {

/// Whether one of the pixels around (x, y), as far as a kernel of `footprints` reaches, sees another surface or none. `points`:
/// of the survey, a row of `width` after the other. What a camera sees of a disc lies within its radius around the middle.
[[nodiscard]] bool nearEdge(const std::vector<GatherPoint>& points, int width, int x, int y, float footprints) noexcept;

}  // namespace pellucid

/// Small windows spread over an image, one in each cell of a grid: a seventh of the pixels stands for all of them.
#pragma once

#include <cstdint>
#include <vector>

#include <pellucid/render/render.h>

namespace pellucid {

/// Empty, which means the whole image, where windows would be too small for a cache's records to spread in.
[[nodiscard]] std::vector<PixelWindow> stratifiedWindows(int width, int height, std::uint64_t key);

}  // namespace pellucid

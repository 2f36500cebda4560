#include "surface_edges.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <pellucid/transport/photon_kernel.h>

namespace pellucid {

namespace {

constexpr std::array<std::array<float, 2>, 8> kAround{{{1, 0},
                                                       {0.7071F, 0.7071F},
                                                       {0, 1},
                                                       {-0.7071F, 0.7071F},
                                                       {-1, 0},
                                                       {-0.7071F, -0.7071F},
                                                       {0, -1},
                                                       {0.7071F, -0.7071F}}};

}  // namespace

bool nearEdge(const std::vector<GatherPoint>& points, int width, int x, int y, float footprints) noexcept {
    if (width <= 0 || points.empty()) return false;
    const int height = static_cast<int>(points.size()) / width;
    const auto at = [&](int px, int py) -> const GatherPoint& {
        return points[static_cast<std::size_t>(py) * static_cast<std::size_t>(width) + static_cast<std::size_t>(px)];
    };
    const GatherPoint& here = at(x, y);
    if (!here.valid) return true;
    const float bound = kMostPlaneDistance * footprints * here.footprint;
    for (const float share : {1.0F, 0.5F})
        for (const auto& way : kAround) {
            const int px = x + static_cast<int>(std::lround(way[0] * share * footprints)),
                      py = y + static_cast<int>(std::lround(way[1] * share * footprints));
            if (px < 0 || py < 0 || px >= width || py >= height) continue;
            const GatherPoint& there = at(px, py);
            if (!there.valid || glm::dot(there.geometricNormal, here.geometricNormal) < kLeastNormalCosine ||
                std::fabs(glm::dot(there.position - here.position, here.geometricNormal)) > bound)
                return true;
        }
    return false;
}

}  // namespace pellucid

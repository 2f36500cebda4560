/// The strata of one hemisphere gather and what their rays found: irradiance, gradients, Hessian and the mask of blocked
/// azimuths are all made from the same rays.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/glm.hpp>

#include <pellucid/math/constants.h>
#include <pellucid/math/rgb.h>
#include <pellucid/transport/gather_guide.h>

namespace pellucid {

struct GatherCell {
    Rgb radiance{0.0F};
    glm::vec3 direction{0.0F};  ///< unit, world
    float distance = 0.0F;      ///< to what was hit; infinite where nothing was
};

/// About as many strata as `rays`, three times as many azimuths as elevations: nearly square ones.
struct GatherGrid : GatherStrata {
    std::vector<GatherCell> cells;

    explicit GatherGrid(int rays) {
        elevations = std::max(3, static_cast<int>(std::lround(std::sqrt(static_cast<double>(rays) / kPiD))));
        azimuths = std::max(7, static_cast<int>(std::lround(kPiD * elevations)));
        cells.resize(count());
    }

    [[nodiscard]] GatherCell& at(int j, int k) noexcept { return cells[index(j, k)]; }
    [[nodiscard]] const GatherCell& at(int j, int k) const noexcept { return cells[index(j, k)]; }
};

}  // namespace pellucid

/// The strata of one hemisphere gather and what their rays found: irradiance, gradients, Hessian and the mask of blocked
/// azimuths are all made from the same rays.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/glm.hpp>

#include <pellucid/math/constants.h>
#include <pellucid/math/rgb.h>

namespace pellucid {

struct GatherCell {
    Rgb radiance{0.0F};
    glm::vec3 direction{0.0F};  ///< unit, world
    float distance = 0.0F;      ///< to what was hit; infinite where nothing was
};

/// `elevations` x `azimuths` strata of equal cosine-weighted solid angle: sin^2 theta = (j + xi) / M.
struct GatherGrid {
    int elevations, azimuths;
    std::vector<GatherCell> cells;

    explicit GatherGrid(int rays)
        : elevations(std::max(3, static_cast<int>(std::lround(std::sqrt(static_cast<double>(rays) / kPiD))))),
          azimuths(std::max(7, static_cast<int>(std::lround(kPiD * elevations)))),
          cells(static_cast<std::size_t>(elevations) * static_cast<std::size_t>(azimuths)) {}

    [[nodiscard]] GatherCell& at(int j, int k) noexcept { return cells[index(j, k)]; }
    [[nodiscard]] const GatherCell& at(int j, int k) const noexcept { return cells[index(j, k)]; }

private:
    [[nodiscard]] std::size_t index(int j, int k) const noexcept {
        return static_cast<std::size_t>(k) * static_cast<std::size_t>(elevations) + static_cast<std::size_t>(j);
    }
};

}  // namespace pellucid

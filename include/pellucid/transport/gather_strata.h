/// The strata of a hemisphere by which a gather sends its rays.
#pragma once

#include <cstddef>

#include <glm/glm.hpp>

namespace pellucid {

/// M x N strata of a hemisphere of equal cosine-weighted solid angle: sin^2 theta = (j + xi) / M, phi = 2 pi (k + xi) / N.
struct GatherStrata {
    int elevations = 0, azimuths = 0;

    [[nodiscard]] std::size_t count() const noexcept {
        return static_cast<std::size_t>(elevations) * static_cast<std::size_t>(azimuths);
    }
    [[nodiscard]] std::size_t index(int j, int k) const noexcept {
        return static_cast<std::size_t>(k) * static_cast<std::size_t>(elevations) + static_cast<std::size_t>(j);
    }
    /// The unit direction of a point `within` the unit square of a stratum, in the coordinates of the frame.
    [[nodiscard]] glm::vec3 direction(int j, int k, const glm::vec2& within) const noexcept;
    /// Its inverse: the stratum of a unit direction over the horizon.
    [[nodiscard]] std::size_t containing(const glm::vec3& local) const noexcept;
};

}  // namespace pellucid

/// What the rays of one gather brought, by direction, so that a record can answer for normals that a normal map has turned.
/// The record itself is of the surface's own normal n; a point with the mapped normal m gets the record's irradiance times
/// E(m) / E(n), both summed over the same directions. Bias enters here: a bin's radiance counts as even over the bin. For even
/// light the ratio is exact, (1 + n.m) / 2, and so it is for m = n.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include <pellucid/math/rgb.h>

namespace pellucid {

struct LightByDirection {
    /// Strata of equal cosine-weighted solid angle around the record's normal, as those of a gather of 128 rays.
    static constexpr int kElevations = 6, kAzimuths = 20;
    std::array<std::uint32_t, static_cast<std::size_t>(kElevations) * kAzimuths> bins{};  ///< packed colours
};

/// `radiance`: of `elevations` x `azimuths` strata of the gather, the elevations of an azimuth next to each other. Its mean stays.
[[nodiscard]] LightByDirection packByDirection(const std::vector<Rgb>& radiance, int elevations, int azimuths,
                                               std::uint64_t coin);

/// False where what was read from somewhere is no light.
[[nodiscard]] bool isSound(const LightByDirection& light) noexcept;

/// The light on a mapped normal, as parts of that on the record's own.
struct TurnedLight {
    Rgb ratio{1.0F};         ///< E(m) / E(n)
    Rgb grazingShare{0.0F};  ///< E5(m) / E(m) (surface/bsdf.h, DiffuseLobe)
};

/// `mapped`: the normal in the frame of the record's.
[[nodiscard]] TurnedLight turnLight(const LightByDirection& light, const glm::vec3& mapped) noexcept;

}  // namespace pellucid

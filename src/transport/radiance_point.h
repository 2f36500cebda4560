/// A point of the global map: how far the surface around it can be seen from it, and the irradiance there, by density estimation
/// among the photons and by samples of the lamps.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <pellucid/math/frame.h>
#include <pellucid/scene/scene.h>
#include <pellucid/surface/bsdf.h>
#include <pellucid/transport/photon.h>
#include <pellucid/transport/radiance_map.h>

#include "photon_tree.h"

namespace pellucid {

constexpr std::size_t kSectors = 8;
/// Normals that differ by more are those of another surface.
constexpr float kMinNormalCosine = 0.8F;

/// How far the surface around a point can be seen from it, by sector of its tangent plane.
struct Reach {
    std::array<float, kSectors> free{};

    /// The octant of a direction in the frame of the normal.
    [[nodiscard]] static std::size_t sector(const Frame& frame, const glm::vec3& offset) noexcept {
        const float x = glm::dot(offset, frame.tangent), y = glm::dot(offset, frame.bitangent);
        return (x < 0.0F ? 4U : 0U) + (y < 0.0F ? 2U : 0U) + (std::fabs(x) > std::fabs(y) ? 1U : 0U);
    }
};

struct RadiancePoint {
    glm::vec3 position{0.0F}, normal{0.0F}, shadingNormal{0.0F};
    DiffuseLobe lobe;
    Rgb irradiance{0.0F}, caustic{0.0F};
    float radius = 0.0F, lookup = 0.0F;  ///< of the estimate and of look-ups
    Reach reach;
    /// Heights over and under the point that are still its surface's: half the way to the next one there.
    float above = 0.0F, below = 0.0F;
};

/// The photons of a global pass that did not come directly, in Morton order.
struct IndirectPhotons {
    PhotonList photons;
    std::vector<std::uint8_t> overSpecular;  ///< by photon: it came L S+ D
};

[[nodiscard]] IndirectPhotons indirectOf(const std::vector<GlobalPhoton>& photons);

/// How far look-ups around `p` may reach: by the distance to its sixth neighbour among `points`.
[[nodiscard]] float lookupRadius(const PointTree<RadiancePoint>& tree, const std::vector<RadiancePoint>& points,
                                 const RadiancePoint& p, float maxRadius);

/// Adds what the photons say to the irradiance of `p`. Returns the rays that it took to see the surface around.
std::uint64_t estimateIndirect(const Scene& scene, const IndirectPhotons& photons, const PointTree<Photon>& tree,
                               RadiancePoint& p, const RadianceMapOptions& options);

/// W m^-2 straight from the lamps, weighted by the lobe. `index` keys the samples.
[[nodiscard]] Rgb directIrradiance(const Scene& scene, const RadiancePoint& p, const RadianceMapOptions& options,
                                   std::size_t index);

/// The largest distance over which a point answers, where photons are looked for as far as `maxRadius`.
[[nodiscard]] float farthestLookup(float maxRadius) noexcept;

}  // namespace pellucid

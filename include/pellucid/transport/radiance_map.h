/// The global photon map as gather rays read it: irradiance precomputed at a subset of the photons' positions
/// [Christensen1999], found by the nearest one. Direct light there is sampled from the lamps (no blur, no loss at edges);
/// all other light is estimated from the photons that the point could reach along the surface, over the area that it could
/// reach: short rays in eight sectors end the kernel at walls, so that light neither leaks through them nor is lost beside
/// them. Bias enters by the kernel of that estimate and by the nearest-point look-up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include <pellucid/base/parallel.h>
#include <pellucid/scene/scene.h>
#include <pellucid/transport/photon.h>

namespace pellucid {

/// How a photon of the global pass came: L D, L S+ D, or any other way.
enum class Arrived : std::uint8_t { Directly, OverSpecular, Otherwise };

/// One photon of the global pass: L (S|G|D)* D.
struct GlobalPhoton {
    Photon photon;
    glm::vec3 shadingNormal{0.0F};
    DiffuseLobe lobe;         ///< of the surface it landed on, for the directional weight
    Arrived arrived = Arrived::Otherwise;
};

struct RadianceMapOptions {
    std::size_t maxPoints = 60'000;
    int neighbours = 24;      ///< photons in the density estimate
    float maxRadius = 0.2F;   ///< scene units
    int lampSamples = 4;      ///< shadow rays a point for its direct light
    std::uint64_t seed = 0;
};

class RadianceMap {
public:
    struct Found {
        Rgb irradiance{0.0F};  ///< W m^-2, weighted by T(wi) of the surface's diffuse lobe
        Rgb caustic{0.0F};     ///< the part of it that came L S+ D
        float radius = 0.0F;   ///< of the density estimate that made it, scene units
    };

    RadianceMap(const Scene& scene, const std::vector<GlobalPhoton>& photons, const RadianceMapOptions& options,
                const Workers& workers);
    ~RadianceMap();

    /// The nearest precomputed point on a surface of this side within its own radius's reach; empty: none near enough.
    [[nodiscard]] std::optional<Found> find(const glm::vec3& position, const glm::vec3& normal) const noexcept;

    [[nodiscard]] std::size_t points() const noexcept;
    [[nodiscard]] std::uint64_t rays() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid

/// The global photon map as gather rays read it: irradiance precomputed at places where gather rays land [Christensen1999 puts
/// them at photons; but then bright clumps have the small Voronoi cells or reach into the dark beside them, a bias of some
/// per cent], found by the nearest one. Direct light there is sampled from the lamps (no blur, no loss at edges); all other
/// light is estimated from the photons that the place could reach along the surface, over the area that it could reach:
/// short rays in eight sectors end the kernel at walls, so that light neither leaks through them nor is lost beside them, and
/// others find where the surface ends, so that small bodies are not darker than they are.
/// Bias enters by the kernel of that estimate.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <pellucid/base/parallel.h>
#include <pellucid/scene/scene.h>
#include <pellucid/transport/photon.h>
#include <pellucid/transport/walk.h>

namespace pellucid {

/// How a photon of the global pass came: L D, L S+ D, or any other way.
enum class Arrived : std::uint8_t { Directly, OverSpecular, Otherwise };

/// One photon of the global pass: L (S|G|D)* D.
struct GlobalPhoton {
    Photon photon;
    Arrived arrived = Arrived::Otherwise;
};

struct RadianceMapOptions {
    int neighbours = 24;     ///< photons in the density estimate
    float maxRadius = 0.2F;  ///< scene units
    int lampSamples = 4;     ///< shadow rays a point for its direct light
    std::uint64_t seed = 0;
};

/// Where gather rays from `points` land, after one D vertex or (a quarter of them) two: `count` tries, by key.
[[nodiscard]] std::vector<GatherPoint> findPlaces(const TransportContext& context,
                                                  const std::vector<GatherPoint>& points, std::size_t count,
                                                  std::uint64_t seed, const Workers& workers);

class RadianceMap {
public:
    struct Found {
        Rgb irradiance{0.0F};  ///< W m^-2, weighted by T(wi) of the surface's diffuse lobe
        Rgb caustic{0.0F};     ///< the part of it that came L S+ D
        float radius = 0.0F;   ///< of the density estimate that made it, scene units
    };

    /// `known`: a map whose places stay as they are among the new ones (null: none).
    RadianceMap(const Scene& scene, const std::vector<GlobalPhoton>& photons, const std::vector<GatherPoint>& places,
                const RadianceMapOptions& options, const Workers& workers, const RadianceMap* known = nullptr);
    ~RadianceMap();

    /// The nearest precomputed point on a surface of this side within its own radius's reach; empty: none near enough.
    [[nodiscard]] std::optional<Found> find(const glm::vec3& position, const glm::vec3& normal) const noexcept;

    /// Whether a place of the map lies no farther away than the radius of its own estimate.
    [[nodiscard]] bool covers(const glm::vec3& position, const glm::vec3& normal) const noexcept;

    /// The map as bytes of this machine, and back: the same look-ups. Null where they are no map.
    [[nodiscard]] std::vector<char> save() const;
    [[nodiscard]] static std::unique_ptr<RadianceMap> restore(const std::vector<char>& bytes);

    [[nodiscard]] std::size_t points() const noexcept;

    /// A place as it stands, for point clouds.
    struct Place {
        glm::vec3 position{0.0F}, normal{0.0F};
        Rgb irradiance{0.0F};
        float radius = 0.0F;
    };
    [[nodiscard]] std::vector<Place> places() const;
    [[nodiscard]] std::uint64_t rays() const noexcept;

private:
    RadianceMap();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid

/// The caustic photon map: L S+ D photons, and the irradiance that they make at a point. Bias enters here: the kernel blurs
/// what is smaller than its radius (zero where the irradiance is linear), and loses light within a radius of an edge.
#pragma once

#include <cstddef>
#include <memory>

#include <pellucid/surface/bsdf.h>
#include <pellucid/transport/photon.h>

namespace pellucid {

/// Flux (luminance) of photons, and its squares: how much, and in how many portions.
struct FluxSums {
    double sum = 0.0, squares = 0.0;
};

class CausticMap {
public:
    explicit CausticMap(PhotonList photons);
    ~CausticMap();
    CausticMap(CausticMap&&) noexcept;

    /// Irradiance (W m^-2) from the photons within `radius`, each weighted by the lobe's transmittance T for its direction:
    /// E = sum dPhi T(wi.n) K(d/r) / (pi r^2), Epanechnikov kernel K = 2 (1 - d^2/r^2). [Jensen1996], [Silverman1986]
    /// `blur` receives an estimate of the kernel's bias, in luminance: the bias grows as r^2, so twice the difference of this
    /// kernel's estimate and that of one with half its area, from the same photons.
    [[nodiscard]] Rgb irradiance(const glm::vec3& point, const glm::vec3& geometricNormal, const glm::vec3& shadingNormal,
                                 const DiffuseLobe& lobe, float radius, float* blur = nullptr) const noexcept;

    /// What arrived within `radius` on the side of the normal.
    [[nodiscard]] FluxSums fluxWithin(const glm::vec3& point, const glm::vec3& geometricNormal, float radius) const noexcept;

    [[nodiscard]] std::size_t size() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid

/// The caustic photon map: L S+ D photons, and the irradiance that they make at a point. Bias enters here: the kernel blurs
/// what is smaller than its radius (zero where the irradiance is linear), and loses light within a radius of an edge.
#pragma once

#include <cstddef>
#include <memory>

#include <pellucid/surface/bsdf.h>
#include <pellucid/transport/photon.h>
#include <pellucid/transport/photon_kernel.h>

namespace pellucid {

/// Flux (luminance) of photons, and its squares: how much, and in how many portions.
struct FluxSums {
    double sum = 0.0, squares = 0.0;
};

/// Multiple importance sampling of one class, E .. D S+ L, by photons in a kernel and by eye paths that go on from D over S
/// lobes and meet the lamp. Along a chain of mirrors and lenses etendue is kept, and both ways choose reflection or refraction
/// alike: so the density of photons at D in a direction is N p, p the density of their emission per etendue, and the eye's
/// 1 / pi. A kernel of radius r takes pi r^2 N p of them [Georgiev2012, eq. 11]; the balance heuristic gives the eye path
/// 1 / (1 + pi^2 r^2 N p). Chains with rough lobes use the same share, which is not the best one there but still a partition.
[[nodiscard]] inline float chanceShare(float radius, float photonsPerEtendue, float etendueDensity) noexcept {
    constexpr float kPiSquared = 9.8696044F;
    return 1.0F / (1.0F + kPiSquared * radius * radius * photonsPerEtendue * etendueDensity);
}

class CausticMap {
public:
    explicit CausticMap(PhotonList photons, PhotonKernel kernel = PhotonKernel::Epanechnikov);
    ~CausticMap();
    CausticMap(CausticMap&&) noexcept;

    /// Irradiance (W m^-2) from the photons within `radius`, each weighted by the lobe's transmittance T for its direction:
    /// E = sum dPhi T(wi.n) K(d/r) / (pi r^2), by default Epanechnikov's kernel K = 2 (1 - d^2/r^2). [Jensen1996], [Silverman1986]
    /// `blur` receives an estimate of the kernel's bias, in luminance: the bias of any of the kernels grows as r^2, so twice the
    /// difference of this kernel's estimate and that of the same shape over half its area, from the same photons.
    /// `photonsPerEtendue` >= 0: each photon has the share that chanceShare() leaves to it. `photons` receives how many there were.
    [[nodiscard]] Rgb irradiance(const glm::vec3& point, const glm::vec3& geometricNormal,
                                 const glm::vec3& shadingNormal, const DiffuseLobe& lobe, float radius,
                                 float* blur = nullptr, float photonsPerEtendue = -1.0F,
                                 int* photons = nullptr) const noexcept;

    /// What arrived within `radius` on the side of the normal.
    [[nodiscard]] FluxSums fluxWithin(const glm::vec3& point, const glm::vec3& geometricNormal,
                                      float radius) const noexcept;

    [[nodiscard]] std::size_t size() const noexcept;
    [[nodiscard]] const PhotonList& photons() const noexcept;

private:
    struct Impl;
    template <class Shape>
    [[nodiscard]] Rgb sum(const glm::vec3& point, const glm::vec3& geometricNormal, const glm::vec3& shadingNormal,
                          const DiffuseLobe& lobe, float radius, float* blur, float photonsPerEtendue,
                          int* photons) const noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid

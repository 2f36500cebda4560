/// A photon map, and the irradiance that its photons make at a point: of the caustics, L S+ D photons; by progressive photon
/// mapping also of all others that did not come directly. Bias enters here: the kernel blurs what is smaller than its radius
/// (zero where the irradiance is linear), and loses light within a radius of an edge.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <pellucid/base/parallel.h>
#include <pellucid/surface/bsdf.h>
#include <pellucid/transport/kernel_tally.h>
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

struct PhotonLookup {
    glm::vec3 point, geometricNormal, shadingNormal;
    const DiffuseLobe& lobe;
    float radius;
    float photonsPerEtendue = -1.0F;  ///< >= 0: each photon has the share that chanceShare() leaves to it
    KernelTally* tally = nullptr;     ///< receives what was met; null: nobody asks
};

struct PhotonEstimate {
    Rgb irradiance{0.0F};  ///< W m^-2
    /// The kernel's bias, in luminance: that of any of the kernels grows as r^2, so twice the difference of this kernel's
    /// estimate and that of the same shape over half its area, from the same photons.
    float blur = 0.0F;
    int photons = 0;
};

class CausticMap {
public:
    /// `workers` build it faster (null: the calling thread alone); its sums do not depend on how many they are.
    explicit CausticMap(PhotonList photons, PhotonKernel kernel = PhotonKernel::Epanechnikov,
                        const Workers* workers = nullptr);
    ~CausticMap();
    CausticMap(CausticMap&&) noexcept;

    /// Irradiance from the photons within the radius, each weighted by the lobe's transmittance T for its direction:
    /// E = sum dPhi T(wi.n) K(d/r) / (pi r^2), by default Epanechnikov's kernel K = 2 (1 - d^2/r^2). [Jensen1996], [Silverman1986]
    [[nodiscard]] PhotonEstimate estimate(const PhotonLookup& at) const noexcept;

    [[nodiscard]] Rgb irradiance(const glm::vec3& point, const glm::vec3& geometricNormal,
                                 const glm::vec3& shadingNormal, const DiffuseLobe& lobe, float radius) const noexcept {
        return estimate({point, geometricNormal, shadingNormal, lobe, radius}).irradiance;
    }

    /// What arrived within `radius` on the side of the normal.
    [[nodiscard]] FluxSums fluxWithin(const glm::vec3& point, const glm::vec3& geometricNormal,
                                      float radius) const noexcept;

    [[nodiscard]] PhotonKernel kernel() const noexcept;
    [[nodiscard]] std::size_t size() const noexcept;

    /// From here on remembers which photons some estimate has summed. Not while another thread looks up.
    void watchUse();
    /// Their places, in the map's order: the same at any number of threads.
    [[nodiscard]] std::vector<glm::vec3> used() const;
    /// As the map keeps them: 20 bytes each.
    [[nodiscard]] PhotonList photons() const;

private:
    struct Impl;
    template <class Shape>
    [[nodiscard]] PhotonEstimate sum(const PhotonLookup& at) const noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid

#include <pellucid/transport/caustic_map.h>

#include <pellucid/math/constants.h>

#include "photon_tree.h"

namespace pellucid {

namespace {

/// A photon belongs to the surface of the query when the normals agree and it lies near the tangent plane.
constexpr float kMinNormalCosine = 0.5F;
constexpr float kMaxPlaneDistance = 0.3F;  ///< of the radius

/// Whether a photon lies on the surface of the query.
[[nodiscard]] bool sameSurface(const Photon& p, const glm::vec3& point, const glm::vec3& normal,
                               float radius2) noexcept {
    if (glm::dot(p.normal, normal) < kMinNormalCosine) return false;
    const float height = glm::dot(p.position - point, normal);
    return height * height <= kMaxPlaneDistance * kMaxPlaneDistance * radius2;
}

/// A result set that is never full, so that every photon within the radius is seen.
struct WithinRadius {
    float radius2;
    void init() noexcept {}
    [[nodiscard]] std::size_t size() const noexcept { return 0; }
    [[nodiscard]] bool full() const noexcept { return true; }
    [[nodiscard]] float worstDist() const noexcept { return radius2; }
};

struct CountFlux : WithinRadius {
    const PhotonList& photons;
    glm::vec3 point, normal;
    FluxSums sums{};

    CountFlux(const PhotonList& list, const glm::vec3& p, const glm::vec3& n, float r2)
        : WithinRadius{r2}, photons(list), point(p), normal(n) {}
    bool addPoint(float distance2, std::uint32_t index) noexcept {
        const Photon& p = photons[index];
        if (distance2 >= radius2 || !sameSurface(p, point, normal, radius2)) return true;
        const auto flux = static_cast<double>(luminance(p.flux));
        sums.sum += flux;
        sums.squares += flux * flux;
        return true;
    }
};

/// Sums the kernel while nanoflann visits. `Shape`: of kernel_shape.
template <class Shape>
struct KernelSum : WithinRadius {
    const PhotonList& photons;
    glm::vec3 point, normal, shadingNormal;
    const DiffuseLobe& lobe;
    glm::dvec3 sum{0.0};
    double inner = 0.0;  ///< luminance by the kernel of half the area
    float radius, photonsPerEtendue;
    int count = 0;

    KernelSum(const PhotonList& list, const glm::vec3& p, const glm::vec3& ng, const glm::vec3& ns,
              const DiffuseLobe& l, float r, float perEtendue)
        : WithinRadius{r * r},
          photons(list),
          point(p),
          normal(ng),
          shadingNormal(ns),
          lobe(l),
          radius(r),
          photonsPerEtendue(perEtendue) {}
    bool addPoint(float distance2, std::uint32_t index) noexcept {
        const Photon& p = photons[index];
        if (distance2 >= radius2 || !sameSurface(p, point, normal, radius2)) return true;
        ++count;
        const float part = distance2 / radius2;
        float through = lobe.b != 0.0F ? lobe.transmittance(std::max(0.0F, glm::dot(p.wi, shadingNormal))) : 1.0F;
        if (photonsPerEtendue >= 0.0F) through *= 1.0F - chanceShare(radius, photonsPerEtendue, p.etendueDensity);
        sum += glm::dvec3(p.flux * (Shape::shape(part) * through));
        if (part < 0.5F) inner += static_cast<double>(luminance(p.flux) * (2.0F * Shape::shape(2.0F * part) * through));
        return true;
    }
};

}  // namespace

struct CausticMap::Impl {
    PhotonList photons;
    PhotonKernel kernel;
    std::vector<PointSite> sites;  ///< what the tree's search touches: positions only
    PointTree<PointSite> tree;
    Impl(PhotonList list, PhotonKernel k)
        : photons(std::move(list)), kernel(k), sites(photons.begin(), photons.end()), tree(sites) {}
};

CausticMap::CausticMap(PhotonList photons, PhotonKernel kernel) {
    sortAlongMortonCurve(photons);
    impl_ = std::make_unique<Impl>(std::move(photons), kernel);
}
CausticMap::~CausticMap() = default;
CausticMap::CausticMap(CausticMap&&) noexcept = default;

template <class Shape>
Rgb CausticMap::sum(const glm::vec3& point, const glm::vec3& geometricNormal, const glm::vec3& shadingNormal,
                    const DiffuseLobe& lobe, float radius, float* blur, float photonsPerEtendue,
                    int* photons) const noexcept {
    KernelSum<Shape> result(impl_->photons, point, geometricNormal, shadingNormal, lobe, radius, photonsPerEtendue);
    impl_->tree.search(point, result);
    const double perArea =
        static_cast<double>(Shape::kScale) / (kPiD * static_cast<double>(radius) * static_cast<double>(radius));
    const Rgb irradiance(result.sum * perArea);
    if (blur != nullptr) *blur = 2.0F * (luminance(irradiance) - static_cast<float>(result.inner * perArea));
    if (photons != nullptr) *photons = result.count;
    return irradiance;
}

Rgb CausticMap::irradiance(const glm::vec3& point, const glm::vec3& geometricNormal, const glm::vec3& shadingNormal,
                           const DiffuseLobe& lobe, float radius, float* blur, float photonsPerEtendue,
                           int* photons) const noexcept {
    using namespace kernel_shape;
    switch (impl_->kernel) {
        case PhotonKernel::Uniform:
            return sum<Uniform>(point, geometricNormal, shadingNormal, lobe, radius, blur, photonsPerEtendue, photons);
        case PhotonKernel::Cone:
            return sum<Cone>(point, geometricNormal, shadingNormal, lobe, radius, blur, photonsPerEtendue, photons);
        case PhotonKernel::Biweight:
            return sum<Biweight>(point, geometricNormal, shadingNormal, lobe, radius, blur, photonsPerEtendue, photons);
        case PhotonKernel::Epanechnikov:
            break;
    }
    return sum<Epanechnikov>(point, geometricNormal, shadingNormal, lobe, radius, blur, photonsPerEtendue, photons);
}

FluxSums CausticMap::fluxWithin(const glm::vec3& point, const glm::vec3& geometricNormal, float radius) const noexcept {
    CountFlux result(impl_->photons, point, geometricNormal, radius * radius);
    impl_->tree.search(point, result);
    return result.sums;
}

std::size_t CausticMap::size() const noexcept { return impl_->photons.size(); }
const PhotonList& CausticMap::photons() const noexcept { return impl_->photons; }

}  // namespace pellucid

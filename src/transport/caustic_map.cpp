#include <pellucid/transport/caustic_map.h>

#include <atomic>

#include <pellucid/math/constants.h>
#include <pellucid/math/frame.h>

#include "packed_photon.h"
#include "photon_tree.h"

namespace pellucid {

namespace {

/// Photons in the order of the tree's leaves: positions in the tree, the rest beside it.
struct Photons {
    PointTree<Photon> tree;
    std::vector<PackedPhoton> packed;
    std::vector<float> etendueDensity;  ///< empty: all alike
    float common = 0.0F;                ///< then

    Photons(const PhotonList& list, const Workers* workers) : tree(list, workers) {
        packed.reserve(list.size());
        bool alike = true;
        for (const std::uint32_t i : tree.order()) {
            const Photon& p = list[i];
            packed.push_back({PackedFlux(p.flux, i), OctahedralVector(p.wi), OctahedralVector(p.normal)});
            alike = alike && p.etendueDensity == list.front().etendueDensity;
        }
        if (alike && !list.empty()) common = list.front().etendueDensity;
        if (!alike)
            for (const std::uint32_t i : tree.order()) etendueDensity.push_back(list[i].etendueDensity);
        tree.tellPlaces();
    }

    [[nodiscard]] float density(std::uint32_t i) const noexcept {
        return etendueDensity.empty() ? common : etendueDensity[i];
    }
    [[nodiscard]] Photon operator[](std::size_t i) const {
        return {tree.position(i), packed[i].wi.unit(), packed[i].normal.unit(), packed[i].flux.value(),
                density(static_cast<std::uint32_t>(i))};
    }
};

/// Whether a photon lies on the surface of the query.
[[nodiscard]] bool sameSurface(const glm::vec3& offset, const OctahedralVector& photonNormal, const glm::vec3& normal,
                               float radius2) noexcept {
    const glm::vec3 n = photonNormal.direction();
    const float along = glm::dot(n, normal);
    if (along <= 0.0F || along * along < kLeastNormalCosine * kLeastNormalCosine * glm::dot(n, n)) return false;
    const float height = glm::dot(offset, normal);
    return height * height <= kMostPlaneDistance * kMostPlaneDistance * radius2;
}

/// A result set that is never full, so that every photon within the radius is seen.
struct WithinRadius {
    float radius2;
    void init() noexcept {}
    [[nodiscard]] std::size_t size() const noexcept { return 0; }
    [[nodiscard]] bool full() const noexcept { return true; }
    [[nodiscard]] float worstDist() const noexcept { return radius2; }
};

/// Which photons have been summed: a flag that is only ever set, so that the order of threads does not show.
class Marks {
public:
    explicit Marks(std::size_t count) : flags_(count) {}
    void mark(std::size_t i) noexcept {
        if (!flags_[i].load(std::memory_order_relaxed)) flags_[i].store(true, std::memory_order_relaxed);
    }
    [[nodiscard]] bool operator[](std::size_t i) const noexcept { return flags_[i].load(std::memory_order_relaxed); }

private:
    std::vector<std::atomic<bool>> flags_;
};

struct CountFlux : WithinRadius {
    const Photons& photons;
    glm::vec3 point, normal;
    FluxSums sums{};

    CountFlux(const Photons& list, const glm::vec3& p, const glm::vec3& n, float r2)
        : WithinRadius{r2}, photons(list), point(p), normal(n) {}
    bool addPoint(float distance2, std::uint32_t index) noexcept {
        const PackedPhoton& p = photons.packed[index];
        if (distance2 >= radius2 || !sameSurface(photons.tree.position(index) - point, p.normal, normal, radius2))
            return true;
        const auto flux = static_cast<double>(luminance(p.flux.value()));
        sums.sum += flux;
        sums.squares += flux * flux;
        return true;
    }
};

/// Sums the kernel while nanoflann visits. `Shape`: of kernel_shape.
template <class Shape>
struct KernelSum : WithinRadius {
    const Photons& photons;
    const PhotonLookup& at;
    Marks* used;  ///< null: nobody asks
    Frame frame;  ///< for the tally
    glm::dvec3 sum{0.0};
    double inner = 0.0;  ///< luminance by the kernel of half the area
    int count = 0;

    KernelSum(const Photons& list, const PhotonLookup& lookup, Marks* marks)
        : WithinRadius{lookup.radius * lookup.radius}, photons(list), at(lookup), used(marks) {
        if (at.tally != nullptr) frame = Frame(at.geometricNormal);
    }
    bool addPoint(float distance2, std::uint32_t index) noexcept {
        const PackedPhoton& p = photons.packed[index];
        const glm::vec3 offset = photons.tree.position(index) - at.point;
        if (distance2 >= radius2 || !sameSurface(offset, p.normal, at.geometricNormal, radius2)) return true;
        ++count;
        const float part = distance2 / radius2;
        const DiffuseLobe& lobe = at.lobe;
        const Rgb flux = p.flux.value();
        float through =
            lobe.b != 0.0F ? lobe.transmittance(std::max(0.0F, glm::dot(p.wi.unit(), at.shadingNormal))) : 1.0F;
        if (at.photonsPerEtendue >= 0.0F)
            through *= 1.0F - chanceShare(at.radius, at.photonsPerEtendue, photons.density(index));
        sum += glm::dvec3(flux * (Shape::shape(part) * through));
        if (part < 0.5F) inner += static_cast<double>(luminance(flux) * (2.0F * Shape::shape(2.0F * part) * through));
        if (at.tally != nullptr) at.tally->add(frame, offset, part, luminance(flux));
        if (used != nullptr) used->mark(index);
        return true;
    }
};

}  // namespace

struct CausticMap::Impl {
    Photons photons;
    PhotonKernel kernel;
    std::unique_ptr<Marks> used;
    Impl(const PhotonList& list, PhotonKernel k, const Workers* workers) : photons(list, workers), kernel(k) {}
};

CausticMap::CausticMap(PhotonList photons, PhotonKernel kernel, const Workers* workers) {
    sortAlongMortonCurve(photons);
    impl_ = std::make_unique<Impl>(photons, kernel, workers);
}
CausticMap::~CausticMap() = default;
CausticMap::CausticMap(CausticMap&&) noexcept = default;

template <class Shape>
PhotonEstimate CausticMap::sum(const PhotonLookup& at) const noexcept {
    KernelSum<Shape> result(impl_->photons, at, impl_->used.get());
    impl_->photons.tree.search(at.point, result);
    const double perArea =
        static_cast<double>(Shape::kScale) / (kPiD * static_cast<double>(at.radius) * static_cast<double>(at.radius));
    const Rgb irradiance(result.sum * perArea);
    return {irradiance, 2.0F * (luminance(irradiance) - static_cast<float>(result.inner * perArea)), result.count};
}

PhotonEstimate CausticMap::estimate(const PhotonLookup& at) const noexcept {
    return withShape(impl_->kernel, [&](auto shape) { return sum<decltype(shape)>(at); });
}

FluxSums CausticMap::fluxWithin(const glm::vec3& point, const glm::vec3& geometricNormal, float radius) const noexcept {
    CountFlux result(impl_->photons, point, geometricNormal, radius * radius);
    impl_->photons.tree.search(point, result);
    return result.sums;
}

void CausticMap::watchUse() { impl_->used = std::make_unique<Marks>(size()); }

std::vector<glm::vec3> CausticMap::used() const {
    std::vector<glm::vec3> places;
    for (std::size_t i = 0; impl_->used && i < size(); ++i)
        if ((*impl_->used)[i]) places.push_back(impl_->photons.tree.position(i));
    return places;
}

PhotonKernel CausticMap::kernel() const noexcept { return impl_->kernel; }
std::size_t CausticMap::size() const noexcept { return impl_->photons.packed.size(); }

PhotonList CausticMap::photons() const {
    PhotonList list;
    for (std::size_t i = 0; i < size(); ++i) list.push_back(impl_->photons[i]);
    return list;
}

}  // namespace pellucid

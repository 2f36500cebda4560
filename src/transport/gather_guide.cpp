#include <pellucid/transport/gather_guide.h>

#include <algorithm>

#include "packed_photon.h"
#include "photon_tree.h"
#include "radiance_point.h"

namespace pellucid {

namespace {

constexpr int kNearest = 128;
/// Fewer photons tell nothing.
constexpr int kFewest = 16;
/// A stratum gets more rays if so many more photons came through it than would on average.
constexpr float kMoreThanChance = 1.0F;

/// What is asked of a photon.
struct Comer {
    glm::vec3 position;
    OctahedralVector wi, normal;
    float flux;  ///< luminance
};

[[nodiscard]] std::vector<Comer> otherPhotons(const std::vector<GlobalPhoton>& photons) {
    std::vector<Comer> list;
    for (const GlobalPhoton& p : photons)
        if (p.arrived == Arrived::Otherwise)
            list.push_back({p.photon.position, OctahedralVector(p.photon.wi), OctahedralVector(p.photon.normal),
                            luminance(p.photon.flux)});
    sortAlongMortonCurve(list);
    return list;
}

struct NearestOnSide : NearestHeap<kNearest> {
    const std::vector<Comer>& photons;
    glm::vec3 normal;

    NearestOnSide(const std::vector<Comer>& list, const glm::vec3& side, float bound2)
        : NearestHeap{kNearest, bound2}, photons(list), normal(side) {}
    bool addPoint(float distance2, std::uint32_t index) noexcept {
        if (distance2 < radius2 && glm::dot(photons[index].normal.unit(), normal) >= kMinNormalCosine)
            keep(distance2, index);
        return true;
    }
};

}  // namespace

struct GatherGuide::Impl {
    std::vector<Comer> photons;
    PointTree<Comer> tree;
    float farthest;

    Impl(const std::vector<GlobalPhoton>& list, float bound, const Workers& workers)
        : photons(otherPhotons(list)), tree(photons, &workers), farthest(bound) {}
};

GatherGuide::GatherGuide(const std::vector<GlobalPhoton>& photons, float farthest, const Workers& workers)
    : impl_(std::make_unique<Impl>(photons, farthest, workers)) {}
GatherGuide::~GatherGuide() = default;

std::vector<std::uint8_t> GatherGuide::rays(const glm::vec3& position, const Frame& frame,
                                            const GatherStrata& strata) const {
    std::vector<std::uint8_t> counts(strata.count(), 1);
    NearestOnSide near(impl_->photons, frame.normal, impl_->farthest * impl_->farthest);
    impl_->tree.search(position, near);
    if (near.found < kFewest) return counts;
    std::vector<float> flux(strata.count(), 0.0F);
    float all = 0.0F;
    for (int i = 0; i < near.found; ++i) {
        const Comer& photon = impl_->photons[near.heap[static_cast<std::size_t>(i)].second];
        const glm::vec3 local = frame.toLocal(photon.wi.unit());
        if (local.z <= 0.0F) continue;
        flux[strata.containing(local)] += photon.flux;
        all += photon.flux;
    }
    if (!(all > 0.0F)) return counts;
    const auto n = static_cast<float>(strata.count());
    const float bright = 1.0F / n + kMoreThanChance / static_cast<float>(near.found);
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const float share = flux[i] / all;
        if (share > bright)
            counts[i] = static_cast<std::uint8_t>(std::clamp(share * n, 1.0F, static_cast<float>(kMostRays)));
    }
    return counts;
}

}  // namespace pellucid

#include <pellucid/transport/radiance_map.h>

#include <algorithm>
#include <array>
#include <atomic>

#include <pellucid/math/constants.h>
#include <pellucid/math/sampler.h>
#include <pellucid/transport/walk.h>

#include "photon_tree.h"

namespace pellucid {

namespace {

constexpr float kMinNormalCosine = 0.8F;
constexpr float kMaxPlaneDistance = 0.2F;  ///< of the distance searched
constexpr int kMaxNeighbours = 64;
/// A look-up reaches this many estimate radii: beyond, the nearest point says nothing about the place.
constexpr float kReach = 1.5F;

struct RadiancePoint {
    glm::vec3 position{0.0F}, normal{0.0F}, shadingNormal{0.0F};
    DiffuseLobe lobe;
    Rgb irradiance{0.0F};
    float radius = 0.0F;
};

/// The k nearest photons that arrived indirectly on the same side, within a bound: a max-heap of (distance^2, index).
struct NearestPhotons {
    const PhotonList& photons;
    glm::vec3 point, normal;
    int wanted;
    float radius2;
    int found = 0;
    std::array<std::pair<float, std::uint32_t>, kMaxNeighbours> heap{};

    void init() noexcept {}
    [[nodiscard]] std::size_t size() const noexcept { return static_cast<std::size_t>(found); }
    [[nodiscard]] bool full() const noexcept { return true; }
    [[nodiscard]] float worstDist() const noexcept { return radius2; }
    bool addPoint(float distance2, std::uint32_t index) noexcept {
        if (distance2 >= radius2) return true;
        const Photon& p = photons[index];
        if (glm::dot(p.normal, normal) < kMinNormalCosine) return true;
        const float height = glm::dot(p.position - point, normal);
        if (height * height > kMaxPlaneDistance * kMaxPlaneDistance * std::max(distance2, 1e-8F)) return true;
        const auto begin = heap.begin();
        if (found == wanted) {
            std::pop_heap(begin, begin + found);
            --found;
        }
        heap[static_cast<std::size_t>(found++)] = {distance2, index};
        std::push_heap(begin, begin + found);
        if (found == wanted) radius2 = heap[0].first;
        return true;
    }
};

/// The nearest radiance point on the same side.
struct NearestPoint {
    const std::vector<RadiancePoint>& points;
    glm::vec3 point, normal;
    float radius2;
    std::uint32_t best = 0xffffffffU;

    void init() noexcept {}
    [[nodiscard]] std::size_t size() const noexcept { return best == 0xffffffffU ? 0 : 1; }
    [[nodiscard]] bool full() const noexcept { return true; }
    [[nodiscard]] float worstDist() const noexcept { return radius2; }
    bool addPoint(float distance2, std::uint32_t index) noexcept {
        const RadiancePoint& p = points[index];
        if (distance2 > radius2 || (distance2 == radius2 && index >= best)) return true;
        if (glm::dot(p.normal, normal) < kMinNormalCosine) return true;
        const float height = glm::dot(p.position - point, normal);
        if (height * height > 0.04F * p.radius * p.radius || distance2 > kReach * kReach * p.radius * p.radius) return true;
        radius2 = distance2;
        best = index;
        return true;
    }
};

[[nodiscard]] Rgb directIrradiance(const Scene& scene, const RadiancePoint& p, int samples, std::uint64_t seed, std::size_t index) {
    Rgb sum(0.0F);
    for (int s = 0; s < samples; ++s) {
        Sampler sampler(seed, index, static_cast<std::uint32_t>(s));
        const float choice = sampler.next1D();
        const auto light = scene.lights().sample(p.position, p.normal, choice, sampler.next2D());
        if (!light || !(light->pdfSolidAngle > 0.0F)) continue;
        const float cosine = glm::dot(light->wi, p.shadingNormal);
        if (cosine <= 0.0F || glm::dot(light->wi, p.normal) <= 0.0F) continue;
        const Ray shadow = shadowRay(p.position, p.normal, light->wi, light->distance);
        const float visible = shadow.tMax > 0.0F ? scene.visibility(shadow) : 1.0F;
        if (visible > 0.0F) sum += light->radiance * (visible * cosine * p.lobe.transmittance(cosine) / light->pdfSolidAngle);
    }
    return sum / static_cast<float>(samples);
}

/// k-nearest density estimate with the (k-1) form, which is unbiased in a flat field; with fewer than k photons inside the
/// largest radius, all of them over its area.
[[nodiscard]] Rgb indirectIrradiance(const PhotonList& photons, const PointTree<Photon>& tree, RadiancePoint& p, int neighbours, float maxRadius) {
    NearestPhotons nearest{photons, p.position, p.normal, std::min(neighbours, kMaxNeighbours), maxRadius * maxRadius};
    tree.search(p.position, nearest);
    const bool bounded = nearest.found < nearest.wanted;
    const float area = kPi * (bounded ? maxRadius * maxRadius : nearest.radius2);
    p.radius = bounded ? maxRadius : std::sqrt(nearest.radius2);
    if (!(area > 0.0F)) return Rgb(0.0F);
    Rgb sum(0.0F);
    for (int i = bounded ? 0 : 1; i < nearest.found; ++i) {  // heap[0] is the farthest: the k-th, left out
        const Photon& photon = photons[nearest.heap[static_cast<std::size_t>(i)].second];
        const float t = p.lobe.b != 0.0F ? p.lobe.transmittance(std::max(0.0F, glm::dot(photon.wi, p.shadingNormal))) : p.lobe.a;
        sum += photon.flux * t;
    }
    return sum / area;
}

}  // namespace

struct RadianceMap::Impl {
    std::vector<RadiancePoint> points;
    std::unique_ptr<PointTree<RadiancePoint>> tree;
    std::uint64_t rays = 0;
    float reach = 0.0F;
};

RadianceMap::RadianceMap(const Scene& scene, const std::vector<GlobalPhoton>& photons, const RadianceMapOptions& options,
                         const Workers& workers)
    : impl_(std::make_unique<Impl>()) {
    PhotonList indirect;
    indirect.reserve(photons.size());
    for (const GlobalPhoton& g : photons)
        if (!g.direct) indirect.push_back(g.photon);
    impl_->reach = kReach * options.maxRadius;
    sortAlongMortonCurve(indirect);
    const PointTree<Photon> tree(indirect);
    const std::size_t stride = std::max<std::size_t>(1, (photons.size() + options.maxPoints - 1) / std::max<std::size_t>(1, options.maxPoints));
    for (std::size_t i = 0; i < photons.size(); i += stride)
        impl_->points.push_back({photons[i].photon.position, photons[i].photon.normal, photons[i].shadingNormal, photons[i].lobe, Rgb(0.0F), 0.0F});
    sortAlongMortonCurve(impl_->points);
    workers.forEach(impl_->points.size(), 256, [&](std::size_t i) {
        RadiancePoint& p = impl_->points[i];
        p.irradiance = indirectIrradiance(indirect, tree, p, options.neighbours, options.maxRadius);
        p.irradiance += directIrradiance(scene, p, options.lampSamples, options.seed, i);
    });
    impl_->rays = impl_->points.size() * static_cast<std::uint64_t>(options.lampSamples);
    impl_->tree = std::make_unique<PointTree<RadiancePoint>>(impl_->points);
}

RadianceMap::~RadianceMap() = default;

std::optional<RadianceMap::Found> RadianceMap::find(const glm::vec3& position, const glm::vec3& normal) const noexcept {
    NearestPoint nearest{impl_->points, position, normal, impl_->reach * impl_->reach};
    impl_->tree->search(position, nearest);
    if (nearest.best == 0xffffffffU) return std::nullopt;
    const RadiancePoint& p = impl_->points[nearest.best];
    return Found{p.irradiance, p.radius};
}

std::size_t RadianceMap::points() const noexcept { return impl_->points.size(); }
std::uint64_t RadianceMap::rays() const noexcept { return impl_->rays; }

}  // namespace pellucid

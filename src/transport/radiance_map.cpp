#include <pellucid/transport/radiance_map.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <pellucid/math/constants.h>
#include <pellucid/math/frame.h>
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
/// Points stand where photons arrived, but never where one stands that their density counts: a photon that did both would
/// see the clumps of its like, and the clumps have the small Voronoi cells: 2 % too dark per bounce. So every fourth indirect
/// photon only gives its place (as direct ones do), and the flux of the others is scaled up.
constexpr std::uint32_t kSharePlaces = 4;
constexpr float kDensityScale = static_cast<float>(kSharePlaces) / static_cast<float>(kSharePlaces - 1);
constexpr std::uint32_t kNobody = 0xffffffffU;
constexpr std::size_t kSectors = 8;
/// Height of the sectors' rays over the surface, as a share of the kernel's radius.
constexpr float kSectorHeight = 0.05F;

/// How far the surface around a point can be seen from it, by sector of its tangent plane.
struct Reach {
    std::array<float, kSectors> free{};

    /// The octant of a direction in the frame of the normal.
    [[nodiscard]] static std::size_t sector(const Frame& frame, const glm::vec3& offset) noexcept {
        const float x = glm::dot(offset, frame.tangent), y = glm::dot(offset, frame.bitangent);
        return (x < 0.0F ? 4U : 0U) + (y < 0.0F ? 2U : 0U) + (std::fabs(x) > std::fabs(y) ? 1U : 0U);
    }
};

/// What a look-up visits: small, so that few cache lines are touched.
struct RadianceSite {
    glm::vec3 position{0.0F}, normal{0.0F};
    float radius = 0.0F;       ///< of the density estimate
    float freeRadius = 0.0F;   ///< reachable all around; farther away the point's sectors decide
};

struct RadiancePoint {
    glm::vec3 position{0.0F}, normal{0.0F}, shadingNormal{0.0F};
    DiffuseLobe lobe;
    Rgb irradiance{0.0F}, caustic{0.0F};
    float radius = 0.0F;
    Reach reach;
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

/// The nearest radiance point on the same side that can see the place.
struct NearestSite {
    const std::vector<RadianceSite>& sites;
    const std::vector<RadiancePoint>& points;
    glm::vec3 point, normal;
    float radius2;
    std::uint32_t best = kNobody;

    void init() noexcept {}
    [[nodiscard]] std::size_t size() const noexcept { return best == kNobody ? 0 : 1; }
    [[nodiscard]] bool full() const noexcept { return true; }
    [[nodiscard]] float worstDist() const noexcept { return radius2; }
    bool addPoint(float distance2, std::uint32_t index) noexcept {
        const RadianceSite& s = sites[index];
        if (distance2 > radius2 || (distance2 == radius2 && index >= best)) return true;
        if (glm::dot(s.normal, normal) < kMinNormalCosine) return true;
        const glm::vec3 offset = point - s.position;
        const float height = glm::dot(offset, normal);
        if (height * height > 0.04F * s.radius * s.radius || distance2 > kReach * kReach * s.radius * s.radius) return true;
        if (distance2 > s.freeRadius * s.freeRadius) {
            const float free = points[index].reach.free[Reach::sector(Frame(s.normal), offset)];
            if (free < s.radius && distance2 > free * free) return true;
        }
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

/// Short rays along the surface, up to the kernel's radius: two a sector. A sector is as free as the shortest of the rays at
/// its borders and in its middle, so that hardly any of its area lies behind a wall.
void measureReach(const Scene& scene, RadiancePoint& p) noexcept {
    const Frame frame(p.normal);
    const glm::vec3 origin = offsetOrigin(p.position + p.normal * (kSectorHeight * p.radius), p.normal);
    constexpr std::size_t kRays = 2 * kSectors;
    std::array<glm::vec3, kRays> direction{};
    std::array<float, kRays> distance{};
    for (std::size_t i = 0; i < kRays; ++i) {
        const float phi = kTwoPi * static_cast<float>(i) / static_cast<float>(kRays);
        direction[i] = frame.tangent * std::cos(phi) + frame.bitangent * std::sin(phi);
        const auto hit = scene.intersect(Ray{origin, direction[i], p.radius}, 0.0F);
        distance[i] = hit ? hit->distance : p.radius;
    }
    for (std::size_t middle = 1; middle < kRays; middle += 2)
        p.reach.free[Reach::sector(frame, direction[middle])] = std::min({distance[middle - 1], distance[middle], distance[(middle + 1) % kRays]});
}

/// k-nearest density estimate with the (k-1) form, which is unbiased in a flat field, over the sectors' free areas; with fewer
/// than k photons inside the largest radius, all of them.
void estimateIndirect(const Scene& scene, const PhotonList& photons, const std::vector<std::uint8_t>& overSpecular,
                      const PointTree<Photon>& tree, RadiancePoint& p, int neighbours, float maxRadius) {
    NearestPhotons nearest{photons, p.position, p.normal, std::min(neighbours, kMaxNeighbours), maxRadius * maxRadius};
    tree.search(p.position, nearest);
    const bool bounded = nearest.found < nearest.wanted;
    p.radius = bounded ? maxRadius : std::sqrt(nearest.radius2);
    measureReach(scene, p);
    float area = 0.0F;
    for (const float free : p.reach.free) area += kPi / static_cast<float>(kSectors) * free * free;
    if (!(area > 0.0F)) return;
    const Frame frame(p.normal);
    for (int i = bounded ? 0 : 1; i < nearest.found; ++i) {  // heap[0] is the farthest: the k-th, left out
        const auto& [distance2, index] = nearest.heap[static_cast<std::size_t>(i)];
        const Photon& photon = photons[index];
        const float free = p.reach.free[Reach::sector(frame, photon.position - p.position)];
        if (distance2 > free * free) continue;
        const float t = p.lobe.b != 0.0F ? p.lobe.transmittance(std::max(0.0F, glm::dot(photon.wi, p.shadingNormal))) : p.lobe.a;
        p.irradiance += photon.flux * (t / area);
        if (overSpecular[index] != 0) p.caustic += photon.flux * (t / area);
    }
}

}  // namespace

struct RadianceMap::Impl {
    std::vector<RadiancePoint> points;
    std::vector<RadianceSite> sites;
    std::unique_ptr<PointTree<RadianceSite>> tree;
    std::uint64_t rays = 0;
    float reach = 0.0F;
};

RadianceMap::RadianceMap(const Scene& scene, const std::vector<GlobalPhoton>& photons, const RadianceMapOptions& options,
                         const Workers& workers)
    : impl_(std::make_unique<Impl>()) {
    struct Indirect {
        glm::vec3 position;
        std::uint32_t photon;
    };
    std::vector<Indirect> order;
    std::vector<std::uint32_t> places;
    for (std::uint32_t i = 0; i < photons.size(); ++i) {
        if (photons[i].arrived == Arrived::Directly || i % kSharePlaces == 0) places.push_back(i);
        else order.push_back({photons[i].photon.position, i});
    }
    sortAlongMortonCurve(order);
    PhotonList indirect;
    std::vector<std::uint8_t> overSpecular;
    indirect.reserve(order.size());
    for (const Indirect& o : order) {
        indirect.push_back(photons[o.photon].photon);
        indirect.back().flux *= kDensityScale;
        overSpecular.push_back(photons[o.photon].arrived == Arrived::OverSpecular ? 1 : 0);
    }
    impl_->reach = kReach * options.maxRadius;
    const PointTree<Photon> tree(indirect);
    std::vector<RadiancePoint>& points = impl_->points;
    const std::size_t stride = std::max<std::size_t>(1, (places.size() + options.maxPoints - 1) / std::max<std::size_t>(1, options.maxPoints));
    for (std::size_t i = 0; i < places.size(); i += stride) {
        const GlobalPhoton& g = photons[places[i]];
        RadiancePoint p;
        p.position = g.photon.position;
        p.normal = g.photon.normal;
        p.shadingNormal = g.shadingNormal;
        p.lobe = g.lobe;
        points.push_back(p);
    }
    sortAlongMortonCurve(points);
    impl_->sites.resize(points.size());
    workers.forEach(points.size(), 256, [&](std::size_t i) {
        RadiancePoint& p = points[i];
        estimateIndirect(scene, indirect, overSpecular, tree, p, options.neighbours, options.maxRadius);
        p.irradiance += directIrradiance(scene, p, options.lampSamples, options.seed, i);
        impl_->sites[i] = {p.position, p.normal, p.radius, *std::min_element(p.reach.free.begin(), p.reach.free.end())};
    });
    impl_->rays = points.size() * (static_cast<std::uint64_t>(options.lampSamples) + 2 * kSectors);
    impl_->tree = std::make_unique<PointTree<RadianceSite>>(impl_->sites);
}

RadianceMap::~RadianceMap() = default;

std::optional<RadianceMap::Found> RadianceMap::find(const glm::vec3& position, const glm::vec3& normal) const noexcept {
    NearestSite nearest{impl_->sites, impl_->points, position, normal, impl_->reach * impl_->reach};
    impl_->tree->search(position, nearest);
    if (nearest.best == kNobody) return std::nullopt;
    const RadiancePoint& p = impl_->points[nearest.best];
    return Found{p.irradiance, p.caustic, p.radius};
}

std::size_t RadianceMap::points() const noexcept { return impl_->points.size(); }
std::uint64_t RadianceMap::rays() const noexcept { return impl_->rays; }

}  // namespace pellucid

#include <pellucid/transport/radiance_map.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <type_traits>

#include "photon_tree.h"
#include "radiance_point.h"

namespace pellucid {

namespace {

constexpr std::uint32_t kNobody = 0xffffffffU;
/// No place of a map that was read from somewhere is as far from the centre: the scene's radius is about 1.
constexpr float kFarthest = 1e6F;

/// What a look-up visits: small, so that few cache lines are touched.
struct RadianceSite {
    glm::vec3 position{0.0F}, normal{0.0F};
    float radius = 0.0F;               ///< of the density estimate
    float reach = 0.0F;                ///< of look-ups
    float freeRadius = 0.0F;           ///< reachable all around; farther away the point's sectors decide
    float above = 0.0F, below = 0.0F;  ///< heights of look-ups that are on this surface
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
        if (height > s.above || height < -s.below) return true;
        if (height * height > 0.04F * s.radius * s.radius || distance2 > s.reach * s.reach) return true;
        if (distance2 > s.freeRadius * s.freeRadius) {
            const float free = points[index].reach.free[Reach::sector(Frame(s.normal), offset)];
            if (distance2 > free * free) return true;
        }
        radius2 = distance2;
        best = index;
        return true;
    }
};

}  // namespace

struct RadianceMap::Impl {
    std::vector<RadiancePoint> points;
    std::vector<RadianceSite> sites;
    std::unique_ptr<PointTree<RadianceSite>> tree;
    std::uint64_t rays = 0;
    float reach = 0.0F;

    /// Makes ready for look-ups as far as `farthest`.
    void index(float farthest) {
        reach = farthest;
        sites.clear();
        for (const RadiancePoint& p : points)
            sites.push_back({p.position, p.normal, p.radius, p.lookup,
                             *std::min_element(p.reach.free.begin(), p.reach.free.end()), p.above, p.below});
        tree = std::make_unique<PointTree<RadianceSite>>(sites);
    }

    [[nodiscard]] std::uint32_t nearest(const glm::vec3& position, const glm::vec3& normal) const noexcept {
        NearestSite search{sites, points, position, normal, reach * reach};
        tree->search(position, search);
        return search.best;
    }
};

RadianceMap::RadianceMap() : impl_(std::make_unique<Impl>()) {}

RadianceMap::RadianceMap(const Scene& scene, const std::vector<GlobalPhoton>& photons,
                         const std::vector<GatherPoint>& places, const RadianceMapOptions& options,
                         const Workers& workers, const RadianceMap* known)
    : RadianceMap() {
    const IndirectPhotons indirect = indirectOf(photons);
    const PointTree<Photon> tree(indirect.photons);
    std::vector<RadiancePoint>& points = impl_->points;
    for (const GatherPoint& place : places) {
        RadiancePoint p;
        p.position = place.position;
        p.normal = place.geometricNormal;
        p.shadingNormal = place.normal;
        p.lobe = place.lobe;
        points.push_back(p);
    }
    sortAlongMortonCurve(points);
    const std::size_t fresh = points.size(), before = known != nullptr ? known->impl_->points.size() : 0;
    if (known != nullptr) points.insert(points.end(), known->impl_->points.begin(), known->impl_->points.end());
    const PointTree<RadiancePoint> neighbours(points);
    workers.forEach(fresh, 256, [&](std::size_t i) {
        points[i].lookup = lookupRadius(neighbours, points, points[i], options.maxRadius);
    });
    std::vector<std::uint64_t> rays(fresh, static_cast<std::uint64_t>(options.lampSamples));
    workers.forEach(fresh, 256, [&](std::size_t i) {
        RadiancePoint& p = points[i];
        rays[i] += estimateIndirect(scene, indirect, tree, p, options);
        p.irradiance += directIrradiance(scene, p, options, before + i);
    });
    if (before > 0) sortAlongMortonCurve(points);
    impl_->rays = std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
    impl_->index(farthestLookup(options.maxRadius));
}

RadianceMap::~RadianceMap() = default;

std::optional<RadianceMap::Found> RadianceMap::find(const glm::vec3& position, const glm::vec3& normal) const noexcept {
    const std::uint32_t best = impl_->nearest(position, normal);
    if (best == kNobody) return std::nullopt;
    const RadiancePoint& p = impl_->points[best];
    return Found{p.irradiance, p.caustic, p.radius};
}

bool RadianceMap::covers(const glm::vec3& position, const glm::vec3& normal) const noexcept {
    const std::uint32_t best = impl_->nearest(position, normal);
    return best != kNobody && glm::length(position - impl_->points[best].position) <= impl_->points[best].radius;
}

std::vector<char> RadianceMap::save() const {
    static_assert(std::is_trivially_copyable_v<RadiancePoint> && sizeof(RadiancePoint) % sizeof(float) == 0);
    std::vector<char> bytes(sizeof(float) + impl_->points.size() * sizeof(RadiancePoint));
    std::memcpy(bytes.data(), &impl_->reach, sizeof(float));
    if (!impl_->points.empty())
        std::memcpy(bytes.data() + sizeof(float), impl_->points.data(), bytes.size() - sizeof(float));
    return bytes;
}

std::unique_ptr<RadianceMap> RadianceMap::restore(const std::vector<char>& bytes) {
    if (bytes.size() < sizeof(float) || (bytes.size() - sizeof(float)) % sizeof(RadiancePoint) != 0) return nullptr;
    std::vector<float> numbers(bytes.size() / sizeof(float));
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
    if (!std::all_of(numbers.begin(), numbers.end(), [](float f) { return std::isfinite(f); }) || !(numbers[0] > 0.0F))
        return nullptr;
    std::unique_ptr<RadianceMap> map(new RadianceMap());
    map->impl_->points.resize((bytes.size() - sizeof(float)) / sizeof(RadiancePoint));
    if (!map->impl_->points.empty())
        std::memcpy(map->impl_->points.data(), bytes.data() + sizeof(float), bytes.size() - sizeof(float));
    for (const RadiancePoint& p : map->impl_->points)
        if (!(glm::length(p.position) < kFarthest) || !(p.radius > 0.0F)) return nullptr;
    map->impl_->index(numbers[0]);
    return map;
}

std::vector<RadianceMap::Place> RadianceMap::places() const {
    std::vector<Place> list;
    list.reserve(impl_->points.size());
    for (const RadiancePoint& p : impl_->points) list.push_back({p.position, p.normal, p.irradiance, p.radius});
    return list;
}

std::size_t RadianceMap::points() const noexcept { return impl_->points.size(); }
std::uint64_t RadianceMap::rays() const noexcept { return impl_->rays; }

}  // namespace pellucid

#include <pellucid/transport/radiance_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include <pellucid/math/constants.h>
#include <pellucid/math/frame.h>
#include <pellucid/math/sampler.h>
#include <pellucid/math/warps.h>
#include <pellucid/transport/walk.h>

#include "photon_tree.h"

namespace pellucid {

namespace {

constexpr float kMinNormalCosine = 0.8F;
constexpr float kMaxPlaneDistance = 0.2F;  ///< of the distance searched
constexpr int kMaxNeighbours = 64;
/// A place answers for look-ups within this many radii of its estimate, or of the distance to its kNeighbour-th neighbour.
constexpr float kReach = 1.5F;
constexpr int kNeighbour = 6;
/// Of the places, those found after a second D vertex: near corners gather rays go on to there.
constexpr std::size_t kSecondShare = 4;
constexpr std::uint64_t kPlaceStream = 0x706c6163ULL;
constexpr std::uint32_t kNobody = 0xffffffffU;
constexpr std::size_t kSectors = 8;
/// No place of a map that was read from somewhere is as far from the centre: the scene's radius is about 1.
constexpr float kFarthest = 1e6F;
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
    float radius = 0.0F;      ///< of the density estimate
    float reach = 0.0F;       ///< of look-ups
    float freeRadius = 0.0F;  ///< reachable all around; farther away the point's sectors decide
};

struct RadiancePoint {
    glm::vec3 position{0.0F}, normal{0.0F}, shadingNormal{0.0F};
    DiffuseLobe lobe;
    Rgb irradiance{0.0F}, caustic{0.0F};
    float radius = 0.0F, lookup = 0.0F;  ///< of the estimate and of look-ups
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

/// The distance to the kNeighbour-th nearest point on the same side, or the bound.
struct NeighbourDistance {
    const std::vector<RadiancePoint>& points;
    glm::vec3 normal;
    float radius2;
    std::array<float, kNeighbour + 1> nearest{};  ///< squared, sorted; with the point itself
    int found = 0;

    void init() noexcept {}
    [[nodiscard]] std::size_t size() const noexcept { return static_cast<std::size_t>(found); }
    [[nodiscard]] bool full() const noexcept { return true; }
    [[nodiscard]] float worstDist() const noexcept { return radius2; }
    bool addPoint(float distance2, std::uint32_t index) noexcept {
        if (distance2 >= radius2 || glm::dot(points[index].normal, normal) < kMinNormalCosine) return true;
        int at = std::min(found, kNeighbour);
        for (; at > 0 && nearest[static_cast<std::size_t>(at - 1)] > distance2; --at)
            nearest[static_cast<std::size_t>(at)] = nearest[static_cast<std::size_t>(at - 1)];
        nearest[static_cast<std::size_t>(at)] = distance2;
        found = std::min(found + 1, kNeighbour + 1);
        if (found == kNeighbour + 1) radius2 = std::min(radius2, nearest[kNeighbour]);
        return true;
    }
};

[[nodiscard]] float distanceToNeighbour(const PointTree<RadiancePoint>& tree, const std::vector<RadiancePoint>& points,
                                        const RadiancePoint& p, float bound) {
    NeighbourDistance search{points, p.normal, bound * bound};
    tree.search(p.position, search);
    return search.found > kNeighbour ? std::sqrt(search.nearest[kNeighbour]) : bound;
}

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

[[nodiscard]] Rgb directIrradiance(const Scene& scene, const RadiancePoint& p, int samples, std::uint64_t seed,
                                   std::size_t index) {
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
        if (visible > 0.0F)
            sum += light->radiance * (visible * cosine * p.lobe.transmittance(cosine) / light->pdfSolidAngle);
    }
    return sum / static_cast<float>(samples);
}

/// Short rays along the surface, as far as look-ups reach: two a sector. A sector is as free as the shortest of the rays at
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
        const auto hit = scene.intersect(Ray{origin, direction[i], p.lookup}, 0.0F);
        distance[i] = hit ? hit->distance : p.lookup;
    }
    for (std::size_t middle = 1; middle < kRays; middle += 2)
        p.reach.free[Reach::sector(frame, direction[middle])] =
            std::min({distance[middle - 1], distance[middle], distance[(middle + 1) % kRays]});
}

/// k-nearest density estimate with the (k-1) form, which is unbiased in a flat field, over the sectors' free areas; with fewer
/// than k photons inside the largest radius, all of them.
void estimateIndirect(const Scene& scene, const PhotonList& photons, const std::vector<std::uint8_t>& overSpecular,
                      const PointTree<Photon>& tree, RadiancePoint& p, int neighbours, float maxRadius) {
    NearestPhotons nearest{photons, p.position, p.normal, std::min(neighbours, kMaxNeighbours), maxRadius * maxRadius};
    tree.search(p.position, nearest);
    const bool bounded = nearest.found < nearest.wanted;
    p.radius = bounded ? maxRadius : std::sqrt(nearest.radius2);
    p.lookup = std::max(p.lookup, kReach * p.radius);
    measureReach(scene, p);
    float area = 0.0F;
    for (const float free : p.reach.free) {
        const float inside = std::min(free, p.radius);
        area += kPi / static_cast<float>(kSectors) * inside * inside;
    }
    if (!(area > 0.0F)) return;
    const Frame frame(p.normal);
    for (int i = bounded ? 0 : 1; i < nearest.found; ++i) {  // heap[0] is the farthest: the k-th, left out
        const auto& [distance2, index] = nearest.heap[static_cast<std::size_t>(i)];
        const Photon& photon = photons[index];
        const float free = p.reach.free[Reach::sector(frame, photon.position - p.position)];
        if (distance2 > free * free) continue;
        const float t =
            p.lobe.b != 0.0F ? p.lobe.transmittance(std::max(0.0F, glm::dot(photon.wi, p.shadingNormal))) : p.lobe.a;
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

    /// Makes ready for look-ups as far as `farthest`.
    void index(float farthest) {
        reach = farthest;
        sites.clear();
        for (const RadiancePoint& p : points)
            sites.push_back({p.position, p.normal, p.radius, p.lookup,
                             *std::min_element(p.reach.free.begin(), p.reach.free.end())});
        tree = std::make_unique<PointTree<RadianceSite>>(sites);
    }

    [[nodiscard]] std::uint32_t nearest(const glm::vec3& position, const glm::vec3& normal) const noexcept {
        NearestSite search{sites, points, position, normal, reach * reach};
        tree->search(position, search);
        return search.best;
    }
};

std::vector<GatherPoint> findPlaces(const TransportContext& context, const std::vector<GatherPoint>& points,
                                    std::size_t count, std::uint64_t seed, const Workers& workers) {
    std::vector<std::uint32_t> from;
    for (std::uint32_t i = 0; i < points.size(); ++i)
        if (points[i].valid) from.push_back(i);
    std::vector<GatherPoint> found(from.empty() ? 0 : count);
    workers.forEach(found.size(), 256, [&](std::size_t i) {
        Sampler choice(seed, kPlaceStream, static_cast<std::uint32_t>(i));
        const auto pick = static_cast<std::size_t>(choice.next1D() * static_cast<float>(from.size()));
        GatherPoint at = points[from[std::min(pick, from.size() - 1)]];
        for (int vertex = i % kSecondShare == 0 ? 2 : 1; vertex > 0 && at.valid; --vertex) {
            Sampler sampler(hashCombine(seed, static_cast<std::uint64_t>(vertex)), kPlaceStream + 1,
                            static_cast<std::uint32_t>(i));
            const glm::vec3 direction = Frame(at.normal).toWorld(sampleCosineHemisphere(sampler.next2D()));
            if (glm::dot(direction, at.geometricNormal) <= 0.0F) {
                at.valid = false;
                break;
            }
            WalkRay ray;
            ray.ray =
                Ray{offsetOrigin(at.position, at.geometricNormal), direction, std::numeric_limits<float>::infinity()};
            ray.absorption = at.absorption;
            at = Walk(context).findGatherPoint(ray, sampler);
        }
        found[i] = at;
    });
    std::erase_if(found, [](const GatherPoint& p) { return !p.valid; });
    return found;
}

RadianceMap::RadianceMap() : impl_(std::make_unique<Impl>()) {}

RadianceMap::RadianceMap(const Scene& scene, const std::vector<GlobalPhoton>& photons,
                         const std::vector<GatherPoint>& places, const RadianceMapOptions& options,
                         const Workers& workers, const RadianceMap* known)
    : RadianceMap() {
    struct Indirect {
        glm::vec3 position;
        std::uint32_t photon;
    };
    std::vector<Indirect> order;
    for (std::uint32_t i = 0; i < photons.size(); ++i)
        if (photons[i].arrived != Arrived::Directly) order.push_back({photons[i].photon.position, i});
    sortAlongMortonCurve(order);
    PhotonList indirect;
    std::vector<std::uint8_t> overSpecular;
    indirect.reserve(order.size());
    for (const Indirect& o : order) {
        indirect.push_back(photons[o.photon].photon);
        overSpecular.push_back(photons[o.photon].arrived == Arrived::OverSpecular ? 1 : 0);
    }
    const PointTree<Photon> tree(indirect);
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
        RadiancePoint& p = points[i];
        p.lookup = std::min(kReach * distanceToNeighbour(neighbours, points, p, options.maxRadius),
                            kReach * options.maxRadius);
    });
    workers.forEach(fresh, 256, [&](std::size_t i) {
        RadiancePoint& p = points[i];
        estimateIndirect(scene, indirect, overSpecular, tree, p, options.neighbours, options.maxRadius);
        p.irradiance += directIrradiance(scene, p, options.lampSamples, options.seed, before + i);
    });
    if (before > 0) sortAlongMortonCurve(points);
    impl_->rays = fresh * (static_cast<std::uint64_t>(options.lampSamples) + 2 * kSectors);
    impl_->index(kReach * options.maxRadius);
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

#include "radiance_point.h"

#include <algorithm>

#include <pellucid/math/constants.h>
#include <pellucid/math/sampler.h>
#include <pellucid/transport/kernel_mass.h>
#include <pellucid/transport/walk.h>

namespace pellucid {

namespace {

constexpr float kMaxPlaneDistance = 0.2F;  ///< of the distance searched
constexpr int kMaxNeighbours = 64;
/// A place answers for look-ups within this many radii of its estimate, or of the distance to its kNeighbour-th neighbour.
constexpr float kReach = 1.5F;
constexpr int kNeighbour = 6;
/// Rings of equal width that a sector of the kernel is cut into, to find out how far there is surface in it.
constexpr int kRings = 5;
/// Of the height that photons may have, for rounding; and the least of the kernel's free area that counts as surface.
constexpr float kProbeSlack = 1.01F, kLeastShare = 0.05F;
/// Height of the sectors' rays over the surface, as a share of the kernel's radius.
constexpr float kSectorHeight = 0.05F;

/// The k nearest photons that arrived indirectly on the same side, within a bound.
struct NearestPhotons : NearestHeap<kMaxNeighbours> {
    const PhotonList& photons;
    glm::vec3 point, normal;
    float above, below;

    NearestPhotons(const PhotonList& list, const RadiancePoint& p, int count, float bound2)
        : NearestHeap{count, bound2},
          photons(list),
          point(p.position),
          normal(p.normal),
          above(p.above),
          below(p.below) {}
    bool addPoint(float distance2, std::uint32_t index) noexcept {
        if (distance2 >= radius2) return true;
        const Photon& p = photons[index];
        if (glm::dot(p.normal, normal) < kMinNormalCosine) return true;
        const float height = glm::dot(p.position - point, normal);
        if (height * height > kMaxPlaneDistance * kMaxPlaneDistance * std::max(distance2, 1e-8F)) return true;
        if (height > above || height < -below) return true;
        keep(distance2, index);
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

/// Sheets a few millimetres apart (a page on a table) face the same way and are not the same surface.
void measureClearance(const Scene& scene, RadiancePoint& p, float farthest) noexcept {
    const auto half = [&](const glm::vec3& direction) {
        const auto hit = scene.intersect(Ray{offsetOrigin(p.position, direction), direction, farthest}, 0.0F);
        return hit ? 0.5F * hit->distance : farthest;
    };
    p.above = half(p.normal);
    p.below = half(-p.normal);
}

/// Short rays along the surface, as far as look-ups reach: two a sector. A sector is as free as the shortest of the rays at
/// its borders and in its middle, so that hardly any of its area lies behind a wall.
void measureReach(const Scene& scene, RadiancePoint& p) noexcept {
    const Frame frame(p.normal);
    const glm::vec3 origin =
        offsetOrigin(p.position + p.normal * std::min(kSectorHeight * p.radius, p.above), p.normal);
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

/// Of a sector's area within `radius`, the share where there is surface whose photons count: beyond an edge there is none, and
/// a small body bends away. From the outermost ring inwards; what lies within a ring with surface is taken to have it, too.
[[nodiscard]] float surfaceShare(const Scene& scene, const RadiancePoint& p, const glm::vec3& along, float radius,
                                 std::uint64_t& rays) noexcept {
    for (int ring = kRings; ring > 0; --ring) {
        const float end = static_cast<float>(ring) / kRings, distance = radius * (end - 0.5F / kRings),
                    up = std::min(kMaxPlaneDistance * distance, p.above),
                    down = std::min(kMaxPlaneDistance * distance, p.below);
        const glm::vec3 start = offsetOrigin(p.position, p.normal) + along * distance + p.normal * up;
        ++rays;
        if (surfaceUnder(scene, start, p.normal, kProbeSlack * (up + down), kMinNormalCosine)) return end * end;
    }
    return 0.0F;
}

/// Of the kernel's disc, the area that is surface and can be seen from the point.
[[nodiscard]] float areaOf(const Scene& scene, const RadiancePoint& p, const Frame& frame,
                           std::uint64_t& rays) noexcept {
    float area = 0.0F, free2 = 0.0F;
    bool whole = true;  // so far; an edge is met by every other sector, too
    for (const std::size_t first : {0U, 1U})
        for (std::size_t i = first; i < kSectors; i += 2) {
            const float phi = kTwoPi * (static_cast<float>(i) + 0.5F) / static_cast<float>(kSectors);
            const glm::vec3 along = frame.tangent * std::cos(phi) + frame.bitangent * std::sin(phi);
            const float inside = std::min(p.reach.free[Reach::sector(frame, along)], p.radius);
            free2 += inside * inside;
            if (!(inside > 0.0F)) continue;
            const float share = first == 1 && whole ? 1.0F : surfaceShare(scene, p, along, inside, rays);
            whole = whole && share == 1.0F;
            area += inside * inside * share;
        }
    return kPi / static_cast<float>(kSectors) * std::max(area, kLeastShare * free2);
}

}  // namespace

IndirectPhotons indirectOf(const std::vector<GlobalPhoton>& photons) {
    struct Indirect {
        glm::vec3 position;
        std::uint32_t photon;
    };
    std::vector<Indirect> order;
    for (std::uint32_t i = 0; i < photons.size(); ++i)
        if (photons[i].arrived != Arrived::Directly) order.push_back({photons[i].photon.position, i});
    sortAlongMortonCurve(order);
    IndirectPhotons indirect;
    indirect.photons.reserve(order.size());
    for (const Indirect& o : order) {
        indirect.photons.push_back(photons[o.photon].photon);
        indirect.overSpecular.push_back(photons[o.photon].arrived == Arrived::OverSpecular ? 1 : 0);
    }
    return indirect;
}

float farthestLookup(float maxRadius) noexcept { return kReach * maxRadius; }

float lookupRadius(const PointTree<RadiancePoint>& tree, const std::vector<RadiancePoint>& points,
                   const RadiancePoint& p, float maxRadius) {
    NeighbourDistance search{points, p.normal, maxRadius * maxRadius};
    tree.search(p.position, search);
    const float distance = search.found > kNeighbour ? std::sqrt(search.nearest[kNeighbour]) : maxRadius;
    return std::min(kReach * distance, kReach * maxRadius);
}

Rgb directIrradiance(const Scene& scene, const RadiancePoint& p, const RadianceMapOptions& options, std::size_t index) {
    Rgb sum(0.0F);
    for (int s = 0; s < options.lampSamples; ++s) {
        Sampler sampler(options.seed, index, static_cast<std::uint32_t>(s));
        const float fine = sampler.next1D();
        const auto light = scene.lights().sample(p.position, p.normal, fine, sampler.next2D());
        if (!light || !(light->pdfSolidAngle > 0.0F)) continue;
        const float cosine = glm::dot(light->wi, p.shadingNormal);
        if (cosine <= 0.0F || glm::dot(light->wi, p.normal) <= 0.0F) continue;
        const Ray shadow = shadowRay(p.position, p.normal, light->wi, light->distance);
        const float visible = shadow.tMax > 0.0F ? scene.visibility(shadow) : 1.0F;
        if (visible > 0.0F)
            sum += light->radiance * (visible * cosine * p.lobe.transmittance(cosine) / light->pdfSolidAngle);
    }
    return sum / static_cast<float>(options.lampSamples);
}

/// k-nearest density estimate with the (k-1) form, which is unbiased in a flat field, over the surface in the sectors' free
/// areas; with fewer than k photons inside the largest radius, all of them.
std::uint64_t estimateIndirect(const Scene& scene, const IndirectPhotons& photons, const PointTree<Photon>& tree,
                               RadiancePoint& p, const RadianceMapOptions& options) {
    const float maxRadius = options.maxRadius;
    measureClearance(scene, p, kMaxPlaneDistance * farthestLookup(maxRadius));
    NearestPhotons nearest(photons.photons, p, std::min(options.neighbours, kMaxNeighbours), maxRadius * maxRadius);
    tree.search(p.position, nearest);
    const bool bounded = nearest.found < nearest.wanted;
    p.radius = bounded ? maxRadius : std::sqrt(nearest.radius2);
    p.lookup = std::max(p.lookup, kReach * p.radius);
    measureReach(scene, p);
    const Frame frame(p.normal);
    std::uint64_t rays = 2 + 2 * kSectors;
    const float area = areaOf(scene, p, frame, rays);
    if (!(area > 0.0F)) return rays;
    for (int i = bounded ? 0 : 1; i < nearest.found; ++i) {  // heap[0] is the farthest: the k-th, left out
        const auto& [distance2, index] = nearest.heap[static_cast<std::size_t>(i)];
        const Photon& photon = photons.photons[index];
        const float free = p.reach.free[Reach::sector(frame, photon.position - p.position)];
        if (distance2 > free * free) continue;
        const float t =
            p.lobe.b != 0.0F ? p.lobe.transmittance(std::max(0.0F, glm::dot(photon.wi, p.shadingNormal))) : p.lobe.a;
        p.irradiance += photon.flux * (t / area);
        if (photons.overSpecular[index] != 0) p.caustic += photon.flux * (t / area);
    }
    return rays;
}

}  // namespace pellucid

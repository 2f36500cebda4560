// Where gather rays land: the places of the global map.
#include <algorithm>
#include <limits>

#include <pellucid/math/frame.h>
#include <pellucid/math/hash.h>
#include <pellucid/math/sampler.h>
#include <pellucid/math/warps.h>
#include <pellucid/transport/radiance_map.h>
#include <pellucid/transport/walk.h>

namespace pellucid {

namespace {

/// Of the places, those found after a second D vertex: near corners gather rays go on to there.
constexpr std::size_t kSecondShare = 4;
constexpr std::uint64_t kPlaceStream = 0x706c6163ULL;

}  // namespace

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
            at = Walk(context).findGatherPoint(ray, sampler, GatherStop::ByChance);
        }
        found[i] = at;
    });
    std::erase_if(found, [](const GatherPoint& p) { return !p.valid; });
    return found;
}

}  // namespace pellucid

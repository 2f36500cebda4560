#include <pellucid/transport/lamp_chains.h>

#include <limits>

#include "medium.h"
#include "roulette.h"
#include "wavelength.h"

namespace pellucid {

namespace {

/// Beyond those that a walk uses.
constexpr std::uint64_t kDimension = 1ULL << 20U;
/// Roulette sets in below this throughput, at the first surfaces.
constexpr float kLeastThroughput = 0.05F;

}  // namespace

void LampChains::branchOff(const ChainVertex& vertex, const DeltaBranches& branches, Sampler& sampler) {
    const glm::vec3& ng = vertex.bsdf.geometricNormal();
    const float least = vertex.vertices <= kMostParting ? kLeastThroughput : 1.0F;
    for (int i = 0; i < branches.count; ++i) {
        const BsdfSample& way = branches.branch[static_cast<std::size_t>(i)];
        Branch b;
        b.throughput = vertex.throughput * way.weight;
        b.etaScale = vertex.etaScale * way.etaScale;
        const float chance = survival(maxComponent(b.throughput) * b.etaScale / least, vertex.vertices);
        if (!(chance > 0.0F) || (chance < 1.0F && sampler.next1D() >= chance)) continue;
        b.throughput /= chance;
        const bool behind = glm::dot(way.wi, ng) < 0.0F;
        b.ray = Ray{offsetOrigin(vertex.hit.point.position, behind ? -ng : ng), way.wi,
                    std::numeric_limits<float>::infinity()};
        b.absorption = medium::afterHit(scene_, vertex.hit.point, vertex.bsdf, vertex.absorption, way.transmitted);
        b.path = vertex.path;
        b.path.pass(way.kind);
        b.vertices = vertex.vertices;
        b.wave = vertex.wave;
        waiting_.push_back(b);
    }
}

bool LampChains::follow(const ChainVertex& vertex, Sampler& sampler, LayeredRadiance& sum) {
    if ((vertex.bsdf.kinds() & kSpecular) == kNoLobe) return false;
    const DeltaBranches first = vertex.bsdf.deltaBranches(vertex.wo, TransportMode::Radiance);
    if (first.count < 2) return false;
    sampler.setDimension(kDimension);
    waiting_.clear();
    branchOff(vertex, first, sampler);
    while (!waiting_.empty()) {
        Branch b = waiting_.back();
        waiting_.pop_back();
        ++rays_;
        const auto hit = scene_.intersect(b.ray, scene_.hasHoles() ? sampler.next1D() : 0.0F);
        if (!hit) {
            if (const Environment* environment = scene_.environment())
                sum.add(b.path, b.throughput * environment->radiance(b.ray.direction));
            continue;
        }
        const glm::vec3 wo = -b.ray.direction;
        if (wavelength::isDue(scene_, hit->point, b.wave)) b.throughput *= wavelength::choose(b.wave, sampler);
        const Bsdf bsdf = scene_.surfaces().bsdf(hit->point, wo, b.wave);
        const Rgb absorption = medium::beforeHit(scene_, hit->point, bsdf, b.absorption);
        const Rgb throughput = b.throughput * medium::transmittance(absorption, hit->distance);
        const Rgb emitted = scene_.surfaces().emittedRadiance(hit->point, wo);
        if (!isBlack(emitted)) sum.add(b.path, throughput * emitted);
        const int vertices = b.vertices + 1;
        if ((bsdf.kinds() & (kSpecular | kGlossy)) != kNoLobe && (maxDepth_ == 0 || vertices <= maxDepth_))
            branchOff({*hit, bsdf, wo, throughput, absorption, b.etaScale, b.path, vertices, b.wave},
                      bsdf.deltaBranches(wo, TransportMode::Radiance), sampler);
    }
    return true;
}

}  // namespace pellucid

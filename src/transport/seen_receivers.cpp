#include <pellucid/transport/seen_receivers.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <pellucid/math/constants.h>
#include <pellucid/math/sampler.h>

#include "medium.h"
#include "wavelength.h"

namespace pellucid {

namespace {

constexpr std::uint64_t kLookStream = 6ULL << 40U;
constexpr std::size_t kPixelsPerChunk = 1024;
constexpr int kLongestChain = 256;
constexpr std::uint64_t kFirstDimension = 2, kDimensionsPerVertex = 5;

void look(const Scene& scene, const Camera& camera, std::uint32_t pixel, Sampler& sampler, SeenReceivers& seen) {
    const auto width = static_cast<std::uint32_t>(camera.width());
    const glm::vec2 corner(static_cast<float>(pixel % width), static_cast<float>(pixel / width));
    const glm::vec2 jitter = sampler.next2D(), lens = sampler.next2D();
    Ray ray = camera.ray(corner + jitter, lens).ray;
    Rgb throughput(1.0F), absorption(0.0F);
    float etaScale = 1.0F;
    Wave wave;
    for (int vertex = 0; vertex < kLongestChain; ++vertex) {
        const std::uint64_t dimension = kFirstDimension + kDimensionsPerVertex * static_cast<std::uint64_t>(vertex);
        sampler.setDimension(dimension);
        ++seen.rays;
        const auto hit = scene.intersect(ray, sampler.next1D());
        if (!hit) return;
        const glm::vec3 wo = -ray.direction;
        if (wavelength::isDue(scene, hit->point, wave)) {
            sampler.setDimension(wavelength::kDimension + static_cast<std::uint64_t>(vertex));
            throughput *= wavelength::choose(wave, sampler);
            sampler.setDimension(dimension + 1);
        }
        const Bsdf bsdf = scene.surfaces().bsdf(hit->point, wo, wave);
        absorption = medium::beforeHit(scene, hit->point, bsdf, absorption);
        throughput *= medium::transmittance(absorption, hit->distance);
        if (vertex > 0 && (bsdf.kinds() & kDiffuse) != kNoLobe) {
            const DiffuseLobe& lobe = bsdf.diffuse();
            const float towardsEye = std::min(1.0F, std::fabs(glm::dot(wo, bsdf.shadingNormal())));
            seen.places.push_back({pixel, hit->point.geometry, hit->point.primitive, hit->point.barycentric,
                                   bsdf.backSide(),
                                   throughput * lobe.reflectance * (kInvPi * lobe.transmittance(towardsEye)), lobe});
        }
        const float choose = sampler.next1D();
        const auto next = bsdf.sample(wo, choose, sampler.next2D(), kSpecular, TransportMode::Radiance);
        if (!next) return;
        if (!next->delta) wave = {};
        throughput *= next->weight;
        etaScale *= next->etaScale;
        const float survive = std::min(vertex > 64 ? 0.95F : 1.0F, maxComponent(throughput) * etaScale);
        if (!(survive > 0.0F) || sampler.next1D() >= survive) return;
        throughput /= survive;
        absorption = medium::afterHit(scene, hit->point, bsdf, absorption, next->transmitted);
        const glm::vec3& n = bsdf.geometricNormal();
        ray = Ray{offsetOrigin(hit->point.position, glm::dot(next->wi, n) < 0.0F ? -n : n), next->wi,
                  std::numeric_limits<float>::infinity()};
    }
}

}  // namespace

SeenReceivers lookOverSpecular(const Scene& scene, const Camera& camera, std::uint64_t seed, std::uint32_t pass,
                               const Workers& workers) {
    const std::size_t pixels = static_cast<std::size_t>(camera.width()) * static_cast<std::size_t>(camera.height());
    std::vector<SeenReceivers> chunks((pixels + kPixelsPerChunk - 1) / kPixelsPerChunk);
    workers.forRanges(pixels, kPixelsPerChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Sampler sampler(seed, kLookStream + i, pass);
            look(scene, camera, static_cast<std::uint32_t>(i), sampler, chunks[begin / kPixelsPerChunk]);
        }
    });
    SeenReceivers all;
    for (const SeenReceivers& chunk : chunks) {
        all.places.insert(all.places.end(), chunk.places.begin(), chunk.places.end());
        all.rays += chunk.rays;
    }
    return all;
}

}  // namespace pellucid

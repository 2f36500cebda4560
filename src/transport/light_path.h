/// One light path, vertex by vertex: shared by the photon passes and light tracing.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <pellucid/base/parallel.h>
#include <pellucid/math/sampler.h>
#include <pellucid/scene/scene.h>
#include <pellucid/transport/energy.h>

#include "medium.h"
#include "roulette.h"
#include "wavelength.h"

namespace pellucid::light_path {

inline constexpr std::size_t kPathsPerChunk = 2048;
inline constexpr std::uint64_t kEmissionDimensions = 5, kDimensionsPerVertex = 4;
/// Light whose correction for shading normals is above this is dropped: it would explode. Only where the normals differ, so
/// that flat surfaces lose nothing, however flatly they are grazed (a room of 1000 bounces would lose a tenth of its light).
inline constexpr float kMaxShading = 100.0F;

struct LightPath {
    Ray ray;
    Rgb flux{0.0F};
    Rgb absorption{0.0F};
    int vertices = 0;
    Wave wave = {};  ///< of this chain of delta lobes
    EnergyBalance energy = {};
    /// What the flux that the next scattering takes away goes to.
    double EnergyBalance::*sink = &EnergyBalance::absorbed;

    LightPath(const Ray& start, const Rgb& power) noexcept : ray(start), flux(power) { energy.emitted = watts(); }
    [[nodiscard]] double watts() const noexcept {
        return (static_cast<double>(flux.r) + static_cast<double>(flux.g) + static_cast<double>(flux.b)) / 3.0;
    }
};

struct Arrival {
    SurfaceHit hit;
    Bsdf bsdf;
    glm::vec3 wi;   ///< back along the ray
    float shading;  ///< |wi.ns| / |wi.ng|: flux density on the true surface to irradiance of the shaded one
};

/// What arriving flux lays on the surface as it is shaded, for an estimate of its density: where some of the light passes
/// (alpha) the eye does too, and what the surface shows must not be lessened twice.
[[nodiscard]] inline Rgb onSurface(const Arrival& a, const Rgb& flux) noexcept {
    return flux * (a.shading / a.hit.coverage);
}

/// The next vertex of a light path, with absorption applied. Empty: it escaped or grazes.
[[nodiscard]] inline std::optional<Arrival> arrive(const Scene& scene, LightPath& path, Sampler& sampler) noexcept {
    const std::uint64_t dimension =
        kEmissionDimensions + kDimensionsPerVertex * static_cast<std::uint64_t>(path.vertices);
    sampler.setDimension(dimension);
    const auto hit = scene.intersect(path.ray, scene.hasHoles() ? sampler.next1D() : 0.0F);
    if (!hit) {
        path.energy.escaped += path.watts();
        return std::nullopt;
    }
    ++path.vertices;
    const glm::vec3 wi = -path.ray.direction;
    if (wavelength::isDue(scene, hit->point, path.wave)) {
        path.energy.roulette += path.watts();
        sampler.setDimension(wavelength::kDimension + static_cast<std::uint64_t>(path.vertices));
        path.flux *= wavelength::choose(path.wave, sampler);
        sampler.setDimension(dimension + (scene.hasHoles() ? 1U : 0U));
        path.energy.roulette -= path.watts();
    }
    const Bsdf bsdf = scene.surfaces().bsdf(hit->point, wi, path.wave);
    path.absorption = medium::beforeHit(scene, hit->point, bsdf, path.absorption);
    if (!isBlack(path.absorption)) {
        path.energy.absorbed += path.watts();
        path.flux *= medium::transmittance(path.absorption, hit->distance);
        path.energy.absorbed -= path.watts();
    }
    const float geometric = std::fabs(glm::dot(wi, bsdf.geometricNormal()));
    const float shaded = std::fabs(glm::dot(wi, bsdf.shadingNormal()));
    if (!(geometric > 0.0F) || shaded > kMaxShading * geometric) {
        path.energy.dropped += path.watts();
        return std::nullopt;
    }
    return Arrival{*hit, bsdf, wi, shaded / geometric};
}

/// Scatters flux among `kinds` (`by` receives the lobe's own); the factor of shading normals is that of adjoint BSDFs. [Veach1997, 5.3]
[[nodiscard]] inline bool scatter(const Scene& scene, LightPath& path, const Arrival& a, LobeKinds kinds,
                                  Sampler& sampler, LobeKinds* by = nullptr) noexcept {
    const float chooseLobe = sampler.next1D();
    const auto sample = a.bsdf.sample(a.wi, chooseLobe, sampler.next2D(), kinds, TransportMode::Flux);
    path.energy.*path.sink += path.watts();
    if (!sample) return false;
    if (by != nullptr) *by = sample->kind;
    if (!sample->delta) path.wave = {};
    const float shadingOut = std::fabs(glm::dot(sample->wi, a.bsdf.shadingNormal()));
    const float geometricOut = std::fabs(glm::dot(sample->wi, a.bsdf.geometricNormal()));
    if (!(shadingOut > 0.0F)) return false;
    const float before = maxComponent(path.flux);
    path.flux *= sample->weight * (a.shading * geometricOut / shadingOut);
    path.energy.*path.sink -= path.watts();
    const float after = maxComponent(path.flux);
    const float chance = survival(before > 0.0F ? after / before : 0.0F, path.vertices);
    path.energy.roulette += path.watts();
    if (!(chance > 0.0F) || sampler.next1D() >= chance) return false;
    path.flux /= chance;
    path.energy.roulette -= path.watts();
    const bool behind = glm::dot(sample->wi, a.bsdf.geometricNormal()) < 0.0F;
    path.ray = Ray{offsetOrigin(a.hit.point.position, behind ? -a.bsdf.geometricNormal() : a.bsdf.geometricNormal()),
                   sample->wi, std::numeric_limits<float>::infinity()};
    path.absorption = medium::afterHit(scene, a.hit.point, a.bsdf, path.absorption, sample->transmitted);
    return true;
}

/// Runs trace(path index, chunk result) over all paths and appends the chunks in order.
template <class Chunk>
[[nodiscard]] std::vector<Chunk> inChunks(std::uint32_t paths, const Workers& workers,
                                          const std::function<void(std::uint32_t, Chunk&)>& trace) {
    std::vector<Chunk> chunks((paths + kPathsPerChunk - 1) / kPathsPerChunk);
    workers.forRanges(paths, kPathsPerChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) trace(static_cast<std::uint32_t>(i), chunks[i / kPathsPerChunk]);
    });
    return chunks;
}

/// Appends `part` of every chunk in order and frees it, so that hardly more than one copy lives at a time.
template <class Chunk, class Item>
void gather(std::vector<Item>& to, std::vector<Chunk>& chunks, std::vector<Item> Chunk::*part) {
    std::size_t size = to.size();
    for (const Chunk& c : chunks) size += (c.*part).size();
    to.reserve(size);
    for (Chunk& c : chunks) {
        to.insert(to.end(), (c.*part).begin(), (c.*part).end());
        std::vector<Item>().swap(c.*part);
    }
}

}  // namespace pellucid::light_path

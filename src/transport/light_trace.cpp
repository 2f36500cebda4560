#include <pellucid/transport/light_trace.h>

#include <pellucid/transport/walk.h>

#include "light_path.h"

namespace pellucid {

using namespace light_path;

namespace {

/// Connects an arrival to the lens, one splat for each kind of lobe; the factor of shading normals is that of adjoint BSDFs. [Veach1997, 5.3]
[[nodiscard]] bool connect(const Scene& scene, const Camera& camera, const Arrival& a, const Rgb& flux,
                           const glm::vec2& lens, LightPass& out) {
    const auto film = camera.project(a.hit.point.position, lens);
    if (!film || !(film->importance > 0.0F)) return false;
    const glm::vec3& ng = a.bsdf.geometricNormal();
    const Rgb f = a.bsdf.eval(a.wi, film->direction, kGlossy | kDiffuse, TransportMode::Flux);
    if (isBlack(f)) return false;
    const float shadingOut = std::fabs(glm::dot(film->direction, a.bsdf.shadingNormal()));
    const float geometricOut = std::fabs(glm::dot(film->direction, ng));
    if (!(shadingOut > 0.0F)) return false;
    ++out.rays;
    const Ray shadow{offsetOrigin(a.hit.point.position, glm::dot(film->direction, ng) < 0.0F ? -ng : ng),
                     film->direction, shadowLength(film->distance)};
    const float visible = scene.visibility(shadow);
    if (visible <= 0.0F) return false;
    const int x = static_cast<int>(film->position.x), y = static_cast<int>(film->position.y);
    if (x < 0 || y < 0 || x >= camera.width() || y >= camera.height()) return false;
    const float shading = a.shading * geometricOut / shadingOut;
    const Rgb scale = flux * (shading * film->importance * visible);
    for (const LobeKinds kind : {kGlossy, kDiffuse}) {
        const Rgb part =
            (a.bsdf.kinds() & kGlossy) == kNoLobe ? f : a.bsdf.eval(a.wi, film->direction, kind, TransportMode::Flux);
        if (isBlack(part) || (a.bsdf.kinds() & kind) == kNoLobe) continue;
        PathString path;
        path.pass(kind);
        path.pass(kSpecular);
        out.splats.push_back({static_cast<std::uint32_t>(y * camera.width() + x), scale * part, path});
    }
    return true;
}

[[nodiscard]] CausticArrival arrivalOf(const Arrival& a, const Rgb& flux) noexcept {
    return {a.hit.point.geometry,
            a.hit.point.primitive,
            a.hit.point.barycentric,
            a.bsdf.backSide(),
            std::min(1.0F, std::fabs(glm::dot(a.wi, a.bsdf.shadingNormal()))),
            onSurface(a, flux)};
}

/// From the receiver of a caustic on over casters alone. A copy of the path: its light has been counted.
void bounceOn(const Scene& scene, LightPath path, const Arrival& receiver, Sampler sampler, float perPath,
              LightPass& out) {
    if (!scatter(scene, path, receiver, kDiffuse, sampler)) return;
    for (bool overCaster = false;; overCaster = true) {
        ++out.rays;
        const auto a = arrive(scene, path, sampler);
        if (!a) return;
        if (overCaster && (a->bsdf.kinds() & kDiffuse) != kNoLobe)
            out.bounced.push_back(arrivalOf(*a, path.flux * perPath));
        if (!scatter(scene, path, *a, kSpecular, sampler)) return;
    }
}

}  // namespace

LightPass traceLightPaths(const Scene& scene, const Camera& camera, const EmissionGuide& guide,
                          const PhotonPassKey& key, const Workers& workers, const VisibleCells* looked) {
    const float perPath = 1.0F / static_cast<float>(std::max<std::uint32_t>(1, key.paths));
    auto chunks = inChunks<LightPass>(key.paths, workers, [&](std::uint32_t index, LightPass& out) {
        Sampler sampler(key.seed, key.pass, index);
        const auto start = guide.sample(sampler);
        if (!start) return;
        const glm::vec2 lens = sampler.next2D();
        LightPath path{start->emission.ray, start->emission.flux};
        float arrived = 0.0F;
        for (;;) {
            ++out.rays;
            const auto a = arrive(scene, path, sampler);
            if (!a) break;
            path.sink =
                (a->bsdf.kinds() & (kGlossy | kDiffuse)) != kNoLobe ? &EnergyBalance::left : &EnergyBalance::absorbed;
            if (path.vertices > 1 && (a->bsdf.kinds() & (kGlossy | kDiffuse)) != kNoLobe) {
                const bool kept = looked != nullptr && (a->bsdf.kinds() & kDiffuse) != kNoLobe;
                const bool splatted = connect(scene, camera, *a, path.flux * perPath, lens, out);
                if (splatted) path.sink = &EnergyBalance::stored;
                if (splatted || (kept && looked->seen(a->hit.point.position))) arrived += luminance(path.flux);
                if (kept) {
                    out.arrivals.push_back(arrivalOf(*a, path.flux * perPath));
                    const std::uint64_t stream = hashCombine(key.pass, static_cast<std::uint64_t>(path.vertices));
                    bounceOn(scene, path, *a, Sampler(key.seed, stream, index), perPath, out);
                }
            }
            if (!scatter(scene, path, *a, kSpecular, sampler)) break;
        }
        out.energy.add(path.energy, static_cast<double>(perPath));
        if (arrived > 0.0F) {
            UsefulEmission origin = start->origin;
            origin.weight = arrived;
            out.useful.push_back(origin);
        }
    });
    LightPass pass;
    pass.emitted = key.paths;
    gather(pass.splats, chunks, &LightPass::splats);
    gather(pass.arrivals, chunks, &LightPass::arrivals);
    gather(pass.bounced, chunks, &LightPass::bounced);
    gather(pass.useful, chunks, &LightPass::useful);
    for (const LightPass& c : chunks) {
        pass.rays += c.rays;
        pass.energy.add(c.energy);
    }
    return pass;
}

}  // namespace pellucid

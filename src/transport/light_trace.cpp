#include <pellucid/transport/light_trace.h>

#include <pellucid/transport/walk.h>

#include "light_path.h"

namespace pellucid {

using namespace light_path;

namespace {

/// Connects an arrival to the lens; the factor of shading normals is that of adjoint BSDFs. [Veach1997, 5.3]
[[nodiscard]] std::optional<LightSplat> connect(const Scene& scene, const Camera& camera, const Arrival& a, const Rgb& flux,
                                                const glm::vec2& lens, std::uint64_t& rays) noexcept {
    const auto film = camera.project(a.hit.point.position, lens);
    if (!film || !(film->importance > 0.0F)) return std::nullopt;
    const glm::vec3& ng = a.bsdf.geometricNormal();
    const Rgb f = a.bsdf.eval(a.wi, film->direction, kGlossy | kDiffuse, TransportMode::Flux);
    if (isBlack(f)) return std::nullopt;
    const float shadingOut = std::fabs(glm::dot(film->direction, a.bsdf.shadingNormal()));
    const float geometricOut = std::fabs(glm::dot(film->direction, ng));
    if (!(shadingOut > 0.0F)) return std::nullopt;
    ++rays;
    const Ray shadow{offsetOrigin(a.hit.point.position, glm::dot(film->direction, ng) < 0.0F ? -ng : ng), film->direction,
                     shadowLength(film->distance)};
    const float visible = scene.visibility(shadow);
    if (visible <= 0.0F) return std::nullopt;
    const int x = static_cast<int>(film->position.x), y = static_cast<int>(film->position.y);
    if (x < 0 || y < 0 || x >= camera.width() || y >= camera.height()) return std::nullopt;
    const float shading = a.shading * geometricOut / shadingOut;
    Rgb radiance = flux * f * (shading * film->importance * visible);
    return LightSplat{static_cast<std::uint32_t>(y * camera.width() + x), radiance};
}

}  // namespace

LightPass traceLightPaths(const Scene& scene, const Camera& camera, const EmissionGuide& guide, const PhotonPassKey& key,
                          const Workers& workers) {
    const float perPath = 1.0F / static_cast<float>(std::max<std::uint32_t>(1, key.paths));
    const auto chunks = inChunks<LightPass>(key.paths, workers, [&](std::uint32_t index, LightPass& out) {
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
            path.sink = (a->bsdf.kinds() & (kGlossy | kDiffuse)) != kNoLobe ? &EnergyBalance::left : &EnergyBalance::absorbed;
            if (path.vertices > 1 && (a->bsdf.kinds() & (kGlossy | kDiffuse)) != kNoLobe) {
                if (const auto splat = connect(scene, camera, *a, path.flux * perPath, lens, out.rays)) {
                    out.splats.push_back(*splat);
                    path.sink = &EnergyBalance::stored;
                    arrived += luminance(path.flux);
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
    for (const LightPass& c : chunks) {
        pass.splats.insert(pass.splats.end(), c.splats.begin(), c.splats.end());
        pass.useful.insert(pass.useful.end(), c.useful.begin(), c.useful.end());
        pass.rays += c.rays;
        pass.energy.add(c.energy);
    }
    return pass;
}

}  // namespace pellucid

#include <pellucid/transport/photon_trace.h>

#include "light_path.h"

namespace pellucid {

using namespace light_path;

namespace {

[[nodiscard]] bool receives(const Arrival& a) noexcept { return (a.bsdf.kinds() & kDiffuse) != kNoLobe; }

[[nodiscard]] Photon photonOf(const Arrival& a, const Rgb& flux, float perPath) noexcept {
    return {a.hit.point.position, a.wi, a.bsdf.geometricNormal(), onSurface(a, flux) * perPath};
}

[[nodiscard]] bool usable(const Photon& p) noexcept { return isFinite(p.flux) && !isBlack(p.flux); }

/// Paths over all lobes, lights by power; calls keep(chunk, photon, how it came) at every D vertex.
template <class Pass, class Keep>
[[nodiscard]] Pass traceAll(const Scene& scene, const PhotonPassKey& key, const Workers& workers, const Keep& keep) {
    const float perPath = 1.0F / static_cast<float>(std::max<std::uint32_t>(1, key.paths));
    const EmissionGuide unguided(scene.lights(), {}, 0.0);
    auto chunks = inChunks<Pass>(key.paths, workers, [&](std::uint32_t index, Pass& out) {
        Sampler sampler(key.seed, key.pass, index);
        const auto start = unguided.sample(sampler);
        if (!start) return;
        LightPath path{start->emission.ray, start->emission.flux};
        auto arrived = Arrived::Directly;
        for (;;) {
            ++out.rays;
            const auto a = arrive(scene, path, sampler);
            if (!a) break;
            if (receives(*a)) {
                const Photon photon = photonOf(*a, path.flux, perPath);
                if (usable(photon)) keep(out, photon, arrived);
            }
            LobeKinds by = kNoLobe;
            if (!scatter(scene, path, *a, kAllLobes, sampler, &by)) break;
            arrived = by == kSpecular && arrived != Arrived::Otherwise ? Arrived::OverSpecular : Arrived::Otherwise;
        }
        out.energy.add(path.energy, static_cast<double>(perPath));
    });
    Pass pass;
    pass.emitted = key.paths;
    gather(pass.photons, chunks, &Pass::photons);
    for (const Pass& c : chunks) {
        pass.rays += c.rays;
        pass.energy.add(c.energy);
    }
    return pass;
}

}  // namespace

CausticPass traceCausticPhotons(const Scene& scene, const EmissionGuide& guide, const PhotonPassKey& key,
                                const VisibleCells* visible, const Workers& workers, CasterTally* tally) {
    const float perPath = 1.0F / static_cast<float>(std::max<std::uint32_t>(1, key.paths));
    auto chunks = inChunks<CausticPass>(key.paths, workers, [&](std::uint32_t index, CausticPass& out) {
        Sampler sampler(key.seed, key.pass, index);
        const auto start = guide.sample(sampler);
        if (!start) return;
        LightPath path{start->emission.ray, start->emission.flux};
        const float emitted = luminance(path.flux),
                    density = scene.lights().etendueDensity(start->emission.light, path.ray.direction);
        bool useful = false;
        glm::vec3 landed(0.0F);
        Rgb arrived(0.0F);
        CasterTally::Path fate;
        bool ended = false;
        for (;;) {
            ++out.rays;
            const auto a = arrive(scene, path, sampler);
            if (!a) break;
            ended = true;
            path.sink = receives(*a) ? &EnergyBalance::left : &EnergyBalance::absorbed;
            if (path.vertices > 1 && receives(*a)) {
                Photon photon = photonOf(*a, path.flux, perPath);
                photon.etendueDensity = density;
                const bool seen = visible == nullptr || visible->seen(photon.position);
                if (tally != nullptr && usable(photon)) fate.leavePhoton(seen);
                if (usable(photon) && seen) {
                    if (index < key.originsOf && tally != nullptr)
                        out.origins.push_back(tally->originOf(photon.position, start->emission.light, fate));
                    out.photons.push_back(photon);
                    path.sink = &EnergyBalance::stored;
                    arrived += path.flux;
                    if (!useful) landed = photon.position;
                    useful = true;
                }
            }
            if (tally != nullptr) tally->meet(fate, a->hit.point.material);
            if (!scatter(scene, path, *a, kSpecular, sampler)) break;
            ended = false;
        }
        if (tally != nullptr) tally->add(start->emission.light, fate, path.vertices, !ended);
        out.energy.add(path.energy, static_cast<double>(perPath));
        if (useful && emitted > 0.0F) {
            UsefulEmission origin = start->origin;
            origin.weight = luminance(arrived);
            origin.landed = landed;
            out.useful.push_back(origin);
        }
    });
    CausticPass pass;
    pass.emitted = key.paths;
    gather(pass.photons, chunks, &CausticPass::photons);
    gather(pass.useful, chunks, &CausticPass::useful);
    gather(pass.origins, chunks, &CausticPass::origins);
    for (const CausticPass& c : chunks) {
        pass.rays += c.rays;
        pass.energy.add(c.energy);
    }
    return pass;
}

GlobalPass traceGlobalPhotons(const Scene& scene, const PhotonPassKey& key, const Workers& workers) {
    return traceAll<GlobalPass>(scene, key, workers, [](GlobalPass& out, const Photon& photon, Arrived arrived) {
        out.photons.push_back({photon, arrived});
    });
}

OtherPass traceOtherPhotons(const Scene& scene, const PhotonPassKey& key, const VisibleCells& visible,
                            const Workers& workers) {
    return traceAll<OtherPass>(scene, key, workers, [&](OtherPass& out, const Photon& photon, Arrived arrived) {
        if (arrived == Arrived::Otherwise && visible.seen(photon.position)) out.photons.push_back(photon);
    });
}

}  // namespace pellucid

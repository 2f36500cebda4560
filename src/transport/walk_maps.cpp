// Where an eye path meets a D surface: what photon maps and cache answer, and what is left to path tracing.
#include <algorithm>
#include <cmath>

#include <pellucid/math/constants.h>
#include <pellucid/transport/caustic_map.h>
#include <pellucid/transport/irradiance_cache.h>
#include <pellucid/transport/kernel_mass.h>
#include <pellucid/transport/radiance_map.h>
#include <pellucid/transport/walk.h>

#include "walk_state.h"

namespace pellucid {

namespace {

/// Near a corner the map's blur would show: a gather ray shorter than u x this many look-up radii goes on instead.
constexpr float kCornerRadii = 8.0F;

}  // namespace

float Walk::massOf(bool edge, const CausticMap& map, const PhotonEstimate& found, const Vertex& vertex, float radius,
                   float turn) noexcept {
    if (!edge || found.photons == 0) return 1.0F;
    return kernelMass(context_.scene, vertex.hit.point.position, vertex.bsdf.geometricNormal(), radius, map.kernel(),
                      turn, rays_);
}

/// All photons but those that came directly or over S alone.
void Walk::addOthers(State& state, const Vertex& vertex, const Rgb& outgoing, float turn) noexcept {
    const Maps& maps = context_.maps;
    const float radius =
        glm::clamp(state.ray.kernels.others.footprints * vertex.footprint, maps.causticRadiusMin, maps.othersRadiusMax);
    const DiffuseLobe lobe = vertex.bsdf.diffuse();
    const PhotonEstimate found =
        maps.others->estimate({vertex.hit.point.position, vertex.bsdf.geometricNormal(), vertex.bsdf.shadingNormal(),
                               lobe, radius, -1.0F, tally_ != nullptr ? &tally_->other : nullptr});
    const Rgb reflected =
        state.throughput * outgoing / massOf(state.ray.kernels.others.edge, *maps.others, found, vertex, radius, turn);
    const Rgb seen = reflected * found.irradiance;
    state.radiance.add(state.ledger.pathAfter(kDiffuse).open(), seen);
    state.radiance.shared += luminance(seen);
    state.radiance.blur += luminance(reflected) * found.blur;
}

/// Hands the D lobe to the maps. Returns kDiffuse when path tracing has to carry it on.
LobeKinds Walk::serveDiffuse(State& state, const Vertex& vertex, Sampler& sampler, FirstHit* first) noexcept {
    const Maps& maps = context_.maps;
    const DiffuseLobe& lobe = vertex.bsdf.diffuse();
    const glm::vec3& normal = vertex.bsdf.shadingNormal();
    const glm::vec3& position = vertex.hit.point.position;
    const Rgb outgoing =
        lobe.reflectance * (kInvPi * lobe.transmittance(std::min(1.0F, std::fabs(glm::dot(vertex.wo, normal)))));
    if (state.gathering) {
        if (maps.global != nullptr) {
            const auto found = maps.global->find(position, vertex.bsdf.geometricNormal());
            const float u = sampler.next1D();
            const bool nearCorner = found && state.chainEmpty && vertex.hit.distance < u * kCornerRadii * found->radius;
            if (found && !nearCorner) {
                state.radiance.add(state.ledger.pathAfter(kDiffuse).open(),
                                   state.throughput * outgoing * found->irradiance);
                return kNoLobe;
            }
            // Near a corner all but the caustics, which path tracing hardly finds, goes on.
            if (found && maps.causticsApart()) {
                PathString path = state.ledger.pathAfter(kDiffuse);
                path.pass(kSpecular);
                state.radiance.add(path, state.throughput * outgoing * found->caustic);
                state.causticServed = true;
            }
        }
        return kDiffuse;
    }
    const float turn = state.ray.kernels.caustic.edge || state.ray.kernels.others.edge ? sampler.next1D() : 0.0F;
    if (maps.caustic != nullptr) {
        const float radius = glm::clamp(state.ray.kernels.caustic.footprints * vertex.footprint, maps.causticRadiusMin,
                                        maps.causticRadiusMax);
        state.causticServed = true;
        state.sharedNext = maps.causticsShared();
        state.kernelRadius = radius;
        const PhotonEstimate found = maps.caustic->estimate({position, vertex.bsdf.geometricNormal(), normal, lobe,
                                                             radius, state.sharedNext ? maps.photonsPerEtendue : -1.0F,
                                                             tally_ != nullptr ? &tally_->caustic : nullptr});
        if (first != nullptr && state.vertices == 1)
            first->kernelRadius = radius, first->kernelPhotons = static_cast<float>(found.photons);
        PathString path = state.ledger.pathAfter(kDiffuse);
        path.pass(kSpecular);
        const Rgb reflected = state.throughput * outgoing /
                              massOf(state.ray.kernels.caustic.edge, *maps.caustic, found, vertex, radius, turn);
        const Rgb seen = reflected * found.irradiance;
        state.radiance.add(path, seen);
        state.radiance.shared += luminance(seen);
        state.radiance.blur += luminance(reflected) * found.blur;
    }
    if (maps.others != nullptr) {
        addOthers(state, vertex, outgoing, turn);
        state.chainsNext = maps.causticChains;
        return state.chainsNext ? kDiffuse : kNoLobe;
    }
    if (maps.cache != nullptr) {
        if (const auto cached = maps.cache->lookup(position, vertex.bsdf.unmappedNormal(), normal, &rays_)) {
            const Rgb reflected = state.throughput * outgoing;
            state.radiance.add(state.ledger.pathAfter(kDiffuse).open(), reflected * cached->through(lobe));
            state.radiance.recordNoise += luminance(reflected) * lobe.a * cached->noise;
            state.chainsNext = maps.causticChains;
            return state.chainsNext ? kDiffuse : kNoLobe;
        }
        ++cacheMisses_;  // gathers once: the walk simply goes on
    }
    return kDiffuse;
}

}  // namespace pellucid

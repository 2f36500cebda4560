/// What lights give to a walk: those that a direction meets, and those that next-event estimation finds.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <pellucid/math/constants.h>
#include <pellucid/transport/caustic_map.h>

#include "medium.h"
#include "walk_state.h"

namespace pellucid {

namespace {

/// Candidates for a direction to the environment, from its map and from the cosine.
constexpr int kFromMap = 2, kFromCosine = 2;
/// Beyond those that a walk uses elsewhere.
constexpr std::uint64_t kResampleDimension = 3ULL << 20U;

}  // namespace

float Walk::misWeight(float mine, float other) const noexcept {
    if (!(mine > 0.0F)) return 0.0F;
    if (!std::isfinite(mine)) return 1.0F;
    const float ratio = other / mine;
    return context_.options.powerHeuristic ? 1.0F / (1.0F + ratio * ratio) : 1.0F / (1.0F + ratio);
}

float Walk::hitWeight(float pdfSampled, float pdfLight) const noexcept {
    switch (context_.options.lights) {
        case LightStrategy::Chance:
            return 1.0F;
        case LightStrategy::NextEvent:
            return pdfLight > 0.0F ? 0.0F : 1.0F;
        case LightStrategy::Both:
            break;
    }
    return misWeight(pdfSampled, pdfLight);
}

/// The eye's share of light that `light` sends over S alone; `towards` points to it.
float Walk::chainShare(const State& state, std::uint32_t light, const glm::vec3& towards) const noexcept {
    return chanceShare(state.kernelRadius, context_.maps.photonsPerEtendue,
                       context_.scene.lights().etendueDensity(light, -towards));
}

void Walk::addEscaped(State& state) const noexcept {
    const Environment* environment = context_.scene.environment();
    if (environment == nullptr || !state.lampCounts(context_.options.left)) return;
    float weight = 1.0F;
    if (state.lampSampled)
        weight = hitWeight(state.pdfSolidAngle, context_.scene.lights().pdfEnvironment(
                                                    state.lightPoint, state.lightNormal, state.ray.ray.direction));
    if (state.hasSharedChain())
        weight *= chainShare(state, context_.scene.lights().environmentLight(), state.ray.ray.direction);
    state.radiance.add(state.ledger.path(), state.throughput * environment->radiance(state.ray.ray.direction) * weight);
}

void Walk::addEmitted(State& state, const SurfaceHit& hit) const noexcept {
    if (!state.lampCounts(context_.options.left)) return;
    const Rgb emitted = context_.scene.surfaces().emittedRadiance(hit.point, -state.ray.ray.direction);
    if (isBlack(emitted)) return;
    float weight = 1.0F;
    if (state.lampSampled)
        weight = hitWeight(state.pdfSolidAngle, context_.scene.lights().pdfTriangle(
                                                    state.lightPoint, state.lightNormal, hit.point.geometry,
                                                    hit.point.primitive, state.ray.ray.direction, hit.distance));
    if (state.hasSharedChain())
        weight *= chainShare(state, context_.scene.lights().lightOf(hit.point.geometry, hit.point.primitive),
                             state.ray.ray.direction);
    state.radiance.add(state.ledger.path(), state.throughput * emitted * weight);
}

/// f |cos| towards `light` by kind of lobe, weighted against sampling where the lobe is sampled too.
std::array<Rgb, 3> Walk::lobesTowards(const Vertex& vertex, LobeKinds kinds, LobeKinds sampled,
                                      const LightSample& light) const noexcept {
    const bool weighted = context_.options.lights == LightStrategy::Both && !light.delta;
    std::array<Rgb, 3> sum{Rgb(0.0F), Rgb(0.0F), Rgb(0.0F)};
    if (kinds == sampled && (kinds & (kinds - 1)) == 0 && context_.options.directions == Directions::Bsdf) {
        // One kind of lobe, which is sampled too: value and density in one go.
        const BsdfValue v = vertex.bsdf.evaluate(vertex.wo, light.wi, kinds, TransportMode::Radiance);
        sum[kinds == kSpecular ? 0U
            : kinds == kGlossy ? 1U
                               : 2U] = v.value * misWeight(light.pdfSolidAngle, weighted ? v.pdfSolidAngle : 0.0F);
        return sum;
    }
    const float pdfSampled =
        weighted ? vertex.bsdf.pdf(vertex.wo, light.wi, sampled, context_.options.directions) : 0.0F;
    const float shared = misWeight(light.pdfSolidAngle, pdfSampled);
    for (std::size_t i = 0; i < 3; ++i) {
        const auto kind = static_cast<LobeKinds>(1U << i);
        if ((kinds & kind) == kNoLobe) continue;
        const Rgb f = vertex.bsdf.eval(vertex.wo, light.wi, kind, TransportMode::Radiance);
        if (!isBlack(f)) sum[i] = f * ((sampled & kind) != kNoLobe ? shared : 1.0F);
    }
    return sum;
}

/// Resampled importance sampling [TalbotClineEgbert2005] of the environment at a D vertex of which no direction is sampled:
/// the map's density knows no cosine, and the cosine no sun. Candidates of both stand by the balance heuristic; one is
/// kept in proportion to what it would bring unshadowed. `seen.pdfSolidAngle` becomes the density it stands for. Unbiased.
bool Walk::resampleEnvironment(const Vertex& vertex, LobeKinds kinds, LobeKinds sampled, const LightPick& sky,
                               const glm::vec2& u, Sampler& sampler, LightSample& seen,
                               std::array<Rgb, 3>& lobes) const noexcept {
    const Lights& lights = context_.scene.lights();
    float total = 0.0F, kept = 0.0F;
    sampler.setDimension(kResampleDimension);
    float left = sampler.next1D();
    for (int i = 0; i < kFromMap + kFromCosine; ++i) {
        // A rank-1 lattice spreads the candidates [Roberts2018]: they need not be independent.
        const glm::vec2 at = glm::fract(u + static_cast<float>(i) * glm::vec2(0.75487766F, 0.56984029F));
        std::optional<LightSample> candidate;
        if (i < kFromMap) {
            candidate = lights.sampleFrom(sky, vertex.hit.point.position, vertex.lightNormal, at);
        } else if (const auto way = vertex.bsdf.sample(vertex.wo, 0.0F, at, kDiffuse, TransportMode::Radiance)) {
            candidate = lights.towardsEnvironment(sky, vertex.lightNormal, way->wi);
        }
        if (!candidate) continue;
        const float density =
            static_cast<float>(kFromMap) * candidate->pdfSolidAngle +
            static_cast<float>(kFromCosine) * sky.pmf * vertex.bsdf.pdf(vertex.wo, candidate->wi, kDiffuse);
        const auto f = lobesTowards(vertex, kinds, sampled, *candidate);
        const float target = luminance(candidate->radiance * (f[0] + f[1] + f[2]));
        if (!(target > 0.0F) || !(density > 0.0F)) continue;
        const float weight = target / density;
        total += weight;
        // Of a streamed choice by one number, what is left of it is uniform again [Chao1982].
        const float share = weight / total;
        if (left < share) {
            left /= share;
            seen = *candidate;
            lobes = f;
            kept = target;
        } else {
            left = std::min((left - share) / (1.0F - share), kOneMinusEpsilon);
        }
    }
    if (!(kept > 0.0F)) return false;
    seen.pdfSolidAngle = kept / total;
    return true;
}

/// At a receiver whose other light the maps serve: as many samples as are asked for, which share its weight.
void Walk::addSplitDirect(State& state, const Vertex& vertex, LobeKinds kinds, LobeKinds sampled,
                          const Sampler& sampler) noexcept {
    const Rgb whole = state.throughput;
    state.throughput /= static_cast<float>(lampSamples_);
    for (int i = 0; i < lampSamples_; ++i) {
        Sampler part = sampler.split(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(lampSamples_));
        addDirect(state, vertex, kinds, sampled, part);
    }
    state.throughput = whole;
}

/// Next-event estimation for `kinds`; those that are also `sampled` share the class with sampling by MIS.
void Walk::addDirect(State& state, const Vertex& vertex, LobeKinds kinds, LobeKinds sampled,
                     Sampler& sampler) noexcept {
    const float fine = sampler.next1D();
    const glm::vec2 numbers = sampler.next2D();
    const glm::vec3& position = vertex.hit.point.position;
    const Lights& lights = context_.scene.lights();
    const auto pick = lights.choose(position, vertex.lightNormal, Lights::choiceNumber(fine, numbers));
    if (!pick) return;
    const glm::vec2 u = Lights::pointNumbers(*pick, numbers);
    LightSample light;
    std::array<Rgb, 3> lobes;
    if (leavesDiffuse(kinds, sampled) && lights.kind(pick->light) == LightKind::Environment) {
        if (!resampleEnvironment(vertex, kinds, sampled, *pick, u, sampler, light, lobes)) return;
    } else {
        const auto seen = lights.sampleFrom(*pick, position, vertex.lightNormal, u);
        if (!seen) return;
        light = *seen;
        lobes = lobesTowards(vertex, kinds, sampled, light);
        if (isBlack(lobes[0] + lobes[1] + lobes[2])) return;
    }
    const glm::vec3& ng = vertex.bsdf.geometricNormal();
    const Ray shadow = shadowRay(position, glm::dot(light.wi, ng) >= 0.0F ? ng : -ng, light.wi, light.distance);
    ++rays_;
    const float visible = shadow.tMax > 0.0F ? context_.scene.visibility(shadow) : 1.0F;
    if (shadows_ != nullptr && !state.gathering && !light.delta)
        (visible > 0.0F ? shadows_->seen : shadows_->hidden) = true;
    if (visible <= 0.0F) return;
    Rgb arriving = light.radiance * (visible / light.pdfSolidAngle);
    const bool through = glm::dot(light.wi, ng) < 0.0F;
    arriving *= medium::transmittance(
        medium::afterHit(context_.scene, vertex.hit.point, vertex.bsdf, state.ray.absorption, through), light.distance);
    for (std::size_t i = 0; i < 3; ++i)
        if (!isBlack(lobes[i])) {
            const bool shared = i == 0 && state.chainsShared && state.chainSpecular;  // over S alone
            state.radiance.add(
                state.ledger.pathAfter(static_cast<LobeKinds>(1U << i)),
                state.throughput * arriving * lobes[i] * (shared ? chainShare(state, light.light, light.wi) : 1.0F));
        }
}

}  // namespace pellucid

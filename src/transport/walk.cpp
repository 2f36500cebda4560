#include <pellucid/transport/walk.h>

#include <array>
#include <cmath>
#include <limits>

#include <pellucid/math/constants.h>

#include "kind_choice.h"
#include "medium.h"
#include "roulette.h"
#include "walk_state.h"
#include "wavelength.h"

namespace pellucid {

namespace {

/// A look for a D vertex is given up after this many others.
constexpr int kMostOnTheWay = 64;
/// Of the D vertices beyond the first that a look tells of.
constexpr std::size_t kMostBeyond = 3;
/// Of the threshold of roulette, along smooth chains from the eye whose branches are all followed: a weak reflection in glass
/// is a small part of a pixel but mostly unlike the rest of it, so it is worth more looks than its share. Not many more, where
/// glass stands behind glass.
constexpr float kChainRoulette = 0.16F;
/// A branch takes its numbers from dimensions of its own, so many beyond those of the branch before it.
constexpr std::uint64_t kDimensionsPerBranch = 1U << 12U;
/// Sampler dimensions: 0 film, 1 lens, then this many a vertex.
constexpr std::uint64_t kFirstDimension = 2, kDimensionsPerVertex = 8;
enum VertexDimension : std::uint64_t {
    kCoin,
    kLightChoice,
    kLightPoint,
    kLobeChoice,
    kLobePoint,
    kKindChoice,
    kRoulette,
    kCorner
};

/// The kind of lobe that made a direction, and what that makes of the throughput. No kind: nothing came this way.
struct Onward {
    LobeKinds kind = kNoLobe;
    Rgb weight{0.0F};
};

/// Where several kinds could have made the direction one is chosen by its share of f, so that every class gets its own energy.
[[nodiscard]] Onward onward(const Bsdf& bsdf, const glm::vec3& wo, const BsdfSample& sample, LobeKinds sampled,
                            Sampler& sampler) noexcept {
    const LobeKinds present = bsdf.kinds() & sampled;
    if (sample.delta || (present & (present - 1)) == 0) return {sample.kind, sample.weight};
    std::array<Rgb, 3> f{Rgb(0.0F), Rgb(0.0F), Rgb(0.0F)};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto kind = static_cast<LobeKinds>(1U << i);
        if ((present & kind) != kNoLobe) f[i] = bsdf.eval(wo, sample.wi, kind, TransportMode::Radiance);
    }
    const KindChoice chosen = chooseKind(f, sampler.next1D());
    if (chosen.kind == kNoLobe) return {};
    return {chosen.kind, chosen.value * (chosen.total / (chosen.part * sample.pdfSolidAngle))};
}

}  // namespace

/// Sends the ray on over `sample`.
void Walk::leave(State& state, const Vertex& vertex, const BsdfSample& sample) noexcept {
    state.deltaChain = state.deltaChain && sample.delta;
    if (!sample.delta) state.wave = {};
    state.throughput *= sample.weight;
    state.etaScale *= sample.etaScale;
    state.pass(sample.kind);
    state.pdfSolidAngle = sample.pdfSolidAngle;
    state.lampSampled = state.pdfSolidAngle > 0.0F;
    state.lightPoint = vertex.hit.point.position;
    state.lightNormal = vertex.lightNormal;
    const glm::vec3& ng = vertex.bsdf.geometricNormal();
    const bool behindSurface = glm::dot(sample.wi, ng) < 0.0F;
    state.ray.ray = Ray{offsetOrigin(vertex.hit.point.position, behindSurface ? -ng : ng), sample.wi,
                        std::numeric_limits<float>::infinity()};
    state.ray.absorption =
        medium::afterHit(context_.scene, vertex.hit.point, vertex.bsdf, state.ray.absorption, sample.transmitted);
}

/// Goes on over `sample`, with roulette. False: the walk ends.
bool Walk::goOn(State& state, const Vertex& vertex, const BsdfSample& sample, Sampler& sampler) noexcept {
    leave(state, vertex, sample);
    const float threshold = context_.options.rouletteThreshold * (splits(state) ? kChainRoulette : 1.0F);
    const float wanted = threshold > 0.0F ? maxComponent(state.throughput) * state.etaScale / threshold : 1.0F;
    const float chance = survival(wanted, state.vertices);
    if (!(chance > 0.0F)) return false;
    if (chance < 1.0F) {
        if (sampler.next1D() >= chance) return false;
        state.throughput /= chance;
    }
    return true;
}

/// Samples the next direction among `sampled` lobes, and the kind that it counts as. None: the walk ends.
std::optional<BsdfSample> Walk::choose(const Vertex& vertex, LobeKinds sampled, Sampler& sampler) noexcept {
    const float chooseLobe = sampler.next1D();
    const glm::vec2 u = sampler.next2D();
    auto sample =
        vertex.bsdf.sample(vertex.wo, chooseLobe, u, sampled, TransportMode::Radiance, context_.options.directions);
    if (!sample) return std::nullopt;
    const Onward on = onward(vertex.bsdf, vertex.wo, *sample, sampled, sampler);
    if (on.kind == kNoLobe) return std::nullopt;
    sample->kind = on.kind;
    sample->weight = on.weight;
    return sample;
}

/// Goes on in a direction among `sampled` lobes. False: the walk ends.
bool Walk::scatter(State& state, const Vertex& vertex, LobeKinds sampled, Sampler& sampler) noexcept {
    const auto sample = choose(vertex, sampled, sampler);
    return sample && goOn(state, vertex, *sample, sampler);
}

bool Walk::splits(const State& state) const noexcept {
    return context_.options.splitGlass && state.deltaChain && !state.gathering && state.vertices <= kMostParting;
}

/// Where a smooth interface parts the light the walk goes one way and `other` waits for the other. False: it does not.
bool Walk::split(State& state, const Vertex& vertex, Sampler& sampler, Branches& branches) noexcept {
    const DeltaBranches ways = vertex.bsdf.deltaBranches(vertex.wo, TransportMode::Radiance);
    if (ways.count != 2) return false;
    for (const BsdfSample& way : ways.branch) {
        State branch = state;
        branch.dimensions = kDimensionsPerBranch * ++branches.made;
        if (goOn(branch, vertex, way, sampler)) branches.waiting.push_back(branch);
    }
    return true;
}

void Walk::takeWavelength(State& state, Sampler& sampler) noexcept {
    sampler.setDimension(wavelength::kDimension + state.dimensions + static_cast<std::uint64_t>(state.vertices));
    state.throughput *= wavelength::choose(state.wave, sampler);
}

bool Walk::step(State& state, Branches& branches, Sampler& sampler, FirstHit* first, float* firstDistance) noexcept {
    const std::uint64_t dimension =
        kFirstDimension + state.dimensions + kDimensionsPerVertex * static_cast<std::uint64_t>(state.vertices);
    sampler.setDimension(dimension + kCoin);
    ++rays_;
    const auto hit = context_.scene.intersect(state.ray.ray, holes_ ? sampler.next1D() : 0.0F);
    if (firstDistance != nullptr && state.vertices == 0)
        *firstDistance = hit ? hit->distance : std::numeric_limits<float>::infinity();
    if (!hit) {
        if (trace_ != nullptr) write(state, nullptr, nullptr);
        addEscaped(state);
        return false;
    }
    ++state.vertices;
    state.pathLength += hit->distance;
    const glm::vec3 wo = -state.ray.ray.direction;
    if (wavelength::isDue(context_.scene, hit->point, state.wave)) takeWavelength(state, sampler);
    const Bsdf bsdf = context_.scene.surfaces().bsdf(hit->point, wo, state.wave);
    state.ray.absorption = medium::beforeHit(context_.scene, hit->point, bsdf, state.ray.absorption);
    state.throughput *= medium::transmittance(state.ray.absorption, hit->distance);
    if (trace_ != nullptr) write(state, &*hit, &bsdf);
    addEmitted(state, *hit);
    const bool transmits = context_.scene.surfaces().materials()[hit->point.material].transmission > 0.0F;
    const Vertex vertex{*hit, bsdf, wo, state.ray.footprintAtOrigin + state.ray.footprintSpread * state.pathLength,
                        transmits ? glm::vec3(0.0F) : bsdf.geometricNormal()};
    if (first != nullptr && state.vertices == 1) {
        first->albedo = bsdf.diffuse().reflectance;
        first->normal = bsdf.shadingNormal();
        first->depth = hit->distance;
    }
    const LobeKinds kinds = state.onlyChains ? bsdf.kinds() & kSpecular : bsdf.kinds();
    if (kinds == kNoLobe || (context_.options.maxDepth > 0 && state.vertices > context_.options.maxDepth)) return false;
    if (context_.options.splitLampChains && state.deltaChain && !state.gathering && !state.lampsFollowed)
        state.lampsFollowed = lampChains_.follow({*hit, bsdf, wo, state.throughput, state.ray.absorption,
                                                  state.etaScale, state.ledger.path(), state.vertices, state.wave},
                                                 sampler, state.radiance);
    LobeKinds sampled = kinds & (kSpecular | kGlossy);
    LobeKinds direct = kinds;
    state.causticServed = state.chainsNext = state.sharedNext = false;
    sampler.setDimension(dimension + kCorner);
    if ((kinds & kDiffuse) != kNoLobe) {
        const LobeKinds carried = serveDiffuse(state, vertex, sampler, first);
        sampled = sampled | carried;
        if (state.gathering && carried == kNoLobe)
            direct = direct & (kSpecular | kGlossy);  // the global map holds direct light too
    }
    // S lobes behind a mapped receiver are the caustic map's, the whole chain long.
    const bool chainMapped = state.behind == Behind::CausticMapped && state.gathering && state.chainSpecular;
    const bool left = context_.options.left.has(state.ledger.pathAfter(kSpecular));
    if (chainMapped || left) direct = direct & (kGlossy | kDiffuse);
    if (context_.options.lights == LightStrategy::Chance)
        direct = static_cast<LobeKinds>(direct & ~static_cast<unsigned>(sampled));
    sampler.setDimension(dimension + kLightChoice);
    if (direct != kNoLobe && !state.gathering && leavesDiffuse(direct, sampled))
        addSplitDirect(state, vertex, direct, sampled, sampler);
    else if (direct != kNoLobe)
        addDirect(state, vertex, direct, sampled, sampler);
    if (sampled == kNoLobe) return false;
    sampler.setDimension(dimension + kLobeChoice);
    if (sampled == kSpecular && splits(state) && split(state, vertex, sampler, branches)) return false;
    return scatter(state, vertex, sampled, sampler);
}

void Walk::write(const State& state, const SurfaceHit* hit, const Bsdf* bsdf) const {
    TracedVertex vertex;
    vertex.throughput = state.throughput;
    vertex.wave = state.wave;
    vertex.before = state.radiance;
    if (hit == nullptr) {
        vertex.hit = false;
        vertex.position = state.ray.ray.direction;
        vertex.distance = std::numeric_limits<float>::infinity();
    } else {
        vertex.position = hit->point.position;
        vertex.normal = bsdf->shadingNormal();
        vertex.distance = hit->distance;
        vertex.geometry = hit->point.geometry;
        vertex.primitive = hit->point.primitive;
        vertex.material = hit->point.material;
        vertex.kinds = bsdf->kinds();
        vertex.backSide = bsdf->backSide();
    }
    trace_->push_back(vertex);
}

void Walk::run(State& state, Sampler& sampler, FirstHit* first, float* firstDistance) noexcept {
    Branches branches;
    for (;;) {
        while (step(state, branches, sampler, first, firstDistance)) {
        }
        if (branches.waiting.empty()) return;
        const LayeredRadiance sum = state.radiance;
        state = branches.waiting.back();
        branches.waiting.pop_back();
        state.radiance = sum;
    }
}

LayeredRadiance Walk::fromEye(const WalkRay& ray, Sampler& sampler, FirstHit* first, StringSums* strings) noexcept {
    State state;
    state.ray = ray;
    state.radiance.strings = strings;
    run(state, sampler, first, nullptr);
    return state.radiance;
}

Rgb Walk::gather(const WalkRay& ray, Sampler& sampler, float& distance) noexcept {
    State state;
    state.ray = ray;
    state.gathering = true;
    state.skipDirect = true;
    state.behind = context_.maps.causticsApart() ? Behind::CausticMapped : Behind::PathTraced;
    state.ledger.pass(kDiffuse);
    run(state, sampler, nullptr, &distance);
    return state.radiance.total();
}

GatherPoint Walk::findGatherPoint(const WalkRay& start, Sampler& sampler, GatherStop stop,
                                  std::vector<GatherPoint>* beyond) {
    State state;
    state.ray = start;
    GatherPoint first;
    for (std::size_t more = 0;;) {
        const std::uint64_t dimension =
            kFirstDimension + kDimensionsPerVertex * static_cast<std::uint64_t>(state.vertices);
        sampler.setDimension(dimension + kCoin);
        ++rays_;
        const auto hit = context_.scene.intersect(state.ray.ray, holes_ ? sampler.next1D() : 0.0F);
        if (!hit || ++state.vertices > kMostOnTheWay) return first;
        state.pathLength += hit->distance;
        const glm::vec3 wo = -state.ray.ray.direction;
        if (wavelength::isDue(context_.scene, hit->point, state.wave)) takeWavelength(state, sampler);
        const Bsdf bsdf = context_.scene.surfaces().bsdf(hit->point, wo, state.wave);
        const float footprint = state.ray.footprintAtOrigin + state.ray.footprintSpread * state.pathLength;
        const Vertex vertex{*hit, bsdf, wo, footprint, glm::vec3(0.0F)};
        const bool byChance = stop == GatherStop::ByChance;
        sampler.setDimension(dimension + kLobeChoice);
        const auto onward = choose(vertex, byChance ? bsdf.kinds() : kSpecular | kGlossy, sampler);
        const bool ends = !onward || onward->kind == kDiffuse;
        if ((bsdf.kinds() & kDiffuse) != kNoLobe && (ends || !byChance)) {
            const GatherPoint here{
                true,      hit->point.position,  bsdf.shadingNormal(), bsdf.geometricNormal(), bsdf.unmappedNormal(),
                footprint, state.ray.absorption, bsdf.diffuse()};
            if (!first.valid)
                first = here;
            else
                beyond->push_back(here);
            if (beyond == nullptr || more++ == kMostBeyond) return first;
        }
        if (ends) return first;
        leave(state, vertex, *onward);
    }
}

}  // namespace pellucid

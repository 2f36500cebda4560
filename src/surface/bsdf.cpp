#include <pellucid/surface/bsdf.h>

#include <algorithm>
#include <cassert>

#include <pellucid/math/constants.h>
#include <pellucid/surface/lobes.h>

namespace pellucid {

namespace {

/// std::visit without the wrapping that keeps compilers from holding the results in registers.
template <typename Function>
inline void visitModel(const Lobe& lobe, const Function& function) noexcept {
    if (const auto* diffuse = std::get_if<DiffuseLobe>(&lobe.model)) return function(*diffuse);
    if (const auto* coat = std::get_if<CoatLobe>(&lobe.model)) return function(*coat);
    if (const auto* conductor = std::get_if<ConductorLobe>(&lobe.model)) return function(*conductor);
    return function(*std::get_if<DielectricLobe>(&lobe.model));
}

}  // namespace

Bsdf::Bsdf(const Frame& frame, const glm::vec3& geometricNormal, bool backSide, bool bordersVolume) noexcept
    : frame_(frame),
      geometricNormal_(geometricNormal),
      unmappedNormal_(frame.normal),
      backSide_(backSide),
      bordersVolume_(bordersVolume) {}

void Bsdf::add(const Lobe& lobe, const glm::vec3& wo) noexcept {
    assert(count_ < kMaxLobes);
    if (!(lobe.weight > 0.0F)) return;
    if (const auto* diffuse = std::get_if<DiffuseLobe>(&lobe.model)) {
        if (isBlack(diffuse->reflectance)) return;
        diffuse_ = {lobe.weight * diffuse->reflectance, diffuse->a, diffuse->b};
    }
    Lobe& added = lobes_[static_cast<std::size_t>(count_++)];
    added = lobe;
    const glm::vec3 local = frame_.toLocal(wo);
    visitModel(lobe, [&](const auto& model) { added.probability = lobe.weight * estimateAlbedo(model, local); });
    kinds_ = kinds_ | lobe.kind;
    connects_ = connects_ || !lobe.delta;
}

float Bsdf::totalProbability(LobeKinds kinds) const noexcept {
    float sum = 0.0F;
    for (int i = 0; i < count_; ++i) {
        const Lobe& lobe = lobes_[static_cast<std::size_t>(i)];
        if ((lobe.kind & kinds) != kNoLobe) sum += lobe.probability;
    }
    return sum;
}

float Bsdf::albedo(LobeKinds kinds) const noexcept { return std::min(1.0F, totalProbability(kinds)); }

/// Light must not pass where the shading normal says reflection and the geometry transmission. [Veach1997, sec. 5.3]
bool Bsdf::sameSide(const glm::vec3& local, const glm::vec3& world) const noexcept {
    return local.z * glm::dot(world, geometricNormal_) > 0.0F;
}

void Bsdf::evaluateLocal(const glm::vec3& wo, const glm::vec3& wi, LobeKinds kinds, TransportMode mode,
                         BsdfValue& sum) const noexcept {
    Rgb value{0.0F};
    float pdf = 0.0F, total = 0.0F;
    for (int i = 0; i < count_; ++i) {
        const Lobe& lobe = lobes_[static_cast<std::size_t>(i)];
        if ((lobe.kind & kinds) == kNoLobe) continue;
        total += lobe.probability;
        if (lobe.delta) continue;
        visitModel(lobe, [&](const auto& model) {
            const LobeValue part = evaluateLobe(model, wo, wi, mode);
            value += lobe.weight * part.value;
            pdf += lobe.probability * part.pdfSolidAngle;
        });
    }
    sum.value = value;
    sum.pdfSolidAngle = total > 0.0F ? pdf / total : 0.0F;
}

BsdfValue Bsdf::evaluate(const glm::vec3& wo, const glm::vec3& wi, LobeKinds kinds, TransportMode mode) const noexcept {
    BsdfValue sum;
    if ((kinds_ & kinds) == kNoLobe) return sum;
    const glm::vec3 localO = frame_.toLocal(wo), localI = frame_.toLocal(wi);
    if (localO.z > 0.0F && sameSide(localO, wo) && sameSide(localI, wi))
        evaluateLocal(localO, localI, kinds, mode, sum);
    return sum;
}

Rgb Bsdf::eval(const glm::vec3& wo, const glm::vec3& wi, LobeKinds kinds, TransportMode mode) const noexcept {
    return evaluate(wo, wi, kinds, mode).value;
}

float Bsdf::pdf(const glm::vec3& wo, const glm::vec3& wi, LobeKinds kinds) const noexcept {
    return evaluate(wo, wi, kinds, TransportMode::Flux).pdfSolidAngle;
}

/// `below` receives the probability of the lobes before the chosen one.
const Lobe* Bsdf::pickLobe(LobeKinds kinds, float target, float& below) const noexcept {
    const Lobe* chosen = nullptr;
    for (int i = 0; i < count_; ++i) {
        const Lobe& lobe = lobes_[static_cast<std::size_t>(i)];
        if ((lobe.kind & kinds) == kNoLobe) continue;
        if (chosen != nullptr) below += chosen->probability;
        chosen = &lobe;
        if (target < below + lobe.probability) break;
    }
    return chosen;
}

std::optional<BsdfSample> Bsdf::sample(const glm::vec3& wo, float choose, const glm::vec2& u, LobeKinds kinds,
                                       TransportMode mode) const noexcept {
    const float total = totalProbability(kinds);
    const glm::vec3 local = frame_.toLocal(wo);
    if (!(total > 0.0F) || !(local.z > 0.0F) || !sameSide(local, wo)) return std::nullopt;

    float below = 0.0F;
    const float target = choose * total;
    const Lobe* const chosen = pickLobe(kinds, target, below);
    const float rest = std::clamp((target - below) / chosen->probability, 0.0F, kOneMinusEpsilon);
    LobeDirection direction;
    bool goesOn = false;
    visitModel(*chosen, [&](const auto& model) { goesOn = sampleLobe(model, local, rest, u, mode, direction); });
    if (!goesOn) return std::nullopt;

    std::optional<BsdfSample> made(std::in_place);
    BsdfSample& result = *made;
    result.wi = frame_.toWorld(direction.wi);
    if (!sameSide(direction.wi, result.wi)) return std::nullopt;
    result.kind = chosen->kind;
    result.delta = chosen->delta;
    result.transmitted = direction.wi.z < 0.0F;
    result.etaScale = direction.etaScale;
    if (chosen->delta) {
        result.weight = direction.weight * (chosen->weight * total / chosen->probability);
        return made;
    }
    // The value at the direction as callers will see it, after its turn into the scene's space.
    BsdfValue value;
    evaluateLocal(local, frame_.toLocal(result.wi), kinds, mode, value);
    if (!(value.pdfSolidAngle > 0.0F)) return std::nullopt;
    result.pdfSolidAngle = value.pdfSolidAngle;
    result.weight = value.value / value.pdfSolidAngle;
    return made;
}

DeltaBranches Bsdf::deltaBranches(const glm::vec3& wo, TransportMode mode) const noexcept {
    DeltaBranches found;
    const glm::vec3 local = frame_.toLocal(wo);
    if (!(local.z > 0.0F) || !sameSide(local, wo)) return found;
    const auto add = [&](const Lobe& lobe, const LobeDirection& direction, float chance) {
        const glm::vec3 world = frame_.toWorld(direction.wi);
        const Rgb weight = direction.weight * (lobe.weight * chance);
        if (isBlack(weight) || !sameSide(direction.wi, world)) return;
        found.branch[static_cast<std::size_t>(found.count++)] = {
            world, weight, 0.0F, lobe.kind, true, direction.wi.z < 0.0F, direction.etaScale};
    };
    for (int i = 0; i < count_; ++i) {
        const Lobe& lobe = lobes_[static_cast<std::size_t>(i)];
        if (!lobe.delta) continue;
        visitModel(lobe, [&](const auto& model) {
            const float reflected = deltaReflectionChance(model, local);
            for (const bool reflect : {true, false}) {
                const float chance = reflect ? reflected : 1.0F - reflected;
                LobeDirection direction;
                if (reflect ? reflected <= 0.0F : reflected > kOneMinusEpsilon) continue;
                if (sampleLobe(model, local, reflect ? 0.0F : kOneMinusEpsilon, glm::vec2(0.5F), mode, direction))
                    add(lobe, direction, chance);
            }
        });
    }
    return found;
}

/// The share of the lobes that are no delta lobes, and whether one of them lets light through.
struct Bsdf::BlindShare {
    float probability = 0.0F;
    bool bothSides = false;

    [[nodiscard]] float pdf(float z, Directions directions) const noexcept {
        if (z < 0.0F && !bothSides) return 0.0F;
        const float side = directions == Directions::Cosine ? pdfSolidAngleCosineHemisphere({0.0F, 0.0F, std::fabs(z)})
                                                            : 0.5F * kInvPi;
        return probability * side * (bothSides ? 0.5F : 1.0F);
    }
};

Bsdf::BlindShare Bsdf::blindShare(LobeKinds kinds) const noexcept {
    BlindShare share;
    const float total = totalProbability(kinds);
    for (int i = 0; i < count_; ++i) {
        const Lobe& lobe = lobes_[static_cast<std::size_t>(i)];
        if ((lobe.kind & kinds) == kNoLobe || lobe.delta) continue;
        share.probability += lobe.probability / total;
        share.bothSides = share.bothSides || std::holds_alternative<DielectricLobe>(lobe.model);
    }
    return share;
}

float Bsdf::pdf(const glm::vec3& wo, const glm::vec3& wi, LobeKinds kinds, Directions directions) const noexcept {
    if (directions == Directions::Bsdf) return pdf(wo, wi, kinds);
    const glm::vec3 localI = frame_.toLocal(wi);
    return (kinds_ & kinds) != kNoLobe && sameSide(localI, wi) ? blindShare(kinds).pdf(localI.z, directions) : 0.0F;
}

std::optional<BsdfSample> Bsdf::sample(const glm::vec3& wo, float choose, const glm::vec2& u, LobeKinds kinds,
                                       TransportMode mode, Directions directions) const noexcept {
    float below = 0.0F;
    const Lobe* const chosen = pickLobe(kinds, choose * totalProbability(kinds), below);
    if (directions == Directions::Bsdf || chosen == nullptr || chosen->delta) return sample(wo, choose, u, kinds, mode);
    const BlindShare share = blindShare(kinds);
    glm::vec2 v = u;
    const bool behind = share.bothSides && v.x >= 0.5F;
    if (share.bothSides) v.x = std::min(2.0F * v.x - (behind ? 1.0F : 0.0F), kOneMinusEpsilon);
    glm::vec3 local = directions == Directions::Cosine ? sampleCosineHemisphere(v) : sampleUniformHemisphere(v);
    if (behind) local.z = -local.z;
    std::optional<BsdfSample> made(std::in_place);
    made->wi = frame_.toWorld(local);
    made->pdfSolidAngle = pdf(wo, made->wi, kinds, directions);
    if (!(made->pdfSolidAngle > 0.0F)) return std::nullopt;
    made->weight = eval(wo, made->wi, kinds, mode) / made->pdfSolidAngle;
    made->kind = chosen->kind;
    made->transmitted = local.z < 0.0F;
    return made;
}

}  // namespace pellucid

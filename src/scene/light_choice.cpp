#include "light_choice.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <pellucid/math/constants.h>

#include "light_sampling.h"

namespace pellucid {

namespace {

constexpr std::size_t kFewLights = 16;
/// Part of the probability that is spread evenly over the lights that can reach the point: the estimates know neither
/// textures nor shadows.
constexpr float kDefensive = 0.1F;

bool isInfinite(LightKind kind) noexcept { return kind == LightKind::Directional || kind == LightKind::Environment; }

double strengthOf(const Lights::Parts& parts, const LightEntry& entry) noexcept {
    switch (entry.kind) {
        case LightKind::Point:
            return static_cast<double>(average(parts.points[entry.index].intensity));
        case LightKind::Spot:
            return static_cast<double>(average(parts.spots[entry.index].intensity));
        case LightKind::Directional:
            return static_cast<double>(average(parts.directionals[entry.index].irradiance));
        case LightKind::Environment:
            return kPiD * static_cast<double>(average(parts.environment->meanRadiance()));
        case LightKind::Triangle: {
            const EmissiveTriangle& t = parts.triangles[entry.index];
            return static_cast<double>(average(t.meanRadiance)) * static_cast<double>(t.area);
        }
    }
    return 0.0;
}

LightBounds boundsOf(const Lights::Parts& parts, const LightEntry& entry, double strength) noexcept {
    LightBounds bounds;
    bounds.strength = strength;
    bounds.emission = 0.5 * kPiD;
    if (entry.kind == LightKind::Triangle) {
        const EmissiveTriangle& t = parts.triangles[entry.index];
        for (const glm::vec3& corner : t.corner) bounds.box.extend(corner);
        bounds.axis = t.normal;
        bounds.twoSided = t.twoSided;
    } else if (entry.kind == LightKind::Spot) {
        const SpotEmitter& spot = parts.spots[entry.index];
        bounds.box.extend(spot.position);
        bounds.axis = spot.direction;
        bounds.spread = std::acos(std::clamp(static_cast<double>(spot.cosInner), -1.0, 1.0));
        bounds.emission = std::acos(std::clamp(static_cast<double>(spot.cosOuter), -1.0, 1.0)) - bounds.spread;
    } else {
        bounds.box.extend(parts.points[entry.index].position);
        bounds.spread = kPiD;
    }
    return bounds;
}

bool hasHorizon(const glm::vec3& normal) noexcept { return normal != glm::vec3(0.0F); }

/// Irradiance from a point of unit intensity: cos / d^2.
float pointWeight(const glm::vec3& to, const glm::vec3& normal) noexcept {
    const float distance2 = glm::dot(to, to);
    if (!(distance2 > kMinDistance2)) return 0.0F;
    if (!hasHorizon(normal)) return 1.0F / distance2;
    const float height = glm::dot(normal, to);
    return height > 0.0F ? height / (distance2 * std::sqrt(distance2)) : 0.0F;
}

/// About the irradiance from a triangle of unit radiance times area: cos cos / d^2 with the distance kept above the
/// size of the triangle and the cosines softened accordingly. Zero exactly where no light can arrive: behind a
/// one-sided triangle, or with all corners below the horizon.
/// Written without early exits: shading points differ from call to call, and a branch mispredicted costs more than all this.
float triangleWeight(const EmissiveTriangle& t, const glm::vec3& point, const glm::vec3& normal) noexcept {
    const glm::vec3 to[3] = {t.corner[0] - point, t.corner[1] - point, t.corner[2] - point};
    const float height = -glm::dot(t.normal, to[0]);
    const float shining = t.twoSided ? std::fabs(height) : std::max(height, 0.0F);
    const glm::vec3 centre = (to[0] + to[1] + to[2]) * (1.0F / 3.0F);
    const float distance2 = std::max(glm::dot(centre, centre), t.area * kInvPi);
    const float inverse = 1.0F / std::sqrt(distance2);
    const float cosLight = std::min(1.0F, (shining + 0.25F * t.area * inverse) * inverse);
    const float above = std::max(0.0F, glm::dot(normal, to[0])) + std::max(0.0F, glm::dot(normal, to[1])) +
                        std::max(0.0F, glm::dot(normal, to[2]));
    const float cosReceived = hasHorizon(normal) ? std::min(1.0F, above * (1.0F / 3.0F) * inverse) : 1.0F;
    const bool dark = !t.twoSided & (height <= 0.0F);
    return dark ? 0.0F : cosLight * cosReceived * inverse * inverse;
}

}  // namespace

/// The estimates of the flat list. The first kFewLights are kept, any beyond (very many lights at infinity) computed
/// anew.
struct LightChoice::Weights {
    std::array<float, kFewLights> kept;
    float sum = 0.0F;
    float scale = 0.0F, floor = 0.0F;  ///< probability = scale * weight + floor where the weight is positive

    [[nodiscard]] float probability(float weight) const noexcept {
        return weight > 0.0F ? scale * weight + floor : 0.0F;
    }
};

LightChoice::LightChoice(const Lights::Parts& parts, const std::vector<LightEntry>& entries) : parts_(&parts) {
    double strongest = 0.0;
    for (const LightEntry& entry : entries) strongest = std::max(strongest, strengthOf(parts, entry));
    std::vector<LightBounds> bounds;
    const bool few = entries.size() <= kFewLights;
    for (const LightEntry& entry : entries) {
        const double strength = strengthOf(parts, entry) / strongest;
        if (few || isInfinite(entry.kind))
            flat_.push_back({entry.kind, entry.index, static_cast<float>(strength)});
        else
            bounds.push_back(boundsOf(parts, entry, strength));
    }
    firstFlat_ = static_cast<std::uint32_t>(bounds.size());
    tree_ = LightTree(bounds);
}

float LightChoice::weight(const Candidate& candidate, const glm::vec3& point, const glm::vec3& normal) const noexcept {
    switch (candidate.kind) {
        case LightKind::Point:
            return candidate.strength * pointWeight(parts_->points[candidate.index].position - point, normal);
        case LightKind::Spot: {
            const SpotEmitter& spot = parts_->spots[candidate.index];
            const glm::vec3 to = spot.position - point;
            const float seen = pointWeight(to, normal);
            if (seen == 0.0F) return 0.0F;
            return candidate.strength * seen * spotFalloff(spot, -glm::dot(spot.direction, glm::normalize(to)));
        }
        case LightKind::Directional: {
            if (!hasHorizon(normal)) return candidate.strength;
            return candidate.strength *
                   std::max(0.0F, -glm::dot(normal, parts_->directionals[candidate.index].direction));
        }
        case LightKind::Triangle:
            return candidate.strength * triangleWeight(parts_->triangles[candidate.index], point, normal);
        case LightKind::Environment:
            return candidate.strength;
    }
    return 0.0F;
}

LightChoice::Weights LightChoice::weigh(const glm::vec3& point, const glm::vec3& normal) const noexcept {
    Weights weights;
    int positive = 0;
    for (std::size_t i = 0; i < flat_.size(); ++i) {
        const float w = weight(flat_[i], point, normal);
        if (i < kFewLights) weights.kept[i] = w;
        weights.sum += w;
        positive += w > 0.0F ? 1 : 0;
    }
    if (weights.sum > 0.0F) {
        weights.scale = (1.0F - kDefensive) / weights.sum;
        weights.floor = kDefensive / static_cast<float>(positive);
    }
    return weights;
}

float LightChoice::flatShare(float flatSum, const glm::vec3& point, const glm::vec3& normal) const noexcept {
    if (tree_.empty()) return 1.0F;
    if (!(flatSum > 0.0F)) return 0.0F;
    const float treeSum = tree_.importance(point, normal);
    if (!(treeSum > 0.0F)) return 1.0F;
    return std::clamp(flatSum / (flatSum + treeSum), 0.2F, 0.8F);
}

std::optional<LightPick> LightChoice::choose(const glm::vec3& point, const glm::vec3& normal, double u) const noexcept {
    const Weights weights = weigh(point, normal);
    const float share = flatShare(weights.sum, point, normal);
    if (u >= static_cast<double>(share) || !(weights.sum > 0.0F)) {
        const double remapped = (u - static_cast<double>(share)) / (1.0 - static_cast<double>(share));
        const auto choice = share < 1.0F ? tree_.choose(point, normal, std::max(0.0, remapped)) : std::nullopt;
        if (!choice) return std::nullopt;
        return LightPick{choice->light, (1.0F - share) * static_cast<float>(choice->pmf), choice->left};
    }
    const double target = u / static_cast<double>(share);
    double passed = 0.0;
    LightPick last;
    for (std::size_t i = 0; i < flat_.size(); ++i) {
        const float p = weights.probability(i < kFewLights ? weights.kept[i] : weight(flat_[i], point, normal));
        if (!(p > 0.0F)) continue;
        const double mine = (target - passed) / static_cast<double>(p);
        last = {firstFlat_ + static_cast<std::uint32_t>(i), p * share, std::clamp(mine, 0.0, kLargestBelowOne)};
        passed += static_cast<double>(p);
        if (target < passed) break;
    }
    return last;
}

float LightChoice::pmf(std::uint32_t light, const glm::vec3& point, const glm::vec3& normal) const noexcept {
    const Weights weights = weigh(point, normal);
    const float share = flatShare(weights.sum, point, normal);
    if (light < firstFlat_) return (1.0F - share) * static_cast<float>(tree_.pmf(light, point, normal));
    if (!(weights.sum > 0.0F)) return 0.0F;
    const std::size_t i = light - firstFlat_;
    return weights.probability(i < kFewLights ? weights.kept[i] : weight(flat_[i], point, normal)) * share;
}

}  // namespace pellucid

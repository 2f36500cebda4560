// Emission from lights: where light paths start, and with which densities.
#include <algorithm>
#include <cmath>

#include <pellucid/math/frame.h>
#include <pellucid/math/warps.h>

#include "light_sampling.h"
#include "lights_impl.h"

namespace pellucid {

EmissionPdf Lights::pdfEmission(std::uint32_t light, const glm::vec3& direction) const noexcept {
    const LightEntry& entry = impl_->entries[light];
    const Parts& parts = impl_->parts;
    const auto pmf = static_cast<float>(impl_->byPower.pmf(light)), disc = static_cast<float>(impl_->discArea());
    switch (entry.kind) {
        case LightKind::Point:
            return {pmf, pdfSolidAngleUniformSphere()};
        case LightKind::Spot: {
            const SpotEmitter& spot = parts.spots[entry.index];
            return {pmf, spotFalloff(spot, glm::dot(spot.direction, direction)) /
                             static_cast<float>(spotSolidAngle(spot).total())};
        }
        case LightKind::Triangle: {
            const EmissiveTriangle& t = parts.triangles[entry.index];
            const float cosine = glm::dot(t.normal, direction);
            if (!t.twoSided && cosine <= 0.0F) return {pmf / t.area, 0.0F};
            return {pmf / t.area, std::fabs(cosine) * kInvPi * (t.twoSided ? 0.5F : 1.0F)};
        }
        case LightKind::Directional:
            return {pmf / disc, 1.0F};
        case LightKind::Environment:
            return {pmf / disc, parts.environment->pdf(-direction)};
    }
    return {};
}

void Lights::Impl::emitFromPunctual(const LightEntry& entry, const glm::vec2& u, EmissionSample& e) const noexcept {
    e.pdfPosition = 1.0F;
    e.delta = true;
    if (entry.kind == LightKind::Point) {
        const PointEmitter& light = parts.points[entry.index];
        e.ray = {light.position, sampleUniformSphere(u)};
        e.pdfDirection = pdfSolidAngleUniformSphere();
        e.flux = light.intensity * (4.0F * kPi);
        return;
    }
    const SpotEmitter& light = parts.spots[entry.index];
    const float cosine = sampleSpotCosine(light, u.y), phi = kTwoPi * u.x;
    const float sine = std::sqrt(std::max(0.0F, (1.0F - cosine) * (1.0F + cosine)));
    e.ray = {light.position,
             glm::normalize(Frame(light.direction).toWorld({sine * std::cos(phi), sine * std::sin(phi), cosine}))};
    const auto solidAngle = static_cast<float>(spotSolidAngle(light).total());
    e.pdfDirection = spotFalloff(light, cosine) / solidAngle;
    e.flux = light.intensity * solidAngle;
}

/// Uniform over the area, cosine-weighted; a two-sided triangle gives each side half of the first direction number.
void Lights::Impl::emitFromTriangle(const EmissiveTriangle& t, const glm::vec2& position, const glm::vec2& direction,
                                    EmissionSample& e) const noexcept {
    glm::vec2 u = direction;
    glm::vec3 normal = t.normal;
    if (t.twoSided) {
        const bool back = u.x >= 0.5F;
        u.x = std::min(2.0F * u.x - (back ? 1.0F : 0.0F), kOneMinusEpsilon);
        if (back) normal = -normal;
    }
    const glm::vec3 local = sampleCosineHemisphere(u);
    if (!(local.z > 0.0F)) return;
    const glm::vec2 b = sampleUniformTriangle(position);
    const glm::vec3 point = (1.0F - b.x - b.y) * t.corner[0] + b.x * t.corner[1] + b.y * t.corner[2];
    const float sides = t.twoSided ? 2.0F : 1.0F;
    e.ray = {offsetOrigin(point, normal), glm::normalize(Frame(normal).toWorld(local))};
    e.pdfPosition = pdfAreaUniformTriangle(t.area);
    e.pdfDirection = pdfSolidAngleCosineHemisphere(local) / sides;
    e.flux = triangleRadiance(t, b, e.ray.direction) * (sides * kPi * t.area);
}

void Lights::Impl::emitFromInfinity(const LightEntry& entry, const glm::vec2& position, const glm::vec2& direction,
                                    EmissionSample& e) const noexcept {
    const auto area = static_cast<float>(discArea());
    if (entry.kind == LightKind::Directional) {
        const DirectionalEmitter& light = parts.directionals[entry.index];
        e.ray.direction = light.direction;
        e.pdfDirection = 1.0F;
        e.delta = true;
        e.flux = light.irradiance * area;
    } else {
        const auto from = parts.environment->sample(direction);
        if (!from || !(from->pdfSolidAngle > 0.0F)) return;
        e.ray.direction = -from->direction;
        e.pdfDirection = from->pdfSolidAngle;
        e.flux = parts.environment->radiance(from->direction) * (area / from->pdfSolidAngle);
    }
    const glm::vec2 disc = parts.sceneRadius * sampleUniformDisc(position);
    const Frame frame(e.ray.direction);
    e.ray.origin = parts.sceneCentre + frame.tangent * disc.x + frame.bitangent * disc.y -
                   2.0F * parts.sceneRadius * e.ray.direction;
    e.pdfPosition = 1.0F / area;
}

std::optional<EmissionSample> Lights::sampleEmission(const EmissionNumbers& u) const noexcept {
    if (!(totalPower() > 0.0)) return std::nullopt;
    const auto light = static_cast<std::uint32_t>(impl_->byPower.sample(static_cast<double>(u.chooseLight)).index);
    auto emission = sampleEmissionFrom(light, u.position, u.direction);
    if (!emission) return std::nullopt;
    emission->pmfLight = static_cast<float>(impl_->byPower.pmf(light));
    emission->flux /= emission->pmfLight;
    return emission;
}

std::optional<EmissionSample> Lights::sampleEmissionFrom(std::uint32_t light, const glm::vec2& position,
                                                         const glm::vec2& direction) const noexcept {
    const LightEntry& entry = impl_->entries[light];
    EmissionSample e;
    e.light = light;
    e.pmfLight = 1.0F;
    switch (entry.kind) {
        case LightKind::Point:
        case LightKind::Spot:
            impl_->emitFromPunctual(entry, direction, e);
            break;
        case LightKind::Triangle:
            impl_->emitFromTriangle(impl_->parts.triangles[entry.index], position, direction, e);
            break;
        case LightKind::Directional:
        case LightKind::Environment:
            impl_->emitFromInfinity(entry, position, direction, e);
            break;
    }
    return isFinite(e.flux) && !isBlack(e.flux) ? std::optional(e) : std::nullopt;
}

}  // namespace pellucid

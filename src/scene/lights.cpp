#include <pellucid/scene/lights.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <pellucid/math/constants.h>
#include <pellucid/math/distribution.h>
#include <pellucid/math/frame.h>
#include <pellucid/math/warps.h>

#include "light_choice.h"
#include "light_list.h"
#include "light_sampling.h"

namespace pellucid {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool belowHorizon(const glm::vec3& normal, const glm::vec3& wi) noexcept {
    return normal != glm::vec3(0.0F) && glm::dot(normal, wi) <= 0.0F;
}

}  // namespace

struct Lights::Impl {
    Parts parts;
    TriangleRadiance radiance;
    const void* scene;
    std::vector<LightEntry> entries;
    LightChoice choice;
    TriangleLookup lookup;
    std::vector<double> powers;
    Distribution1D byPower;

    [[nodiscard]] Rgb triangleRadiance(const EmissiveTriangle& t, const glm::vec2& barycentric,
                                       const glm::vec3& wo) const {
        if (!t.twoSided && glm::dot(t.normal, wo) <= 0.0F) return Rgb(0.0F);
        return radiance != nullptr ? radiance(scene, t.geometry, t.primitive, barycentric, wo) : t.meanRadiance;
    }

    /// Photons from infinity cross this disc. Seen along any direction it covers the scene's bounding sphere.
    [[nodiscard]] double discArea() const noexcept {
        return kPiD * static_cast<double>(parts.sceneRadius) * static_cast<double>(parts.sceneRadius);
    }

    [[nodiscard]] double powerOf(const LightEntry& entry) const noexcept;
    void towardsPunctual(const LightEntry& entry, const glm::vec3& point, LightSample& sample) const noexcept;
    void towardsTriangle(const EmissiveTriangle& t, const glm::vec3& point, const glm::vec2& u,
                         LightSample& sample) const noexcept;
    void towardsEnvironment(const glm::vec2& u, LightSample& sample) const noexcept;
    void emitFromPunctual(const LightEntry& entry, const glm::vec2& u, EmissionSample& e) const noexcept;
    void emitFromTriangle(const EmissiveTriangle& t, const glm::vec2& position, const glm::vec2& direction,
                          EmissionSample& e) const noexcept;
    void emitFromInfinity(const LightEntry& entry, const glm::vec2& position, const glm::vec2& direction,
                          EmissionSample& e) const noexcept;
};

Lights::Lights(Parts parts, TriangleRadiance radiance, const void* scene) : impl_(std::make_unique<Impl>()) {
    dropDark(parts);
    Impl& d = *impl_;
    d.parts = std::move(parts);
    d.radiance = radiance;
    d.scene = scene;
    d.entries = listLights(d.parts);
    d.choice = LightChoice(d.parts, d.entries);
    d.lookup =
        TriangleLookup(d.parts.triangles, static_cast<std::uint32_t>(d.parts.points.size() + d.parts.spots.size()));
    for (const LightEntry& entry : d.entries) d.powers.push_back(d.powerOf(entry));
    d.byPower = Distribution1D(d.powers);
}

Lights::~Lights() = default;
Lights::Lights(Lights&&) noexcept = default;
Lights& Lights::operator=(Lights&&) noexcept = default;

std::size_t Lights::count() const noexcept { return impl_->entries.size(); }
LightKind Lights::kind(std::uint32_t light) const noexcept { return impl_->entries[light].kind; }
double Lights::power(std::uint32_t light) const noexcept { return impl_->powers[light]; }
double Lights::totalPower() const noexcept { return impl_->byPower.total(); }

/// The mean of the three channels: point 4 pi I; spot I times the integral of its falloff; triangle pi A L a side;
/// directional pi R^2 E; environment pi R^2 times the integral of L over directions.
double Lights::Impl::powerOf(const LightEntry& entry) const noexcept {
    const auto mean = [](const Rgb& c) { return static_cast<double>(average(c)); };
    switch (entry.kind) {
        case LightKind::Point:
            return 4.0 * kPiD * mean(parts.points[entry.index].intensity);
        case LightKind::Spot: {
            const SpotEmitter& spot = parts.spots[entry.index];
            return spotSolidAngle(spot).total() * mean(spot.intensity);
        }
        case LightKind::Directional:
            return discArea() * mean(parts.directionals[entry.index].irradiance);
        case LightKind::Triangle: {
            const EmissiveTriangle& t = parts.triangles[entry.index];
            return (t.twoSided ? 2.0 : 1.0) * kPiD * static_cast<double>(t.area) * mean(t.meanRadiance);
        }
        case LightKind::Environment:
            return discArea() * 4.0 * kPiD * mean(parts.environment->meanRadiance());
    }
    return 0.0;
}

void Lights::Impl::towardsPunctual(const LightEntry& entry, const glm::vec3& point,
                                   LightSample& sample) const noexcept {
    sample.delta = true;
    if (entry.kind == LightKind::Directional) {
        const DirectionalEmitter& light = parts.directionals[entry.index];
        sample.wi = -light.direction;
        sample.distance = kInfinity;
        sample.radiance = light.irradiance;
        return;
    }
    const bool isSpot = entry.kind == LightKind::Spot;
    const glm::vec3 to = (isSpot ? parts.spots[entry.index].position : parts.points[entry.index].position) - point;
    const float distance2 = glm::dot(to, to);
    if (!(distance2 > kMinDistance2)) return;
    sample.distance = std::sqrt(distance2);
    sample.wi = to / sample.distance;
    sample.radiance = (isSpot ? parts.spots[entry.index].intensity : parts.points[entry.index].intensity) / distance2;
    if (isSpot)
        sample.radiance *=
            spotFalloff(parts.spots[entry.index], -glm::dot(parts.spots[entry.index].direction, sample.wi));
}

void Lights::Impl::towardsTriangle(const EmissiveTriangle& t, const glm::vec3& point, const glm::vec2& u,
                                   LightSample& sample) const noexcept {
    const auto seen = sampleTriangle(t, point, u);
    if (!seen) return;
    sample.wi = seen->wi;
    sample.distance = seen->distance;
    sample.pdfSolidAngle *= seen->pdfSolidAngle;
    sample.radiance = triangleRadiance(t, seen->barycentric, -seen->wi);
}

void Lights::Impl::towardsEnvironment(const glm::vec2& u, LightSample& sample) const noexcept {
    const auto direction = parts.environment->sample(u);
    if (!direction) return;
    sample.wi = direction->direction;
    sample.distance = kInfinity;
    sample.pdfSolidAngle *= direction->pdfSolidAngle;
    sample.radiance = parts.environment->radiance(sample.wi);
}

std::optional<LightPick> Lights::choose(const glm::vec3& point, const glm::vec3& normal, float u) const noexcept {
    return impl_->choice.choose(point, normal, u);
}

std::optional<LightSample> Lights::sampleFrom(const LightPick& pick, const glm::vec3& point, const glm::vec3& normal,
                                              const glm::vec2& u) const noexcept {
    const LightEntry& entry = impl_->entries[pick.light];
    LightSample sample;
    sample.light = pick.light;
    sample.pdfSolidAngle = pick.pmf;
    if (entry.kind == LightKind::Triangle)
        impl_->towardsTriangle(impl_->parts.triangles[entry.index], point, u, sample);
    else if (entry.kind == LightKind::Environment)
        impl_->towardsEnvironment(u, sample);
    else
        impl_->towardsPunctual(entry, point, sample);
    const bool useful = !isBlack(sample.radiance) && isFinite(sample.radiance) && sample.pdfSolidAngle > 0.0F &&
                        std::isfinite(sample.pdfSolidAngle) && !belowHorizon(normal, sample.wi);
    return useful ? std::optional(sample) : std::nullopt;
}

std::optional<LightSample> Lights::sample(const glm::vec3& point, const glm::vec3& normal, float chooseLight,
                                          const glm::vec2& u) const noexcept {
    const auto pick = choose(point, normal, chooseLight);
    return pick ? sampleFrom(*pick, point, normal, u) : std::nullopt;
}

std::optional<LightSample> Lights::towardsEnvironment(const LightPick& sky, const glm::vec3& normal,
                                                      const glm::vec3& wi) const noexcept {
    LightSample sample;
    sample.light = sky.light;
    sample.wi = wi;
    sample.distance = kInfinity;
    sample.radiance = impl_->parts.environment->radiance(wi);
    sample.pdfSolidAngle = sky.pmf * impl_->parts.environment->pdf(wi);
    const bool useful = !isBlack(sample.radiance) && isFinite(sample.radiance) && !belowHorizon(normal, wi);
    return useful ? std::optional(sample) : std::nullopt;
}

float Lights::choicePmf(std::uint32_t light, const glm::vec3& point, const glm::vec3& normal) const noexcept {
    return impl_->choice.pmf(light, point, normal);
}

float Lights::pdfTriangle(const glm::vec3& point, const glm::vec3& normal, std::uint32_t geometry,
                          std::uint32_t primitive, const glm::vec3& wi, float distance) const noexcept {
    const std::uint32_t light = impl_->lookup.find(geometry, primitive);
    if (light == kNoLight || belowHorizon(normal, wi)) return 0.0F;
    const EmissiveTriangle& t = impl_->parts.triangles[impl_->entries[light].index];
    if (!t.twoSided && glm::dot(t.normal, wi) >= 0.0F) return 0.0F;
    const float pdf = impl_->choice.pmf(light, point, normal) * pdfTriangleSolidAngle(t, point, wi, distance);
    return std::isfinite(pdf) ? pdf : 0.0F;
}

float Lights::pdfEnvironment(const glm::vec3& point, const glm::vec3& normal, const glm::vec3& wi) const noexcept {
    if (impl_->parts.environment == nullptr || belowHorizon(normal, wi)) return 0.0F;
    const auto light = static_cast<std::uint32_t>(impl_->entries.size() - 1);
    return impl_->choice.pmf(light, point, normal) * impl_->parts.environment->pdf(wi);
}

std::uint32_t Lights::lightOf(std::uint32_t geometry, std::uint32_t primitive) const noexcept {
    return impl_->lookup.find(geometry, primitive);
}

std::uint32_t Lights::environmentLight() const noexcept {
    return impl_->parts.environment == nullptr ? kNoLight : static_cast<std::uint32_t>(impl_->entries.size() - 1);
}

float Lights::pdfTowards(std::uint32_t light, const glm::vec3& point, const glm::vec3& normal, const glm::vec3& wi,
                         float distance) const noexcept {
    const LightEntry& entry = impl_->entries[light];
    if (entry.kind == LightKind::Environment) return pdfEnvironment(point, normal, wi);
    if (entry.kind != LightKind::Triangle) return belowHorizon(normal, wi) ? 0.0F : choicePmf(light, point, normal);
    const EmissiveTriangle& t = impl_->parts.triangles[entry.index];
    return pdfTriangle(point, normal, t.geometry, t.primitive, wi, distance);
}

float Lights::cosineAt(std::uint32_t light, const glm::vec3& direction) const noexcept {
    const LightEntry& entry = impl_->entries[light];
    if (entry.kind != LightKind::Triangle) return 1.0F;
    return std::fabs(glm::dot(impl_->parts.triangles[entry.index].normal, direction));
}

float Lights::etendueDensity(std::uint32_t light, const glm::vec3& direction) const noexcept {
    const LightKind what = kind(light);
    if (what != LightKind::Triangle && what != LightKind::Environment) return std::numeric_limits<float>::infinity();
    const EmissionPdf pdf = pdfEmission(light, direction);
    const float cosine = cosineAt(light, direction);
    return cosine > 0.0F ? pdf.position * pdf.direction / cosine : 0.0F;
}

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

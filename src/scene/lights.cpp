#include <pellucid/scene/lights.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "light_sampling.h"
#include "lights_impl.h"

namespace pellucid {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool belowHorizon(const glm::vec3& normal, const glm::vec3& wi) noexcept {
    return normal != glm::vec3(0.0F) && glm::dot(normal, wi) <= 0.0F;
}

}  // namespace

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

std::optional<LightPick> Lights::choose(const glm::vec3& point, const glm::vec3& normal, double u) const noexcept {
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

std::optional<LightSample> Lights::sample(const glm::vec3& point, const glm::vec3& normal, float fine,
                                          const glm::vec2& u) const noexcept {
    const auto pick = choose(point, normal, choiceNumber(fine, u));
    return pick ? sampleFrom(*pick, point, normal, pointNumbers(*pick, u)) : std::nullopt;
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

}  // namespace pellucid

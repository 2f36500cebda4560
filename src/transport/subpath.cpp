#include <pellucid/transport/subpath.h>

#include <cmath>
#include <limits>

#include "kind_choice.h"
#include "medium.h"
#include "roulette.h"
#include "wavelength.h"

namespace pellucid {

namespace {

/// A direction flatter than this has no density per area worth the name.
constexpr float kLeastCosine = 1e-7F;

[[nodiscard]] float cosine(const glm::vec3& a, const glm::vec3& b) noexcept { return std::fabs(glm::dot(a, b)); }

/// pdf(back) / pdf(onward) of a delta lobe: the inverse of how much it spreads solid angle. Snell: n^2 cos dw is kept.
[[nodiscard]] double deltaPdfRatio(const Scene& scene, const PathVertex& v, const BsdfSample& sample,
                                   Wave wave) noexcept {
    if (!sample.transmitted || !v.bsdf.bordersVolume()) return 1.0;
    const auto ior = static_cast<double>(scene.surfaces().relativeIor(v.hit.point, wave));
    const double eta = v.bsdf.backSide() ? 1.0 / ior : ior;
    const auto in = static_cast<double>(cosine(v.toPrevious, v.bsdf.shadingNormal()));
    const auto out = static_cast<double>(cosine(sample.wi, v.bsdf.shadingNormal()));
    const double ratio = in / (eta * eta * out);
    return std::isfinite(ratio) ? ratio : 1.0;
}

}  // namespace

void Subpath::begin(const Ray& ray, const Rgb& throughput) noexcept {
    vertices_.clear();
    ray_ = ray;
    throughput_ = throughput;
    absorption_ = Rgb(0.0F);
    etaScale_ = 1.0F;
    wave_ = {};
    mis_ = {};
    deltaChain_ = true;
    string_ = PathString();
}

void Subpath::startAtEye(const Camera& camera, const Ray& ray) noexcept {
    start_ = Start{};
    start_.camera = &camera;
    begin(ray, Rgb(1.0F));
}

bool Subpath::startAtLight(Sampler& sampler) noexcept {
    vertices_.clear();
    const float chooseLight = sampler.next1D();
    const glm::vec2 position = sampler.next2D(), direction = sampler.next2D();
    const auto e = scene_.lights().sampleEmission({chooseLight, position, direction});
    if (!e) return false;
    const LightKind kind = scene_.lights().kind(e->light);
    start_ = Start{nullptr,
                   e->light,
                   e->pmfLight * e->pdfPosition * e->pdfDirection,
                   scene_.lights().cosineAt(e->light, e->ray.direction),
                   e->delta,
                   kind == LightKind::Directional || kind == LightKind::Environment};
    begin(e->ray, e->flux);
    return true;
}

/// At the first surface. From the eye: N light paths may splat there, one eye path arrives with density importance x cos.
/// From a light: next-event estimation from here could have made the light's point, a path from here could have hit it.
MisSums Subpath::sumsAtFirst(const glm::vec3& point, const glm::vec3& horizon, float cosineHere,
                             float distance) const noexcept {
    if (from_ == From::Eye) {
        const double arrival =
            static_cast<double>(start_.camera->importance(ray_.direction, distance)) * static_cast<double>(cosineHere);
        return {rules_.power(static_cast<double>(rules_.lightPaths) / arrival), 0.0};
    }
    // Both techniques' densities over that of emission to here, per area; 1 / d^2 stands in all of them and cancels.
    const double arrival = static_cast<double>(start_.pdfEmission) * static_cast<double>(cosineHere);
    auto direct =
        static_cast<double>(scene_.lights().pdfTowards(start_.light, point, horizon, -ray_.direction, distance));
    direct *= start_.delta && !start_.infinite ? static_cast<double>(distance) * static_cast<double>(distance)
                                               : static_cast<double>(start_.cosine);
    return {rules_.power(direct / arrival),
            start_.delta ? 0.0 : rules_.power(static_cast<double>(start_.cosine) / arrival)};
}

bool Subpath::advance(float coin, Sampler& sampler) noexcept {
    const auto hit = scene_.intersect(ray_, coin);
    escaped_ = !hit;
    if (!hit) return false;
    const glm::vec3 back = -ray_.direction;
    if (wavelength::isDue(scene_, hit->point, wave_)) {
        sampler.setDimension(wavelength::kDimension + vertices_.size());
        throughput_ *= wavelength::choose(wave_, sampler);
    }
    const Bsdf bsdf = scene_.surfaces().bsdf(hit->point, back, wave_);
    absorption_ = medium::beforeHit(scene_, hit->point, bsdf, absorption_);
    throughput_ *= medium::transmittance(absorption_, hit->distance);
    const float arrival = cosine(back, bsdf.geometricNormal());
    if (!(arrival > kLeastCosine)) return false;
    const bool transmits = scene_.surfaces().materials()[hit->point.material].transmission > 0.0F;
    const glm::vec3 horizon = transmits ? glm::vec3(0.0F) : bsdf.geometricNormal();
    MisSums sums = mis_;
    if (vertices_.empty()) {
        sums = sumsAtFirst(hit->point.position, horizon, arrival, hit->distance);
    } else {
        const auto c = static_cast<double>(arrival), d = static_cast<double>(hit->distance);
        sums.connect *= rules_.power(d * d / c);
        sums.onward *= rules_.power(1.0 / c);
    }
    vertices_.push_back({*hit, bsdf, back, throughput_, absorption_, sums, horizon, string_});
    return true;
}

std::optional<VertexValue> Subpath::valueTowards(const PathVertex& v, const glm::vec3& direction) const noexcept {
    const bool behind = glm::dot(direction, v.bsdf.geometricNormal()) < 0.0F;
    if (behind && v.horizon != glm::vec3(0.0F)) return std::nullopt;
    const bool fromEye = from_ == From::Eye;
    // From the eye most directions are found black before the other side's view of the surface is needed.
    if (fromEye && isBlack(v.bsdf.eval(v.toPrevious, direction, kAllLobes, TransportMode::Radiance)))
        return std::nullopt;
    VertexValue value;
    const Bsdf other = scene_.surfaces().bsdf(v.hit.point, direction);
    const Bsdf& viewer = fromEye ? v.bsdf : other;
    const glm::vec3& wo = fromEye ? v.toPrevious : direction;
    const glm::vec3& wi = fromEye ? direction : v.toPrevious;
    const float scale = fromEye ? 1.0F : 1.0F / cosine(v.toPrevious, v.bsdf.geometricNormal());
    const LobeKinds kinds = viewer.kinds();
    const bool single = (kinds & (kinds - 1)) == 0;
    float viewerPdf = 0.0F;
    bool black = true;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto kind = static_cast<LobeKinds>(1U << k);
        if ((kinds & kind) == kNoLobe) continue;
        const BsdfValue part = viewer.evaluate(wo, wi, kind, TransportMode::Radiance);
        value.byKind[k] = part.value * scale;
        black = black && isBlack(part.value);
        if (single) viewerPdf = part.pdfSolidAngle;
    }
    if (black) return std::nullopt;
    if (!single) viewerPdf = viewer.pdf(wo, wi, kAllLobes);
    const float lampPdf = (fromEye ? other : v.bsdf).pdf(wi, wo, kAllLobes);
    value.pdfOnward = fromEye ? viewerPdf : lampPdf;
    value.pdfBack = fromEye ? lampPdf : viewerPdf;
    return value;
}

/// A delta lobe: nothing connects across it. A mirror that the other side would see in another shading frame is one that
/// paths from there cannot pass: no path from a light is, and the eye's has no partner.
bool Subpath::deltaStep(PathVertex& v, const BsdfSample& sample, const Bsdf& other, float cosOut) noexcept {
    const glm::vec3 &n = v.bsdf.shadingNormal(), &m = other.shadingNormal();
    const bool sameFrame = n == m || n == -m;
    throughput_ *= sample.weight;
    mis_ = {0.0, sameFrame ? v.mis.onward *
                                 rules_.power(static_cast<double>(cosOut) * deltaPdfRatio(scene_, v, sample, wave_))
                           : 0.0};
    v.passed = sample.kind;
    if (from_ == From::Eye) return true;
    const float shadingIn = cosine(v.toPrevious, n), geometricIn = cosine(v.toPrevious, v.bsdf.geometricNormal()),
                shadingOut = cosine(sample.wi, n);
    if (!sameFrame || !(shadingOut > 0.0F)) return false;
    throughput_ *= shadingIn / geometricIn * cosOut / shadingOut;
    return true;
}

bool Subpath::glossyStep(PathVertex& v, const BsdfSample& sample, float cosOut, float choose) noexcept {
    const auto value = valueTowards(v, sample.wi);
    if (!value) return false;
    const KindChoice choice = chooseKind(value->byKind, choose);
    if (choice.kind == kNoLobe) return false;
    throughput_ *=
        choice.value * (choice.total / choice.part) * ((from_ == From::Eye ? 1.0F : cosOut) / sample.pdfSolidAngle);
    const double out = static_cast<double>(cosOut) / static_cast<double>(sample.pdfSolidAngle);
    mis_.onward =
        rules_.power(out) * (v.mis.onward * rules_.power(static_cast<double>(value->pdfBack)) + v.mis.connect);
    mis_.connect = rules_.power(1.0 / static_cast<double>(sample.pdfSolidAngle));
    v.passed = choice.kind;
    return true;
}

/// Russian roulette: eye paths by what is left of them, light paths by what the last vertex took.
bool Subpath::survives(float before, float etaScale, float u) noexcept {
    const float now = maxComponent(throughput_);
    etaScale_ *= etaScale;
    float wanted = 1.0F;
    if (rules_.rouletteThreshold > 0.0F)
        wanted = from_ == From::Eye ? now * etaScale_ / rules_.rouletteThreshold : now / before;
    const float chance = survival(wanted, static_cast<int>(vertices_.size()));
    if (!(chance > 0.0F) || u >= chance) return false;
    throughput_ /= chance;
    return true;
}

bool Subpath::scatter(Sampler& sampler) noexcept {
    PathVertex& v = vertices_.back();
    const float chooseLobe = sampler.next1D();
    const glm::vec2 u = sampler.next2D();
    const float choose = sampler.next1D(), roulette = sampler.next1D();
    if (v.bsdf.kinds() == kNoLobe ||
        (rules_.maxDepth > 0 && vertices_.size() > static_cast<std::size_t>(rules_.maxDepth)))
        return false;
    const auto sample = v.bsdf.sample(v.toPrevious, chooseLobe, u, kAllLobes,
                                      from_ == From::Eye ? TransportMode::Radiance : TransportMode::Flux);
    if (!sample) return false;
    const glm::vec3& ng = v.bsdf.geometricNormal();
    const float cosOut = cosine(sample->wi, ng), before = maxComponent(throughput_);
    if (!(cosOut > kLeastCosine)) return false;
    const bool goesOn = sample->delta
                            ? deltaStep(v, *sample, scene_.surfaces().bsdf(v.hit.point, sample->wi, wave_), cosOut)
                            : glossyStep(v, *sample, cosOut, choose);
    deltaChain_ = deltaChain_ && sample->delta;
    if (!sample->delta) wave_ = {};
    if (!goesOn || !survives(before, sample->etaScale, roulette)) return false;
    if (from_ == From::Eye) string_.pass(v.passed);
    absorption_ = medium::afterHit(scene_, v.hit.point, v.bsdf, absorption_, sample->transmitted);
    const bool behind = glm::dot(sample->wi, ng) < 0.0F;
    ray_ =
        Ray{offsetOrigin(v.hit.point.position, behind ? -ng : ng), sample->wi, std::numeric_limits<float>::infinity()};
    return true;
}

/// 1 / (1 + sum of (p_other / p_this)^beta) for a path that met its light by itself.
double Subpath::hitWeight(std::uint32_t light, float cosineAtLight, float areaFactor) const noexcept {
    const bool escapes = areaFactor == 0.0F;
    const std::size_t reached = vertices_.size() - (escapes ? 0 : 1);  // vertices before the light
    if (reached == 0) return 1.0;
    const PathVertex& from = vertices_[reached - 1];
    const MisSums& sums = escapes ? mis_ : vertices_.back().mis;
    const float distance = escapes ? std::numeric_limits<float>::infinity() : vertices_.back().hit.distance;
    const Lights& lights = scene_.lights();
    auto direct =
        static_cast<double>(lights.pdfTowards(light, from.hit.point.position, from.horizon, ray_.direction, distance));
    if (!escapes) direct *= static_cast<double>(areaFactor * cosineAtLight);
    const EmissionPdf emission = lights.pdfEmission(light, -ray_.direction);
    const double emit = static_cast<double>(emission.position) * static_cast<double>(emission.direction);
    return 1.0 / (1.0 + rules_.power(direct) * sums.connect + rules_.power(emit) * sums.onward);
}

Rgb Subpath::emitted() const noexcept {
    const PathVertex& v = vertices_.back();
    const Rgb radiance = scene_.surfaces().emittedRadiance(v.hit.point, v.toPrevious);
    if (isBlack(radiance)) return radiance;
    const std::uint32_t light = scene_.lights().lightOf(v.hit.point.geometry, v.hit.point.primitive);
    if (light == Lights::kNoLight) return v.throughput * radiance;
    const float distance = v.hit.distance;
    const double weight =
        hitWeight(light, scene_.lights().cosineAt(light, ray_.direction), 1.0F / (distance * distance));
    return v.throughput * radiance * static_cast<float>(weight);
}

Rgb Subpath::escaped() const noexcept {
    const std::uint32_t light = scene_.lights().environmentLight();
    if (!escaped_ || light == Lights::kNoLight) return Rgb(0.0F);
    const Rgb radiance = scene_.environment()->radiance(ray_.direction);
    if (isBlack(radiance)) return radiance;
    return throughput_ * radiance * static_cast<float>(hitWeight(light, 1.0F, 0.0F));
}

}  // namespace pellucid

/// What each lobe of the closed set in surface/bsdf.h does with a pair of directions. Local frame: z is the shading
/// normal on wo's side, so wo.z > 0; wi.z > 0 reflects, wi.z < 0 transmits. Bsdf mixes them and checks the geometric
/// normal. Inline: a value that goes through memory between Bsdf and a lobe costs more than the lobe's arithmetic.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

#include <pellucid/math/constants.h>
#include <pellucid/math/warps.h>
#include <pellucid/surface/bsdf.h>
#include <pellucid/surface/fresnel.h>
#include <pellucid/surface/microfacet.h>

namespace pellucid {

/// A lobe's part of a scattering pair; both 0 where the lobe does not reach.
struct LobeValue {
    Rgb value{0.0F};             ///< f |cos wi|
    float pdfSolidAngle = 0.0F;  ///< with which sampleLobe makes wi
};

/// A direction that a lobe chose. `weight` is only filled by delta lobes: the limit of f |cos| / pdf. Passed by
/// reference: an optional of it would be copied in wide pieces that wait for the narrow stores before them.
struct LobeDirection {
    glm::vec3 wi{0.0F};
    Rgb weight{0.0F};
    float etaScale = 1.0F;
};

/// Reflectance of the coat's interface at a facet.
[[nodiscard]] inline Rgb coatReflectance(const CoatLobe& lobe, float cosTheta) noexcept {
    const float x = fresnelCurve(cosTheta, lobe.eta);
    return lobe.f90 * glm::max(Rgb{0.0F}, lobe.f0 + (Rgb{1.0F} - lobe.f0) * x);
}

/// Reflectance of the dielectric (of the whole slab for a thin wall): specular factor x exact Fresnel, total reflection
/// 1.
[[nodiscard]] inline float dielectricReflectance(const DielectricLobe& lobe, float cosTheta) noexcept {
    const float f = fresnelDielectric(cosTheta, lobe.eta);
    if (f >= 1.0F) return 1.0F;
    const float r = lobe.specular * f;
    return lobe.thin ? slabReflectance(r) : r;
}

namespace detail {

inline constexpr float kLeastAlbedo = 1e-4F;  ///< keeps every lobe choosable where the guess is too small

/// D G2 |cos i| / (4 |cos o| |cos i|) and the visible normals' pdf of wi, for the reflection at h = (wo + wi) / |wo +
/// wi|.
struct FacetReflection {
    float value = 0.0F, pdf = 0.0F, cosine = 0.0F;  ///< cosine = wo.h
};

[[nodiscard, gnu::always_inline]] inline FacetReflection reflectAtFacet(const glm::vec3& wo, const glm::vec3& wi,
                                                                        float alpha) noexcept {
    const glm::vec3 h = glm::normalize(wo + wi);
    const float d = ggxDistribution(h, alpha);
    // pdf_wi = pdf_h / (4 wo.h). [Walter2007, eq. 14]
    return {d * ggxVisibility(wo, wi, alpha) * wi.z, 0.25F * ggxVisiblePdfOverDot(wo, d, alpha),
            std::min(1.0F, glm::dot(wo, h))};
}

[[nodiscard]] inline glm::vec3 mirrored(const glm::vec3& wo) noexcept { return {-wo.x, -wo.y, wo.z}; }

[[nodiscard]] inline bool sampleReflection(const glm::vec3& wo, float alpha, const glm::vec2& u,
                                           LobeDirection& out) noexcept {
    const glm::vec3 h = sampleGgxVisibleNormal(wo, alpha, u);
    const glm::vec3 wi = 2.0F * glm::dot(wo, h) * h - wo;
    out.wi = glm::normalize(wi);
    return wi.z > 0.0F;
}

/// Probability of choosing reflection at a facet of reflectance `r`: its share of the carried light.
[[nodiscard]] inline float reflectionChance(const DielectricLobe& lobe, float r) noexcept {
    const float through = (1.0F - r) * maxComponent(lobe.tint);
    return r + through > 0.0F ? r / (r + through) : 1.0F;
}

/// (eta_i / eta_t)^2 of a refraction from wo's side: radiance is squeezed, flux is not. [Veach1997, sec. 5.2]
[[nodiscard]] inline float radianceScale(const DielectricLobe& lobe, TransportMode mode) noexcept {
    return lobe.thin || mode == TransportMode::Flux ? 1.0F : 1.0F / (lobe.eta * lobe.eta);
}

/// Refraction by a facet. [Walter2007, eqs. 16, 17, 21]; h from wo + eta wi, cosines cancelled as in ggxVisibility.
[[nodiscard]] inline LobeValue refractAtFacet(const DielectricLobe& lobe, const glm::vec3& wo, const glm::vec3& wi,
                                              TransportMode mode) noexcept {
    const glm::vec3 sum = wo + lobe.eta * wi;
    const float length2 = glm::dot(sum, sum);
    if (!(length2 > 0.0F)) return {};
    const glm::vec3 h = sum * std::copysign(1.0F / std::sqrt(length2), sum.z);
    const float cosO = std::min(1.0F, glm::dot(wo, h)), cosI = -glm::dot(wi, h);
    if (!(cosO > 0.0F && cosI > 0.0F)) return {};
    const float r = dielectricReflectance(lobe, cosO);
    if (r >= 1.0F) return {};
    const float d = ggxDistribution(h, lobe.alpha);
    const float root = cosO - lobe.eta * cosI;  // = wo.h + eta wi.h
    const float jacobian = lobe.eta * lobe.eta * cosI / (root * root);
    const float f = 4.0F * ggxVisibility(wo, wi, lobe.alpha) * -wi.z * cosO * d * jacobian;
    const float chance = 1.0F - reflectionChance(lobe, r);
    return {lobe.tint * ((1.0F - r) * f * radianceScale(lobe, mode)),
            chance * ggxVisiblePdfOverDot(wo, d, lobe.alpha) * cosO * jacobian};
}

/// Through a smooth interface: straight for a thin wall, by Snell's law into a body.
[[nodiscard]] inline glm::vec3 refractSmooth(const DielectricLobe& lobe, const glm::vec3& wo) noexcept {
    if (lobe.thin || lobe.eta == 1.0F) return -wo;
    const float inverse = 1.0F / lobe.eta;
    const double sin2 = static_cast<double>(wo.x) * wo.x + static_cast<double>(wo.y) * wo.y;
    return {-wo.x * inverse, -wo.y * inverse, -refractedCosine(sin2, lobe.eta)};
}

inline void sampleSmoothDielectric(const DielectricLobe& lobe, const glm::vec3& wo, float choose, TransportMode mode,
                                   LobeDirection& out) noexcept {
    const float r = dielectricReflectance(lobe, wo.z), chance = reflectionChance(lobe, r);
    if (choose < chance) {
        out.wi = mirrored(wo);
        out.weight = Rgb{r / chance};
        return;
    }
    const float scale = radianceScale(lobe, mode);
    out.wi = refractSmooth(lobe, wo);
    out.weight = lobe.tint * ((1.0F - r) / (1.0F - chance) * scale);
    out.etaScale = 1.0F / scale;
}

}  // namespace detail

[[nodiscard]] inline LobeValue evaluateLobe(const DiffuseLobe& lobe, const glm::vec3& wo, const glm::vec3& wi,
                                            TransportMode) noexcept {
    if (wi.z <= 0.0F) return {};
    const float pdf = wi.z * kInvPi;
    return {
        lobe.reflectance * (lobe.transmittance(std::min(1.0F, wo.z)) * lobe.transmittance(std::min(1.0F, wi.z)) * pdf),
        pdf};
}

[[nodiscard]] inline LobeValue evaluateLobe(const ConductorLobe& lobe, const glm::vec3& wo, const glm::vec3& wi,
                                            TransportMode) noexcept {
    if (wi.z <= 0.0F) return {};
    const detail::FacetReflection facet = detail::reflectAtFacet(wo, wi, lobe.alpha);
    return {fresnelSchlick(facet.cosine, lobe.f0) * facet.value, facet.pdf};
}

[[nodiscard]] inline LobeValue evaluateLobe(const CoatLobe& lobe, const glm::vec3& wo, const glm::vec3& wi,
                                            TransportMode) noexcept {
    if (wi.z <= 0.0F) return {};
    const detail::FacetReflection facet = detail::reflectAtFacet(wo, wi, lobe.alpha);
    return {coatReflectance(lobe, facet.cosine) * facet.value, facet.pdf};
}

[[nodiscard]] inline LobeValue evaluateLobe(const DielectricLobe& lobe, const glm::vec3& wo, const glm::vec3& wi,
                                            TransportMode mode) noexcept {
    const bool reflected = wi.z > 0.0F;
    if (wi.z == 0.0F) return {};
    if (!reflected && !lobe.thin) return detail::refractAtFacet(lobe, wo, wi, mode);
    // A thin wall transmits as it reflects, detail::mirrored to the other side.
    const detail::FacetReflection facet = detail::reflectAtFacet(wo, {wi.x, wi.y, std::fabs(wi.z)}, lobe.alpha);
    const float r = dielectricReflectance(lobe, facet.cosine), chance = detail::reflectionChance(lobe, r);
    if (reflected) return {Rgb{r * facet.value}, chance * facet.pdf};
    return {lobe.tint * ((1.0F - r) * facet.value), (1.0F - chance) * facet.pdf};
}

/// Each sampleLobe fills `out` and returns false where nothing goes on. `choose` decides between reflection and
/// transmission, `u` the facet.
[[nodiscard]] inline bool sampleLobe(const DiffuseLobe&, const glm::vec3&, float, const glm::vec2& u, TransportMode,
                                     LobeDirection& out) noexcept {
    out.wi = sampleCosineHemisphere(u);
    return out.wi.z > 0.0F;
}

[[nodiscard]] inline bool sampleLobe(const ConductorLobe& lobe, const glm::vec3& wo, float, const glm::vec2& u,
                                     TransportMode, LobeDirection& out) noexcept {
    if (lobe.alpha > 0.0F) return detail::sampleReflection(wo, lobe.alpha, u, out);
    out.wi = detail::mirrored(wo);
    out.weight = fresnelSchlick(wo.z, lobe.f0);
    return true;
}

[[nodiscard]] inline bool sampleLobe(const CoatLobe& lobe, const glm::vec3& wo, float, const glm::vec2& u,
                                     TransportMode, LobeDirection& out) noexcept {
    if (lobe.alpha > 0.0F) return detail::sampleReflection(wo, lobe.alpha, u, out);
    out.wi = detail::mirrored(wo);
    out.weight = coatReflectance(lobe, wo.z);
    return true;
}

[[nodiscard]] inline bool sampleLobe(const DielectricLobe& lobe, const glm::vec3& wo, float choose, const glm::vec2& u,
                                     TransportMode mode, LobeDirection& out) noexcept {
    if (!(lobe.alpha > 0.0F)) {
        detail::sampleSmoothDielectric(lobe, wo, choose, mode, out);
        return true;
    }
    const glm::vec3 h = sampleGgxVisibleNormal(wo, lobe.alpha, u);
    const float cosO = std::min(1.0F, glm::dot(wo, h));
    const float r = dielectricReflectance(lobe, cosO);
    const bool reflect = choose < detail::reflectionChance(lobe, r);
    glm::vec3 wi = 2.0F * cosO * h - wo;
    if (!reflect && lobe.thin) wi.z = -wi.z;
    if (!reflect && !lobe.thin) {
        const float cosT = refractedCosine(1.0 - static_cast<double>(cosO) * static_cast<double>(cosO), lobe.eta);
        wi = (cosO / lobe.eta - cosT) * h - wo / lobe.eta;
    }
    out.wi = glm::normalize(wi);
    if (!reflect) out.etaScale = 1.0F / detail::radianceScale(lobe, mode);
    return reflect ? wi.z > 0.0F : wi.z < 0.0F;
}

/// With which sampleLobe() of a delta lobe reflects: it does so for the lowest part of `choose`.
template <class Model>
[[nodiscard]] inline float deltaReflectionChance(const Model&, const glm::vec3&) noexcept {
    return 1.0F;
}
[[nodiscard]] inline float deltaReflectionChance(const DielectricLobe& lobe, const glm::vec3& wo) noexcept {
    return detail::reflectionChance(lobe, dielectricReflectance(lobe, wo.z));
}

/// Guessed directional albedo for choosing lobes: never 0 for a lobe that can carry light.
[[nodiscard]] inline float estimateAlbedo(const DiffuseLobe& lobe, const glm::vec3& wo) noexcept {
    const float mean = lobe.a - lobe.b * (1.0F / 21.0F);  // 2 int T(c) c dc
    return std::max(detail::kLeastAlbedo,
                    maxComponent(lobe.reflectance) * mean * lobe.transmittance(std::min(1.0F, wo.z)));
}

// Facets that a grazing viewer sees are tilted towards it: ggxSlope is about the mean cosine against them.
[[nodiscard]] inline float estimateAlbedo(const ConductorLobe& lobe, const glm::vec3& wo) noexcept {
    return std::max(detail::kLeastAlbedo, maxComponent(fresnelSchlick(ggxSlope(wo, lobe.alpha), lobe.f0)));
}

[[nodiscard]] inline float estimateAlbedo(const CoatLobe& lobe, const glm::vec3& wo) noexcept {
    return std::max(detail::kLeastAlbedo, maxComponent(coatReflectance(lobe, ggxSlope(wo, lobe.alpha))));
}

[[nodiscard]] inline float estimateAlbedo(const DielectricLobe& lobe, const glm::vec3& wo) noexcept {
    const float r = dielectricReflectance(lobe, ggxSlope(wo, lobe.alpha));
    return std::max(detail::kLeastAlbedo, r + (1.0F - r) * maxComponent(lobe.tint));
}

}  // namespace pellucid

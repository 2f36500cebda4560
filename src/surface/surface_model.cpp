#include <pellucid/surface/bsdf.h>

#include <algorithm>
#include <cmath>

#include <pellucid/surface/albedo_table.h>
#include <pellucid/surface/fresnel.h>

namespace pellucid {

namespace {

/// An interface this near to 1 sends back less than 1e-4 of diffuse light; its coat is left out.
constexpr float kLeastCoatStep = 1e-4F;
/// Facets that turn light by less than this angle are smooth: a float direction does not hold the facet that made it.
constexpr float kLeastTurn = 5e-5F;
constexpr float kLeastAlpha = 1e-4F;

/// The factors times the textures at one point.
struct Resolved {
    Rgb baseColor{1.0F};
    float metallic = 0.0F, roughness = 1.0F, specular = 1.0F, transmission = 0.0F;
    Rgb specularColor{1.0F};
};

/// The coat and what it leaves to the base: T(c) = a - b (1 - c)^5, k = 1 / (mean of T).
struct CoatTerms {
    CoatLobe lobe;
    bool present = false;
    float a = 1.0F, b = 0.0F, k = 1.0F;
};

bool coats(const Material& m) noexcept { return m.specular > 0.0F && std::fabs(m.ior - 1.0F) >= kLeastCoatStep; }
bool isVolume(const Material& m) noexcept { return m.thickness > 0.0F; }

const glm::vec2& uvOf(const TextureRef& texture, const SurfacePoint& point) noexcept {
    return point.uv[texture.uvSet == 1 ? 1 : 0];
}

glm::vec4 look(const TextureRef& texture, const SurfacePoint& point) noexcept {
    return texture ? sampleTexture(texture, uvOf(texture, point)) : glm::vec4{1.0F};
}

/// GGX alpha of glTF's roughness, 0 for a delta lobe.
float alphaOf(float roughness, const LobeRules& rules) noexcept {
    const float alpha = roughness * roughness;
    return alpha < std::max(rules.deltaAlpha, kLeastAlpha) ? 0.0F : alpha;
}

LobeKinds facetKind(float roughness, float threshold, const LobeRules& rules) noexcept {
    return roughness <= threshold || alphaOf(roughness, rules) == 0.0F ? kSpecular : kGlossy;
}

LobeKinds facetKind(float roughness, const LobeRules& rules) noexcept {
    return facetKind(roughness, rules.castRoughness, rules);
}

/// What transmits: a body, or a thin pane, behind which next-event estimation finds lamps as it does before metal.
LobeKinds transmittingKind(const Material& m, float roughness, const LobeRules& rules) noexcept {
    return facetKind(roughness, isVolume(m) ? rules.glassCastRoughness : rules.castRoughness, rules);
}

/// True when the facets of a body with this ior, relative to what it stands in, turn light so little that it goes on as
/// through a smooth face.
bool turnsLittle(const Material& m, float ior, float alpha) noexcept {
    return isVolume(m) && ior > 0.0F && std::fabs(ior - 1.0F) * std::min(alpha, 0.1F) < kLeastTurn;
}

Resolved resolveFactors(const Material& m) noexcept {
    return {Rgb{m.baseColor}, m.metallic, m.roughness, m.specular, m.transmission, m.specularColor};
}

Resolved resolve(const Material& m, const SurfacePoint& point) noexcept {
    Resolved r = resolveFactors(m);
    r.baseColor *= Rgb{look(m.baseColorTexture, point)};
    const glm::vec4 metallicRoughness = look(m.metallicRoughnessTexture, point);
    r.roughness *= metallicRoughness.g;
    r.metallic *= metallicRoughness.b;
    r.specular *= look(m.specularTexture, point).a;
    r.specularColor *= Rgb{look(m.specularColorTexture, point)};
    r.transmission *= look(m.transmissionTexture, point).r;
    return r;
}

/// KHR_materials_specular: F0 is scaled by the colour and kept below 1, the whole by the factor.
CoatTerms coatTerms(const Material& m, const Resolved& r, const LobeRules& rules, const AlbedoTables& tables,
                    std::size_t table) noexcept {
    CoatTerms terms;
    terms.present = coats(m) && r.specular > 0.0F;
    if (!terms.present) return terms;
    const float alpha = alphaOf(r.roughness, rules);
    const Rgb f0 = glm::min(fresnelNormal(m.ior) * r.specularColor, Rgb{1.0F});
    terms.lobe = {f0, r.specular, m.ior, alpha};
    const AlbedoBound bound = tables.coat(table, maxComponent(f0), r.specular, r.roughness, alpha == 0.0F);
    terms.a = std::max(0.0F, 1.0F - bound.e0);
    terms.b = std::clamp(bound.e1, 0.0F, terms.a);
    const float mean = terms.a - terms.b / 21.0F;  // 2 int T(c) c dc
    terms.k = mean > 1e-5F ? 1.0F / mean : 0.0F;
    return terms;
}

/// The interpolated normal turned by the normal map. glTF: the map's x and y are scaled, then the vector is made unit
/// again.
glm::vec3 mappedNormal(const Material& m, const SurfacePoint& point) noexcept {
    const glm::vec3& n = point.shadingNormal;
    const glm::vec3 tangent = point.tangent - n * glm::dot(n, point.tangent);
    const float length2 = glm::dot(tangent, tangent);
    if (!(length2 > 1e-12F)) return n;
    const glm::vec3 t = tangent / std::sqrt(length2), b = point.tangentSign * glm::cross(n, t);
    const glm::vec3 texel = 2.0F * glm::vec3{look(m.normalTexture, point)} - 1.0F;
    const glm::vec3 mapped = m.normalScale * (texel.x * t + texel.y * b) + texel.z * n;
    const float mapped2 = glm::dot(mapped, mapped);
    return mapped2 > 1e-12F ? mapped / std::sqrt(mapped2) : n;
}

/// On wo's side: the interpolated normal, else the geometric one.
glm::vec3 unmappedNormalFor(const SurfacePoint& point, const glm::vec3& wo, bool backSide) noexcept {
    const float side = backSide ? -1.0F : 1.0F;
    const glm::vec3 shading = side * point.shadingNormal;
    return glm::dot(shading, wo) > 0.0F ? shading : side * point.geometricNormal;
}

/// On wo's side: the mapped normal, else that without a map.
glm::vec3 normalFor(const Material& m, const SurfacePoint& point, const glm::vec3& wo, bool backSide) noexcept {
    if (m.normalTexture) {
        const glm::vec3 mapped = (backSide ? -1.0F : 1.0F) * mappedNormal(m, point);
        if (glm::dot(mapped, wo) > 0.0F) return mapped;
    }
    return unmappedNormalFor(point, wo, backSide);
}

/// True when a mirror's direction, and that of glass of this ior (0: no refraction), leave on the side that the true
/// surface says. `g`: the geometric normal on wo's side.
bool keepsSides(const glm::vec3& n, const glm::vec3& g, const glm::vec3& wo, float eta) noexcept {
    const float cosine = glm::dot(n, wo);
    if (glm::dot(2.0F * cosine * n - wo, g) <= 0.0F) return false;
    const double sin2 = std::max(0.0, 1.0 - static_cast<double>(cosine) * static_cast<double>(cosine));
    if (!(eta > 0.0F) || sin2 >= static_cast<double>(eta) * static_cast<double>(eta)) return true;  // total reflection
    return glm::dot((cosine / eta - refractedCosine(sin2, eta)) * n - wo / eta, g) < 0.0F;
}

/// An interpolated normal may lean so far that a mirror or glass would send light to the wrong side, where it is lost:
/// black rims. Such a normal is bent towards the geometric one, to a sixteenth no farther than it must.
glm::vec3 bentNormal(const glm::vec3& n, const glm::vec3& g, const glm::vec3& wo, float eta) noexcept {
    if (keepsSides(n, g, wo, eta)) return n;
    float wrong = 0.0F, right = 1.0F;
    glm::vec3 best = g;
    for (int i = 0; i < 4; ++i) {
        const float middle = 0.5F * (wrong + right);
        const glm::vec3 between = glm::normalize(glm::mix(n, g, middle));
        if (keepsSides(between, g, wo, eta)) {
            best = between;
            right = middle;
        } else {
            wrong = middle;
        }
    }
    return best;
}

/// Both iors are relative to what lies before the face; `smoothIor`, of a smooth one, at the wavelength.
Lobe dielectric(const Material& m, const Resolved& r, float weight, bool backSide, float roughIor, float smoothIor,
                const LobeRules& rules) noexcept {
    const float alpha = alphaOf(r.roughness, rules);
    const bool smooth = alpha == 0.0F || turnsLittle(m, roughIor, alpha);
    const float ior = smooth ? smoothIor : roughIor;
    DielectricLobe lobe{r.baseColor, ior, smooth ? 0.0F : alpha, r.specular, !isVolume(m)};
    if (isVolume(m) && backSide && ior > 0.0F) lobe.eta = 1.0F / ior;
    return {lobe, weight, 0.0F, smooth ? kSpecular : transmittingKind(m, r.roughness, rules), smooth};
}

bool dispersesIn(const Material& m, const LobeRules& rules) noexcept {
    if (!(m.dispersion > 0.0F && m.transmission > 0.0F && isVolume(m) && m.ior > 1.0F)) return false;
    const float alpha = alphaOf(m.roughness, rules);
    return m.metallicRoughnessTexture || alpha == 0.0F || turnsLittle(m, m.ior, alpha);
}

/// Every kind of facet lobe that the material's roughness can take.
LobeKinds facetKinds(const Material& m, const LobeRules& rules) noexcept {
    const LobeKinds greatest = facetKind(m.roughness, rules);
    return m.metallicRoughnessTexture ? greatest | kSpecular : greatest;
}

LobeKinds kindsOf(const Material& m, const LobeRules& rules) noexcept {
    const LobeKinds facets = facetKinds(m, rules);
    LobeKinds kinds = m.metallic > 0.0F ? facets : kNoLobe;
    if (m.metallic >= 1.0F && !m.metallicRoughnessTexture) return kinds;
    if (m.transmission > 0.0F) {
        const bool smooth = turnsLittle(m, m.ior, m.roughness * m.roughness);
        kinds = kinds | (smooth ? kSpecular : transmittingKind(m, m.roughness, rules));
        if (m.metallicRoughnessTexture) kinds = kinds | kSpecular;
    }
    if (m.transmission >= 1.0F && !m.transmissionTexture) return kinds;
    if (coats(m)) kinds = kinds | facets;
    return isBlack(Rgb{m.baseColor}) ? kinds : kinds | kDiffuse;
}

}  // namespace

struct SurfaceModel::Prepared {
    LobeKinds kinds = kNoLobe;
    bool textured = false;  ///< any texture that changes the lobes
    bool disperses = false;
    std::size_t table = 0;  ///< of the coat's ior
    Resolved factors;
    CoatTerms coat;  ///< of the factors alone
};

SurfaceModel::SurfaceModel(const std::vector<Material>& materials, const LobeRules& rules)
    : materials_(&materials), rules_(rules), tables_(std::make_unique<AlbedoTables>()) {
    prepared_.reserve(materials.size());
    for (const Material& m : materials) {
        Prepared p;
        p.kinds = kindsOf(m, rules_);
        p.textured = m.baseColorTexture || m.metallicRoughnessTexture || m.specularTexture || m.specularColorTexture ||
                     m.transmissionTexture;
        p.disperses = dispersesIn(m, rules_);
        p.factors = resolveFactors(m);
        const bool opaqueDielectric =
            (m.metallic < 1.0F || m.metallicRoughnessTexture) && (m.transmission < 1.0F || m.transmissionTexture);
        if (opaqueDielectric && coats(m)) {
            p.table = tables_->add(m.ior);
            p.coat = coatTerms(m, p.factors, rules_, *tables_, p.table);
        }
        prepared_.push_back(p);
    }
}

SurfaceModel::~SurfaceModel() = default;
SurfaceModel::SurfaceModel(SurfaceModel&&) noexcept = default;
SurfaceModel& SurfaceModel::operator=(SurfaceModel&&) noexcept = default;

LobeKinds SurfaceModel::possibleKinds(std::uint32_t material) const noexcept { return prepared_[material].kinds; }

bool SurfaceModel::disperses(std::uint32_t material) const noexcept { return prepared_[material].disperses; }

bool SurfaceModel::mapsDiffuseNormals() const noexcept {
    for (std::size_t i = 0; i < prepared_.size(); ++i)
        if ((*materials_)[i].normalTexture && (prepared_[i].kinds & kDiffuse) != kNoLobe) return true;
    return false;
}

Bsdf SurfaceModel::bsdf(const SurfacePoint& point, const glm::vec3& wo, Wave wave) const noexcept {
    const Material& m = (*materials_)[point.material];
    const Prepared& prepared = prepared_[point.material];
    Resolved r = prepared.textured ? resolve(m, point) : prepared.factors;
    r.baseColor = glm::min(r.baseColor * Rgb{point.color}, Rgb{1.0F});

    const float metal = r.metallic, glass = (1.0F - metal) * r.transmission,
                opaque = (1.0F - metal) * (1.0F - r.transmission);
    const bool backSide = glm::dot(wo, point.geometricNormal) < 0.0F;
    const glm::vec3 geometric = backSide ? -point.geometricNormal : point.geometricNormal;
    glm::vec3 normal = normalFor(m, point, wo, backSide);
    if (metal > 0.0F || glass > 0.0F) {
        const bool refracts = glass > 0.0F && isVolume(m) && m.ior > 0.0F;
        const float ior = relativeIor(point, {});
        normal = bentNormal(normal, geometric, wo, !refracts ? 0.0F : backSide ? 1.0F / ior : ior);
    }
    Bsdf result(Frame(normal), geometric, backSide, isVolume(m) && glass > 0.0F);
    if (m.normalTexture) result.setUnmappedNormal(unmappedNormalFor(point, wo, backSide));
    if (opaque > 0.0F) {
        const CoatTerms coat = prepared.textured ? coatTerms(m, r, rules_, *tables_, prepared.table) : prepared.coat;
        result.add({DiffuseLobe{r.baseColor * coat.k, coat.a, coat.b}, opaque, 0.0F, kDiffuse, false}, wo);
        if (coat.present)
            result.add({coat.lobe, opaque, 0.0F, facetKind(r.roughness, rules_), coat.lobe.alpha == 0.0F}, wo);
    }
    if (metal > 0.0F) {
        const float alpha = alphaOf(r.roughness, rules_);
        result.add({ConductorLobe{r.baseColor, alpha}, metal, 0.0F, facetKind(r.roughness, rules_), alpha == 0.0F}, wo);
    }
    if (glass > 0.0F) {
        if (point.beyond != kAir) r.baseColor *= Rgb{(*materials_)[point.beyond].baseColor};
        result.add(dielectric(m, r, glass, backSide, relativeIor(point, {}), relativeIor(point, wave), rules_), wo);
    }
    return result;
}

float SurfaceModel::relativeIor(const SurfacePoint& point, Wave wave) const noexcept {
    const auto iorOf = [&](std::uint32_t material) {
        const Material& m = (*materials_)[material];
        return isVolume(m) && m.ior > 0.0F ? iorAt(m.ior, m.dispersion, wave) : m.ior;
    };
    const float ior = iorOf(point.material);
    return point.beyond == kAir ? ior : ior / iorOf(point.beyond);
}

Rgb SurfaceModel::emittedRadiance(const SurfacePoint& point, const glm::vec3& wo) const noexcept {
    const Material& m = (*materials_)[point.material];
    if (isBlack(m.emission)) return Rgb{0.0F};
    if (!m.doubleSided && !(glm::dot(wo, point.geometricNormal) > 0.0F)) return Rgb{0.0F};
    return m.emissiveTexture ? m.emission * Rgb{look(m.emissiveTexture, point)} : m.emission;
}

float SurfaceModel::coverage(const SurfacePoint& point) const noexcept {
    const Material& m = (*materials_)[point.material];
    if (m.alphaMode == AlphaMode::Opaque) return 1.0F;
    const float alpha = m.baseColor.a * point.color.a * look(m.baseColorTexture, point).a;
    if (m.alphaMode == AlphaMode::Mask) return alpha >= m.alphaCutoff ? 1.0F : 0.0F;
    return std::clamp(alpha, 0.0F, 1.0F);
}

}  // namespace pellucid

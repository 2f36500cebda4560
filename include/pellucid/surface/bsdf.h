/// The lobes of a material at a point. Two properties decided once for every pass make the kinds
/// (transport/path_classes.h):
///   Specular S: casts caustics (photons that pass it go on to the caustic map), never receives photons;
///   Glossy   G: neither; only path tracing carries light over it;
///   Diffuse  D: receives photons and irradiance, never casts caustics.
/// wo points to the viewer, wi to the light, both away from the surface, unit, in scene space.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include <pellucid/math/frame.h>
#include <pellucid/math/rgb.h>
#include <pellucid/surface/dispersion.h>
#include <pellucid/surface/material.h>
#include <pellucid/surface/surface_point.h>

namespace pellucid {

/// Bit set of lobe kinds.
enum LobeKinds : std::uint8_t { kNoLobe = 0, kSpecular = 1, kGlossy = 2, kDiffuse = 4, kAllLobes = 7 };

/// What a path carries: refraction scales radiance by (eta_i/eta_t)^2 and leaves flux as it is.
enum class TransportMode { Radiance, Flux };

/// Roughness thresholds (glTF's perceptual roughness; GGX alpha = roughness^2).
struct LobeRules {
    float castRoughness = 0.3F;  ///< a microfacet lobe up to this roughness is Specular, above it Glossy
    float deltaAlpha = 1e-3F;    ///< below this GGX alpha a lobe is an exact delta lobe
    /// The same for bodies of glass: no lamp is found through them but by chance, however rough they are, and records of the
    /// cache that had the luck are outvoted by those that had not.
    float glassCastRoughness = 1.0F;
    bool operator==(const LobeRules&) const = default;
};

/// How directions are drawn: in proportion to the lobes, or blind to them by the cosine or uniformly (over both sides where
/// light may pass). Delta lobes keep their share and their direction. For showing what each is worth.
enum class Directions : std::uint8_t { Bsdf, Cosine, Uniform };

struct BsdfSample {
    glm::vec3 wi{0.0F};
    Rgb weight{0.0F};            ///< f |cos| / pdf of the sampled set of lobes (for a delta lobe: its limit)
    float pdfSolidAngle = 0.0F;  ///< of all non-delta lobes in the sampled set; 0 for a delta sample
    LobeKinds kind = kNoLobe;    ///< the kind of the lobe that was chosen: exactly one bit
    bool delta = false;
    bool transmitted = false;  ///< wi is on the other side of the surface than wo
    float etaScale = 1.0F;     ///< product over a path undoes the radiance scaling of refraction, for Russian roulette
};

/// Diffuse lobe f = reflectance / pi * T(wo) T(wi), T(c) = a - b (1 - c)^5: Lambert under an interface that lets
/// through T. The form separates, so irradiance splits in two moments (math in docs/theory.md): sum over light of f cos
/// = reflectance / pi * T(wo) * (a E - b E5), with E = int L cos and E5 = int L (1 - cos)^5 cos.
struct DiffuseLobe {
    Rgb reflectance{0.0F};
    float a = 1.0F, b = 0.0F;

    [[nodiscard]] float transmittance(float cosTheta) const noexcept {
        const float s = 1.0F - cosTheta, s2 = s * s;
        return a - b * s2 * s2 * s;
    }
};

/// Bounds of the directional albedo of a GGX reflection with the exact Fresnel term of each ior; see
/// surface/albedo_table.h.
class AlbedoTables;

/// All that makeBsdf needs beside the material: made once for a scene's materials.
class SurfaceModel {
public:
    SurfaceModel(const std::vector<Material>& materials, const LobeRules& rules);
    ~SurfaceModel();
    SurfaceModel(SurfaceModel&&) noexcept;
    SurfaceModel& operator=(SurfaceModel&&) noexcept;

    /// Lobes at `point` for a viewer in direction `wo`, of smooth glass that disperses at this wavelength (none: 587.6 nm).
    /// Opaque materials shade both faces alike.
    [[nodiscard]] class Bsdf bsdf(const SurfacePoint& point, const glm::vec3& wo, Wave wave = {}) const noexcept;

    /// Radiance emitted at `point` towards `wo`: one-sided unless doubleSided. Linear RGB.
    [[nodiscard]] Rgb emittedRadiance(const SurfacePoint& point, const glm::vec3& wo) const noexcept;

    /// Coverage in [0, 1]: 1 for Opaque, 0 or 1 for Mask, texture x factor x vertex alpha for Blend.
    [[nodiscard]] float coverage(const SurfacePoint& point) const noexcept;

    /// Kinds of lobes that this material can have anywhere (textures taken into account conservatively).
    [[nodiscard]] LobeKinds possibleKinds(std::uint32_t material) const noexcept;
    /// Whether its smooth glass has another ior at another wavelength. (Rough glass has one ior.)
    [[nodiscard]] bool disperses(std::uint32_t material) const noexcept;
    /// Whether light that crosses the surface here has a way for each wavelength.
    [[nodiscard]] bool disperses(const SurfacePoint& point) const noexcept {
        return disperses(point.material) || (point.beyond != kAir && disperses(point.beyond));
    }
    /// Ior of the body behind the surface over that of what lies before it: air, or a body that touches it.
    [[nodiscard]] float relativeIor(const SurfacePoint& point, Wave wave) const noexcept;
    /// Absorption, per scene unit, of what lies before the surface.
    [[nodiscard]] Rgb absorptionBefore(const SurfacePoint& point) const noexcept {
        return point.beyond == kAir ? Rgb{0.0F} : (*materials_)[point.beyond].absorption;
    }
    /// Whether some material has a diffuse lobe under a normal map.
    [[nodiscard]] bool mapsDiffuseNormals() const noexcept;

    [[nodiscard]] const std::vector<Material>& materials() const noexcept { return *materials_; }
    [[nodiscard]] const LobeRules& rules() const noexcept { return rules_; }

private:
    const std::vector<Material>* materials_;
    LobeRules rules_;
    std::unique_ptr<AlbedoTables> tables_;
    struct Prepared;  ///< what of a material does not change from point to point
    std::vector<Prepared> prepared_;
};

/// The other lobes, in the local frame of the (normal-mapped) shading normal on wo's side. Each casts or not by `kind`.
struct ConductorLobe {  ///< GGX reflection, Schlick Fresnel with F90 = 1; alpha 0: delta mirror
    Rgb f0{1.0F};
    float alpha = 0.0F;
};
struct CoatLobe {   ///< GGX reflection of a dielectric over the diffuse base
    Rgb f0{0.04F};  ///< F = f90 (f0 + (1 - f0) x), x = (Fexact(eta) - F0(eta)) / (1 - F0(eta))
    float f90 = 1.0F, eta = 1.5F, alpha = 0.0F;
};
struct DielectricLobe {  ///< reflection and transmission, exact Fresnel; alpha 0: delta
    Rgb tint{1.0F};      ///< multiplies transmission, once per crossing: KHR_materials_volume's base colour is a foil
    /// Ior on the far side over ior on wo's side (of the wall itself for a thin one); 0 reflects all.
    float eta = 1.5F;
    float alpha = 0.0F;
    float specular = 1.0F;  ///< multiplies the reflectance short of total reflection
    bool thin = false;      ///< thin-walled: R' = 2R/(1+R), transmission straight on
};

struct Lobe {
    std::variant<DiffuseLobe, ConductorLobe, CoatLobe, DielectricLobe> model;
    float weight = 0.0F;       ///< of this lobe in the mix
    float probability = 0.0F;  ///< relative, for choosing a lobe to sample
    LobeKinds kind = kNoLobe;
    bool delta = false;
};

/// What a pair of directions is worth; see Bsdf::eval and Bsdf::pdf.
struct BsdfValue {
    Rgb value{0.0F};  ///< f |cos wi|
    float pdfSolidAngle = 0.0F;
};

/// See Bsdf::deltaBranches.
struct DeltaBranches {
    static constexpr int kMost = 8;
    std::array<BsdfSample, kMost> branch;
    int count = 0;
};

class Bsdf {
public:
    /// eval() and pdf() at once, for less than the price of both.
    [[nodiscard]] BsdfValue evaluate(const glm::vec3& wo, const glm::vec3& wi, LobeKinds kinds,
                                     TransportMode mode) const noexcept;

    /// f |cos(wi)| of the non-delta lobes among `kinds`; 0 where the shading and geometric normals disagree about the
    /// side.
    [[nodiscard]] Rgb eval(const glm::vec3& wo, const glm::vec3& wi, LobeKinds kinds,
                           TransportMode mode) const noexcept;

    /// Density per solid angle with which sample() over the same `kinds` makes `wi` by a non-delta lobe.
    [[nodiscard]] float pdf(const glm::vec3& wo, const glm::vec3& wi, LobeKinds kinds) const noexcept;

    /// Chooses a lobe among `kinds` by its share of the albedo, then a direction. Empty: nothing goes on.
    [[nodiscard]] std::optional<BsdfSample> sample(const glm::vec3& wo, float chooseLobe, const glm::vec2& u,
                                                   LobeKinds kinds, TransportMode mode) const noexcept;

    /// sample() and pdf() with directions that are blind to the lobes; Directions::Bsdf is the same as those.
    [[nodiscard]] std::optional<BsdfSample> sample(const glm::vec3& wo, float chooseLobe, const glm::vec2& u,
                                                   LobeKinds kinds, TransportMode mode,
                                                   Directions directions) const noexcept;
    [[nodiscard]] float pdf(const glm::vec3& wo, const glm::vec3& wi, LobeKinds kinds,
                            Directions directions) const noexcept;

    /// All directions that the delta lobes lead to, each with its whole weight: where an interface splits light, both ways.
    [[nodiscard]] DeltaBranches deltaBranches(const glm::vec3& wo, TransportMode mode) const noexcept;

    [[nodiscard]] LobeKinds kinds() const noexcept { return kinds_; }
    /// Whether some lobe has a value for a given pair of directions: not all of them are delta lobes.
    [[nodiscard]] bool connects() const noexcept { return connects_; }
    /// The diffuse lobe scaled by its weight; reflectance 0 when there is none.
    [[nodiscard]] const DiffuseLobe& diffuse() const noexcept { return diffuse_; }
    /// Estimated directional albedo for wo of the lobes in `kinds` (a guide for roulette, not exact).
    [[nodiscard]] float albedo(LobeKinds kinds) const noexcept;
    /// The (normal-mapped) shading normal on wo's side, and the geometric normal on the same side as wo.
    [[nodiscard]] const glm::vec3& shadingNormal() const noexcept { return frame_.normal; }
    [[nodiscard]] const glm::vec3& geometricNormal() const noexcept { return geometricNormal_; }
    /// The shading normal as it is without a normal map: what irradiance records are of.
    [[nodiscard]] const glm::vec3& unmappedNormal() const noexcept { return unmappedNormal_; }
    void setUnmappedNormal(const glm::vec3& normal) noexcept { unmappedNormal_ = normal; }
    /// True when wo is on the back of the surface (inside of a closed body).
    [[nodiscard]] bool backSide() const noexcept { return backSide_; }
    /// True when light that is transmitted enters or leaves a volume (thickness > 0), not a thin wall.
    [[nodiscard]] bool bordersVolume() const noexcept { return bordersVolume_; }

    /// Construction is SurfaceModel's; public so that tests can build a Bsdf lobe by lobe.
    Bsdf(const Frame& frame, const glm::vec3& geometricNormal, bool backSide, bool bordersVolume) noexcept;
    /// Sets the lobe's probability. At most one diffuse lobe and kMaxLobes in all; lobes that carry nothing are left
    /// out.
    void add(const Lobe& lobe, const glm::vec3& wo) noexcept;

private:
    static constexpr int kMaxLobes = 4;
    [[nodiscard]] float totalProbability(LobeKinds kinds) const noexcept;
    [[nodiscard]] const Lobe* pickLobe(LobeKinds kinds, float target, float& below) const noexcept;
    struct BlindShare;
    [[nodiscard]] BlindShare blindShare(LobeKinds kinds) const noexcept;
    [[nodiscard]] bool sameSide(const glm::vec3& local, const glm::vec3& world) const noexcept;
    void evaluateLocal(const glm::vec3& wo, const glm::vec3& wi, LobeKinds kinds, TransportMode mode,
                       BsdfValue& sum) const noexcept;
    Frame frame_;
    glm::vec3 geometricNormal_, unmappedNormal_;
    DiffuseLobe diffuse_;
    std::array<Lobe, kMaxLobes> lobes_;
    int count_ = 0;
    LobeKinds kinds_ = kNoLobe;
    bool connects_ = false;
    bool backSide_, bordersVolume_;
};

[[nodiscard]] constexpr LobeKinds operator|(LobeKinds a, LobeKinds b) noexcept {
    return static_cast<LobeKinds>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
[[nodiscard]] constexpr LobeKinds operator&(LobeKinds a, LobeKinds b) noexcept {
    return static_cast<LobeKinds>(static_cast<unsigned>(a) & static_cast<unsigned>(b));
}

}  // namespace pellucid

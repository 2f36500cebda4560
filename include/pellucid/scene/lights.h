/// Every light of a scene in one list, with the three samplings that transport needs: towards a point (next-event
/// estimation), its density for a light that was hit (multiple importance sampling), and emission of photons.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include <pellucid/math/constants.h>
#include <pellucid/math/ray.h>
#include <pellucid/math/rgb.h>
#include <pellucid/scene/environment.h>

namespace pellucid {

/// A triangle that emits, in normalised scene space. Its texture stays with the scene: see Lights::TriangleRadiance.
struct EmissiveTriangle {
    glm::vec3 corner[3];
    glm::vec3 normal{0.0F};  ///< unit geometric normal, by winding (after the transform)
    float area = 0.0F;
    bool twoSided = false;
    std::uint32_t geometry = 0, primitive = 0;
    /// The texture's mean over it, W m^-2 sr^-1: an estimate for choosing, > 0 wherever it emits.
    Rgb meanRadiance{0.0F};
};

/// Punctual lights in normalised scene space (intensity already scaled).
struct PointEmitter {
    glm::vec3 position{0.0F};
    Rgb intensity{0.0F};  ///< W/sr, with areas in scene units
};
struct SpotEmitter {
    glm::vec3 position{0.0F}, direction{0.0F, 0.0F, -1.0F};
    Rgb intensity{0.0F};
    float cosInner = 1.0F, cosOuter = 0.7F;  ///< KHR_lights_punctual's falloff between them
};
struct DirectionalEmitter {
    glm::vec3 direction{0.0F, -1.0F, 0.0F};  ///< in which the light travels
    Rgb irradiance{0.0F};                    ///< W/m^2 on a surface that faces it
};

enum class LightKind : std::uint8_t { Point, Spot, Directional, Triangle, Environment };

/// One light among all, chosen with probability `pmf`.
struct LightPick {
    std::uint32_t light = 0;
    float pmf = 0.0F;
    double left = 0.0;  ///< what the choice has left of its number: uniform in [0,1) again
};

/// A light seen from a shading point. The estimate is f |cos| * radiance / pdfSolidAngle, for delta lights too.
struct LightSample {
    glm::vec3 wi{0.0F};     ///< unit, to the light
    float distance = 0.0F;  ///< infinity for directional and environment
    Rgb radiance{0.0F};     ///< towards the point; of a delta light the irradiance across wi: I / d^2 or E
    /// Of wi, with the choice of the light; of a delta light the probability of the choice.
    float pdfSolidAngle = 0.0F;
    bool delta = false;
    std::uint32_t light = 0;
};

/// The start of a photon's path.
struct EmissionSample {
    Ray ray;
    Rgb flux{0.0F};  ///< Le cos / (p_light p_position p_direction), in W: the photon's power for one emitted path
    /// Per area of the emitter, or of the disc that stands for infinity; 1 for point lights.
    float pdfPosition = 0.0F;
    float pdfDirection = 0.0F;  ///< per solid angle; 1 for directional
    float pmfLight = 0.0F;
    std::uint32_t light = 0;
    bool delta = false;  ///< point, spot, directional
};

/// Densities with which sampleEmission() starts a path: of its point (per area, with the choice of the light; of a point
/// light the choice alone, from infinity per area of the disc) and of its direction (per solid angle; 1 for directional).
struct EmissionPdf {
    float position = 0.0F, direction = 0.0F;
};

/// Five numbers in [0,1) that make an emission: the primary sample space that emission guiding works in.
struct EmissionNumbers {
    float chooseLight = 0.0F;
    glm::vec2 position{0.0F}, direction{0.0F};
};

class Lights {
public:
    struct Parts {
        std::vector<PointEmitter> points;
        std::vector<SpotEmitter> spots;
        std::vector<DirectionalEmitter> directionals;
        std::vector<EmissiveTriangle> triangles;
        const Environment* environment = nullptr;  ///< null or black: none
        glm::vec3 sceneCentre{0.0F};
        float sceneRadius = 1.0F;      ///< photons from infinity start on a disc of this radius, beyond the scene
        std::uint32_t geometries = 0;  ///< number of geometries; only a hint, the triangles' own numbers count
    };
    /// Radiance of a triangle at barycentrics, towards `wo`: given by the scene (textures). Called by sample() and
    /// sampleEmission(). Null: every triangle emits its mean radiance.
    using TriangleRadiance = Rgb (*)(const void* scene, std::uint32_t geometry, std::uint32_t primitive,
                                     const glm::vec2& barycentric, const glm::vec3& wo);

    /// Lights that emit nothing (black, without area, not finite) are dropped. Numbers run over points, spots,
    /// triangles, directionals (each in the order of `parts`), then the environment.
    Lights(Parts parts, TriangleRadiance radiance, const void* scene);
    ~Lights();
    Lights(Lights&&) noexcept;
    Lights& operator=(Lights&&) noexcept;

    [[nodiscard]] std::size_t count() const noexcept;
    [[nodiscard]] LightKind kind(std::uint32_t light) const noexcept;
    /// Total emitted power in W (infinity: through the scene's bounding sphere), for choosing.
    [[nodiscard]] double power(std::uint32_t light) const noexcept;
    [[nodiscard]] double totalPower() const noexcept;

    /// One light and a point on it, seen from `point` with normal `normal` (zero vector: no surface, no horizon).
    /// Among few lights the choice follows an estimate of what each sends to the point, among many a light tree
    /// (bounds, strength, orientation); a light that cannot reach the point has no share. Empty: black or below the
    /// horizon. The choice takes the first number of `u` and leaves what it did not need of it for the point, so that well
    /// spread points stay so over lamps of several triangles; `fine` continues that number beyond the digits of a float.
    [[nodiscard]] std::optional<LightSample> sample(const glm::vec3& point, const glm::vec3& normal, float fine,
                                                    const glm::vec2& u) const noexcept;

    /// sample() in two steps: the choice, then a point on that light.
    [[nodiscard]] std::optional<LightPick> choose(const glm::vec3& point, const glm::vec3& normal,
                                                  double u) const noexcept;
    /// The number that a choice takes, and the point's numbers after it.
    [[nodiscard]] static double choiceNumber(float fine, const glm::vec2& u) noexcept {
        return static_cast<double>(u.x) + static_cast<double>(fine) * 0x1p-24;
    }
    [[nodiscard]] static glm::vec2 pointNumbers(const LightPick& pick, const glm::vec2& u) noexcept {
        return {std::min(static_cast<float>(pick.left), kOneMinusEpsilon), u.y};
    }
    [[nodiscard]] std::optional<LightSample> sampleFrom(const LightPick& pick, const glm::vec3& point,
                                                        const glm::vec3& normal, const glm::vec2& u) const noexcept;

    /// The environment, picked as `sky`, in direction `wi`: as sampleFrom() would give it. Empty: black or below the horizon.
    [[nodiscard]] std::optional<LightSample> towardsEnvironment(const LightPick& sky, const glm::vec3& normal,
                                                                const glm::vec3& wi) const noexcept;

    /// Probability with which sample() from (point, normal) chooses `light`. Over few lights it sums to 1, or to 0
    /// where none reaches the point; over many to at most 1, since the tree may end at a light that proves out of
    /// reach.
    [[nodiscard]] float choicePmf(std::uint32_t light, const glm::vec3& point, const glm::vec3& normal) const noexcept;
    /// Density per solid angle with which sample() from (point, normal) makes direction `wi` to the emissive triangle
    /// (geometry, primitive) hit at `distance`. 0 when that triangle is no light, on the dark side of a one-sided one
    /// and below the horizon of `normal`: what sample() cannot make.
    [[nodiscard]] float pdfTriangle(const glm::vec3& point, const glm::vec3& normal, std::uint32_t geometry,
                                    std::uint32_t primitive, const glm::vec3& wi, float distance) const noexcept;
    [[nodiscard]] float pdfEnvironment(const glm::vec3& point, const glm::vec3& normal,
                                       const glm::vec3& wi) const noexcept;

    /// The light that an emissive triangle is; kNoLight where it emits nothing.
    static constexpr std::uint32_t kNoLight = ~0U;
    [[nodiscard]] std::uint32_t lightOf(std::uint32_t geometry, std::uint32_t primitive) const noexcept;
    /// The environment's light; kNoLight without one.
    [[nodiscard]] std::uint32_t environmentLight() const noexcept;
    /// pdfSolidAngle of a sample() from (point, normal) of `light` in direction `wi`, at `distance`; of a delta light the
    /// probability of its choice.
    [[nodiscard]] float pdfTowards(std::uint32_t light, const glm::vec3& point, const glm::vec3& normal,
                                   const glm::vec3& wi, float distance) const noexcept;
    /// |cos| between the normal of `light` and a direction; 1 for lights without a surface.
    [[nodiscard]] float cosineAt(std::uint32_t light, const glm::vec3& direction) const noexcept;
    /// Densities of sampleEmission() for light that leaves `light` in `direction`.
    [[nodiscard]] EmissionPdf pdfEmission(std::uint32_t light, const glm::vec3& direction) const noexcept;

    /// Density of sampleEmission() for light that leaves `light` in `direction`, per etendue (area x projected solid angle,
    /// which every chain of mirrors and lenses keeps); infinite for lights without size.
    [[nodiscard]] float etendueDensity(std::uint32_t light, const glm::vec3& direction) const noexcept;

    /// Emission with lights chosen by power.
    [[nodiscard]] std::optional<EmissionSample> sampleEmission(const EmissionNumbers& u) const noexcept;
    /// Emission from one given light (pmfLight = 1): guiding chooses the light itself.
    [[nodiscard]] std::optional<EmissionSample> sampleEmissionFrom(std::uint32_t light, const glm::vec2& position,
                                                                   const glm::vec2& direction) const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid

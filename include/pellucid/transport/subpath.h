/// Paths grown from one end, from the eye or from a light, and kept vertex by vertex: what bidirectional methods connect,
/// merge or mutate. Each vertex carries the recursive sums by which the multiple importance sampling weight of any
/// technique is found from the two ends alone [Georgiev2012, eqs. 31-36]; the sum for merging would stand beside them.
///
/// What a path is worth is always what the eye's walk says it is: f and its shading frame are those of a viewer on the
/// eye's side, with adjoint factors for paths from a light [Veach1997, 5.3], so that all techniques agree on every path.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <pellucid/math/sampler.h>
#include <pellucid/scene/scene.h>
#include <pellucid/transport/path_classes.h>

namespace pellucid {

/// Rules that hold for both ends.
struct SubpathRules {
    bool powerHeuristic = true;
    float rouletteThreshold = 1.0F;  ///< 0: no Russian roulette
    int maxDepth = 0;                ///< surface vertices of a whole path; 0: no limit
    std::uint32_t lightPaths = 1;    ///< that may splat on a pixel for each eye path through it

    /// What the heuristic makes of a ratio of densities. [Veach1997, 9.2]
    [[nodiscard]] double power(double ratio) const noexcept { return powerHeuristic ? ratio * ratio : ratio; }
};

/// Sums of ratios of densities, each raised by SubpathRules::power. Double: they are products of squares.
struct MisSums {
    double connect = 0.0;  ///< dVCM: of the technique that connects this vertex's predecessor to what lies behind it
    /// dVC: of all techniques that connect farther back, still without the density of the way back.
    double onward = 0.0;
};

struct PathVertex {
    SurfaceHit hit;
    Bsdf bsdf;             ///< seen from the vertex before
    glm::vec3 toPrevious;  ///< unit
    Rgb throughput;        ///< of the path that arrives: a factor of radiance from the eye, W from a light
    Rgb absorption;        ///< of the medium that it arrived through
    MisSums mis;
    glm::vec3 horizon;           ///< for light sampling here; zero where light may come from behind
    PathString before;           ///< eye paths: the vertices before this one
    LobeKinds passed = kNoLobe;  ///< the kind of lobe by which the path went on
};

/// What a vertex makes of a direction: f |cos ns| of the direction towards the light, by kind (S, G, D); at a vertex of a
/// light path over |cos ng| of it, so that it acts on arriving flux.
struct VertexValue {
    std::array<Rgb, 3> byKind{Rgb(0.0F), Rgb(0.0F), Rgb(0.0F)};
    float pdfOnward = 0.0F;  ///< per solid angle: of this path going on in the direction
    float pdfBack = 0.0F;    ///< of a path from there going on to the vertex before
    [[nodiscard]] Rgb total() const noexcept { return byKind[0] + byKind[1] + byKind[2]; }
};

/// One path, grown step by step. Reuse it for the next: it keeps its memory.
class Subpath {
public:
    enum class From : std::uint8_t { Eye, Light };

    Subpath(const Scene& scene, const SubpathRules& rules, From from) noexcept
        : scene_(scene), rules_(rules), from_(from) {}

    void startAtEye(const Camera& camera, const Ray& ray) noexcept;
    /// Emits from a light chosen by power; uses the sampler's first three dimensions. False: it chose darkness.
    [[nodiscard]] bool startAtLight(Sampler& sampler) noexcept;

    /// Goes on to the next surface. False: there is none. `sampler` gives a wavelength where one is due.
    [[nodiscard]] bool advance(float coin, Sampler& sampler) noexcept;
    /// Scatters at the last vertex; uses five dimensions. False: the path ends there.
    [[nodiscard]] bool scatter(Sampler& sampler) noexcept;

    [[nodiscard]] const std::vector<PathVertex>& vertices() const noexcept { return vertices_; }
    [[nodiscard]] const PathVertex& last() const noexcept { return vertices_.back(); }

    /// The scattering at one of its vertices towards `direction`. Empty: nothing.
    [[nodiscard]] std::optional<VertexValue> valueTowards(const PathVertex& v,
                                                          const glm::vec3& direction) const noexcept;

    /// Eye paths: radiance that the last vertex emits, or the environment after advance() said false, with its weight.
    [[nodiscard]] Rgb emitted() const noexcept;
    [[nodiscard]] Rgb escaped() const noexcept;
    /// Whether it has gone over delta lobes alone.
    [[nodiscard]] bool deltaChain() const noexcept { return deltaChain_; }
    [[nodiscard]] float etaScale() const noexcept { return etaScale_; }
    /// At which the last vertex scatters.
    [[nodiscard]] Wave wave() const noexcept { return wave_; }
    /// The string of the eye path behind its last scattering.
    [[nodiscard]] PathString string() const noexcept { return string_; }

private:
    struct Start {
        const Camera* camera = nullptr;
        std::uint32_t light = 0;
        float pdfEmission = 0.0F;  ///< of the point (with the choice of the light) times that of the direction
        float cosine = 1.0F;       ///< at the light
        bool delta = false, infinite = false;
    };
    void begin(const Ray& ray, const Rgb& throughput) noexcept;
    [[nodiscard]] MisSums sumsAtFirst(const glm::vec3& point, const glm::vec3& horizon, float cosine,
                                      float distance) const noexcept;
    [[nodiscard]] bool deltaStep(PathVertex& v, const BsdfSample& sample, const Bsdf& other, float cosOut) noexcept;
    [[nodiscard]] bool glossyStep(PathVertex& v, const BsdfSample& sample, float cosOut, float chooseKind) noexcept;
    [[nodiscard]] bool survives(float before, float etaScale, float u) noexcept;
    [[nodiscard]] double hitWeight(std::uint32_t light, float cosine, float areaFactor) const noexcept;

    const Scene& scene_;
    SubpathRules rules_;
    From from_;
    Start start_;
    std::vector<PathVertex> vertices_;
    Ray ray_;
    Rgb throughput_{1.0F}, absorption_{0.0F};
    float etaScale_ = 1.0F;
    Wave wave_;  ///< of this chain of delta lobes
    bool escaped_ = false, deltaChain_ = true;
    MisSums mis_;  ///< of the next vertex, before the factors of its distance and cosine
    PathString string_;
};

}  // namespace pellucid

/// One walk from the eye (or from a point that gathers) through the scene: the path tracer, and with maps the final-gather
/// path tracer. With no map at all it is the unbiased baseline; each map takes over exactly the class that
/// transport/path_classes.h gives it.
#pragma once

#include <array>
#include <cstdint>

#include <pellucid/math/sampler.h>
#include <pellucid/scene/scene.h>
#include <pellucid/transport/kernel_tally.h>
#include <pellucid/transport/lamp_chains.h>
#include <pellucid/transport/path_classes.h>
#include <pellucid/transport/walk_trace.h>

namespace pellucid {

class CausticMap;
struct PhotonEstimate;
class RadianceMap;
class IrradianceCache;

/// What passes before the eye's have left for walks to look up. Null: the pass is left out and its class is path traced.
struct Maps {
    const CausticMap* caustic = nullptr;
    /// Beside the cache eye paths follow S chains to the lamps: for all caustics, or with a caustic map for a share of them.
    bool causticChains = false;
    /// With both, N of chanceShare(): photon paths of a pass, times how much denser the guide makes those that are useful.
    float photonsPerEtendue = 0.0F;
    const RadianceMap* global = nullptr;
    const IrradianceCache* cache = nullptr;
    /// Progressive photon mapping: at the first D vertex all photons that came neither directly nor over S alone. Nothing is
    /// traced behind it.
    const CausticMap* others = nullptr;
    float causticRadiusMin = 0.0F;  ///< in scene units
    float causticRadiusMax = 1.0F, othersRadiusMax = 1.0F;

    /// Whether light over S alone is kept out of cache and gather.
    [[nodiscard]] bool causticsApart() const noexcept { return caustic != nullptr || causticChains; }
    [[nodiscard]] bool causticsShared() const noexcept { return caustic != nullptr && causticChains; }
};

/// How light reaches a vertex: by chance when a direction meets a lamp, by next-event estimation where that can find it,
/// or by both, weighted.
enum class LightStrategy : std::uint8_t { Chance, NextEvent, Both };

struct TransportOptions {
    Directions directions = Directions::Bsdf;
    LightStrategy lights = LightStrategy::Both;
    bool powerHeuristic = true;
    float rouletteThreshold = 1.0F;  ///< 0: no Russian roulette
    int maxDepth = 0;                ///< surface vertices; 0: no limit
    LeftClasses left;                ///< classes that others carry
    bool splitLampChains = false;    ///< E S* L over glass: by LampChains, not by chance
    bool splitGlass = false;         ///< smooth glass seen by the eye: both ways at each interface, not one by chance
};

struct TransportContext {
    const Scene& scene;
    TransportOptions options;
    Maps maps;
};

/// What the first surface shows, for the auxiliary layers.
struct FirstHit {
    Rgb albedo{0.0F};
    glm::vec3 normal{0.0F};
    float depth = 0.0F;          ///< scene units; 0: nothing was hit
    float kernelRadius = 0.0F;   ///< of the caustic look-up, scene units
    float kernelPhotons = 0.0F;  ///< that it met

    /// For means over samples.
    void addShare(const FirstHit& other, float weight) noexcept {
        albedo += other.albedo * weight;
        normal += other.normal * weight;
        depth += other.depth * weight;
        kernelRadius += other.kernelRadius * weight;
        kernelPhotons += other.kernelPhotons * weight;
    }
};

/// What shadow rays to lamps that have an extent met.
struct ShadowTally {
    bool seen = false, hidden = false;
};

/// A D vertex where the eye path ends: where the cache wants a record, a photon is useful.
struct GatherPoint {
    bool valid = false;
    glm::vec3 position{0.0F}, normal{0.0F}, geometricNormal{0.0F};
    glm::vec3 unmappedNormal{0.0F};  ///< the normal without normal maps: a record's
    float footprint = 0.0F;          ///< width of a pixel there, scene units
    Rgb absorption{0.0F};            ///< of the medium in which the gather rays start, per scene unit
    DiffuseLobe lobe;
};

/// Where a surface has a D lobe and others, too, a look for a D vertex ends there (neighbouring pixels do the same), or with the D
/// lobe's share as its chance (every lobe gets its own points).
enum class GatherStop { First, ByChance };

struct PixelKernel {
    float footprints = 1.0F;  ///< radius
    bool edge = false;        ///< it may leave its surface: look how much of it does
};
/// With what an eye path looks up photons: of the caustic map, and of that of all others.
struct PixelKernels {
    PixelKernel caustic, others;
};

/// A ray that carries a footprint and the medium it is in.
struct WalkRay {
    Ray ray;
    float footprintAtOrigin = 0.0F, footprintSpread = 0.0F;  ///< as in CameraRay
    Rgb absorption{0.0F};                                    ///< of the medium, per scene unit
    PixelKernels kernels = {};
};

class Walk {
public:
    explicit Walk(const TransportContext& context) noexcept
        : context_(context), holes_(context.scene.hasHoles()), lampChains_(context.scene, context.options.maxDepth) {}

    /// Radiance along a camera ray, by class. `dimension`s of the sampler from 2 on are used, 8 a vertex. `strings`
    /// receives the same radiance by path string.
    [[nodiscard]] LayeredRadiance fromEye(const WalkRay& ray, Sampler& sampler, FirstHit* first = nullptr,
                                          StringSums* strings = nullptr) noexcept;

    /// Radiance that arrives at a D vertex along a gather ray, without direct light and without what the caustic map holds.
    /// `distance` receives the length to the first surface (infinity: none).
    [[nodiscard]] Rgb gather(const WalkRay& ray, Sampler& sampler, float& distance) noexcept;

    /// Follows S and G lobes to a D vertex. `beyond` receives those that lie behind it, over its surface's other lobes.
    [[nodiscard]] GatherPoint findGatherPoint(const WalkRay& ray, Sampler& sampler, GatherStop stop = GatherStop::First,
                                              std::vector<GatherPoint>* beyond = nullptr);

    /// From now on every vertex is written down there (null: no longer).
    void writeTo(WalkTrace* trace) noexcept { trace_ = trace; }

    /// From now on what look-ups of photons meet is added there (null: no longer).
    void tallyTo(PhotonTally* tally) noexcept { tally_ = tally; }

    /// From now on receivers whose other light the maps serve sample the lamps so many times; what the shadow rays meet is
    /// told there (null: nobody asks).
    void sampleLamps(int times, ShadowTally* shadows) noexcept { lampSamples_ = times, shadows_ = shadows; }

    [[nodiscard]] std::uint64_t rays() const noexcept { return rays_ + lampChains_.rays(); }
    [[nodiscard]] std::uint64_t cacheMisses() const noexcept { return cacheMisses_; }

private:
    struct State;
    struct Vertex;
    struct Branches;
    void run(State& state, Sampler& sampler, FirstHit* first, float* firstDistance) noexcept;
    [[nodiscard]] bool step(State& state, Branches& branches, Sampler& sampler, FirstHit* first,
                            float* firstDistance) noexcept;
    static void takeWavelength(State& state, Sampler& sampler) noexcept;
    [[nodiscard]] bool splits(const State& state) const noexcept;
    [[nodiscard]] bool split(State& state, const Vertex& vertex, Sampler& sampler, Branches& branches) noexcept;
    void leave(State& state, const Vertex& vertex, const BsdfSample& sample) noexcept;
    [[nodiscard]] bool goOn(State& state, const Vertex& vertex, const BsdfSample& sample, Sampler& sampler) noexcept;
    [[nodiscard]] float chainShare(const State& state, std::uint32_t light, const glm::vec3& towards) const noexcept;
    void addEscaped(State& state) const noexcept;
    void addEmitted(State& state, const SurfaceHit& hit) const noexcept;
    [[nodiscard]] LobeKinds serveDiffuse(State& state, const Vertex& vertex, Sampler& sampler,
                                         FirstHit* first) noexcept;
    [[nodiscard]] std::array<Rgb, 3> lobesTowards(const Vertex& vertex, LobeKinds kinds, LobeKinds sampled,
                                                  const LightSample& light) const noexcept;
    [[nodiscard]] bool resampleEnvironment(const Vertex& vertex, LobeKinds kinds, LobeKinds sampled,
                                           const LightPick& sky, const glm::vec2& u, Sampler& sampler,
                                           LightSample& seen, std::array<Rgb, 3>& lobes) const noexcept;
    void addDirect(State& state, const Vertex& vertex, LobeKinds kinds, LobeKinds sampled, Sampler& sampler) noexcept;
    void addSplitDirect(State& state, const Vertex& vertex, LobeKinds kinds, LobeKinds sampled,
                        const Sampler& sampler) noexcept;
    [[nodiscard]] std::optional<BsdfSample> choose(const Vertex& vertex, LobeKinds sampled, Sampler& sampler) noexcept;
    [[nodiscard]] bool scatter(State& state, const Vertex& vertex, LobeKinds sampled, Sampler& sampler) noexcept;
    [[nodiscard]] float misWeight(float mine, float other) const noexcept;
    /// Of a lamp that a sampled direction met; `pdfLight`: that of next-event estimation.
    [[nodiscard]] float hitWeight(float pdfSampled, float pdfLight) const noexcept;

    void write(const State& state, const SurfaceHit* hit, const Bsdf* bsdf) const;

    void addOthers(State& state, const Vertex& vertex, const Rgb& outgoing, float turn) noexcept;
    /// The part of a kernel that lies on the surface, where `edge` says that it may leave it.
    [[nodiscard]] float massOf(bool edge, const CausticMap& map, const PhotonEstimate& found, const Vertex& vertex,
                               float radius, float turn) noexcept;

    const TransportContext& context_;
    bool holes_;
    LampChains lampChains_;
    WalkTrace* trace_ = nullptr;
    PhotonTally* tally_ = nullptr;
    int lampSamples_ = 1;
    ShadowTally* shadows_ = nullptr;
    std::uint64_t rays_ = 0, cacheMisses_ = 0;
};

/// The part of a shadow ray's way that is tested: it ends short of the light by the rounding of both ends.
[[nodiscard]] inline float shadowLength(float distance) noexcept { return distance * (1.0F - 1e-5F) - 4e-5F; }

/// The shadow ray from a surface point to a light sample, aimed from the offset origin at the very point that was sampled:
/// along wi itself the ray would run beside it and meet the lamp early where it leaves the lamp at a flat angle.
[[nodiscard]] inline Ray shadowRay(const glm::vec3& position, const glm::vec3& side, const glm::vec3& wi,
                                   float distance) noexcept {
    Ray ray{offsetOrigin(position, side), wi, distance};
    if (!std::isfinite(distance)) return ray;
    const glm::vec3 to = position + wi * distance - ray.origin;
    const float length = glm::length(to);
    if (length > 0.0F) ray.direction = to / length;
    ray.tMax = shadowLength(length);
    return ray;
}

}  // namespace pellucid

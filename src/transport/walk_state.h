/// What a walk knows on its way, and the vertex where it stands. Private to the room.
#pragma once

#include <cstdint>
#include <vector>

#include <pellucid/transport/walk.h>

namespace pellucid {

/// How light behind the last D vertex is carried.
enum class Behind : std::uint8_t {
    NoReceiver,     ///< no D vertex yet
    CausticMapped,  ///< the caustic map holds what comes over S alone
    PathTraced      ///< everything is path traced
};

/// Whether D light is looked for at lamps alone: no direction of that lobe is sampled, as maps serve the rest.
[[nodiscard]] constexpr bool leavesDiffuse(LobeKinds direct, LobeKinds sampled) noexcept {
    return (direct & ~static_cast<unsigned>(sampled) & kDiffuse) != 0U;
}

struct Walk::State {
    WalkRay ray;
    LayeredRadiance radiance;
    Rgb throughput{1.0F};
    EyeLedger ledger;
    Behind behind = Behind::NoReceiver;
    bool chainEmpty = true, chainSpecular = true;  ///< since the last D vertex (or the eye)
    bool lampSampled = false;    ///< the last vertex did next-event estimation for the lobe that was sampled
    bool skipDirect = false;     ///< a lamp met at once is counted elsewhere
    float pdfSolidAngle = 0.0F;  ///< of the direction, over the sampled lobes
    glm::vec3 lightPoint{0.0F}, lightNormal{0.0F};  ///< where next-event estimation stood
    float etaScale = 1.0F, pathLength = 0.0F;
    Wave wave;  ///< of this chain of delta lobes
    int vertices = 0;
    std::uint64_t dimensions = 0;  ///< of the sampler, to leave out: other branches have them
    bool gathering = false;        ///< behind the first D vertex: the global map may answer
    bool deltaChain = true;        ///< from the eye: no other lobe so far
    bool lampsFollowed = false;    ///< over that chain, by LampChains
    bool chainsNext = false;       ///< at this D vertex: the cache has served all but the caustics
    bool sharedNext = false;       ///< at this D vertex: photons have brought their share of the caustics
    bool onlyChains = false;       ///< behind it: S lobes alone go on
    bool chainsShared = false;     ///< behind it: what comes over S alone has the eye's share only
    float kernelRadius = 0.0F;     ///< at that D vertex
    bool causticServed = false;    ///< at this D vertex: what comes over S alone is counted

    /// Goes on over a lobe of this kind.
    void pass(LobeKinds kind) noexcept {
        ledger.pass(kind);
        if (kind != kDiffuse) {
            chainEmpty = false;
            chainSpecular = chainSpecular && kind == kSpecular;
            return;
        }
        behind = causticServed && !sharedNext ? Behind::CausticMapped : Behind::PathTraced;
        chainsShared = sharedNext;
        chainEmpty = chainSpecular = true;
        gathering = true;
        skipDirect = false;
        onlyChains = chainsNext;
    }
    /// Whether light that is met now has come over S alone to a receiver whose caustics photons share.
    [[nodiscard]] bool hasSharedChain() const noexcept { return chainsShared && chainSpecular && !chainEmpty; }
    /// Whether a lamp that is met now belongs to path tracing.
    [[nodiscard]] bool lampCounts(const LeftClasses& left) const noexcept {
        if (left.has(ledger.path()) || (deltaChain && lampsFollowed)) return false;
        if (chainEmpty) return !skipDirect;
        return behind != Behind::CausticMapped || !chainSpecular;
    }
};

/// Of one walk over smooth glass.
struct Walk::Branches {
    std::vector<State> waiting;
    std::uint64_t made = 0;
};

struct Walk::Vertex {
    const SurfaceHit& hit;
    const Bsdf& bsdf;
    glm::vec3 wo;
    float footprint;
    glm::vec3 lightNormal;  ///< horizon for light sampling; zero where light may come from behind
};

}  // namespace pellucid

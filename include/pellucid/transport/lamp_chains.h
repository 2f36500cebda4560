/// Lamps seen over chains of delta lobes, E S* L: where an interface both reflects and refracts, both ways are followed
/// (splitting, [ArvoKirk1990]) until Russian roulette ends the dim ones. A path that chooses one way by Fresnel's chance
/// meets a lamp's faint reflection rarely and then at full strength, a firefly; a split one meets it each time, faintly.
/// Unbiased. Such a chain costs rays alone: no light is sampled and no map asked along it.
#pragma once

#include <cstdint>
#include <vector>

#include <pellucid/math/sampler.h>
#include <pellucid/scene/scene.h>
#include <pellucid/transport/path_classes.h>

namespace pellucid {

/// A surface that the eye sees over delta lobes alone.
struct ChainVertex {
    const SurfaceHit& hit;
    const Bsdf& bsdf;
    glm::vec3 wo;
    Rgb throughput;  ///< up to the hit
    Rgb absorption;  ///< of the medium on wo's side
    float etaScale;
    PathString path;  ///< the vertices before this one
    int vertices;     ///< this one included
    Wave wave;        ///< at which `bsdf` is
};

class LampChains {
public:
    /// `maxDepth`: surface vertices of the longest chain; 0: no limit.
    LampChains(const Scene& scene, int maxDepth) noexcept : scene_(scene), maxDepth_(maxDepth) {}

    /// Adds all that comes from lamps and environment over delta lobes at `vertex` and behind it, and returns true; where
    /// the chain does not split there (fewer than two delta branches) does nothing. Draws from dimensions of its own.
    [[nodiscard]] bool follow(const ChainVertex& vertex, Sampler& sampler, LayeredRadiance& sum);

    [[nodiscard]] std::uint64_t rays() const noexcept { return rays_; }

private:
    struct Branch {
        Ray ray;
        Rgb throughput, absorption;
        float etaScale;
        PathString path;  ///< the vertices before this one
        int vertices;
        Wave wave;
    };
    void branchOff(const ChainVertex& vertex, const DeltaBranches& branches, Sampler& sampler);

    const Scene& scene_;
    int maxDepth_;
    std::vector<Branch> waiting_;
    std::uint64_t rays_ = 0;
};

}  // namespace pellucid

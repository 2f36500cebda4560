/// Where the light comes from that a gather measures: photons of the global pass that arrived near a point tell by which strata
/// of its hemisphere. [Jensen1995] draws gather rays from such a histogram; here the strata stay, as gradients and Hessian want
/// them, and those that many photons came through get more rays: a bright spot seen through a glass ball fills a part of one
/// stratum that a single ray mostly misses. The rays know nothing of the photons' noise, so nothing is biased.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <pellucid/base/parallel.h>
#include <pellucid/math/frame.h>
#include <pellucid/transport/gather_strata.h>
#include <pellucid/transport/radiance_map.h>

namespace pellucid {

class GatherGuide {
public:
    static constexpr std::uint8_t kMostRays = 32;  ///< a stratum

    /// Of a pass, the photons that came neither directly nor over S alone: the class that gather rays carry. They are looked
    /// for as far away as `farthest`, scene units.
    GatherGuide(const std::vector<GlobalPhoton>& photons, float farthest, const Workers& workers);
    ~GatherGuide();

    /// How many rays each stratum gets, at least 1.
    [[nodiscard]] std::vector<std::uint8_t> rays(const glm::vec3& position, const Frame& frame,
                                                 const GatherStrata& strata) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid

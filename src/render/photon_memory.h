/// photon.memory: how many photon paths fit. The passes are sized by it; no photon that was made is ever dropped for it.
#pragma once

#include <cstdint>
#include <string>

#include <pellucid/render/plan.h>

namespace pellucid {

/// Paths that were wanted, made fewer where they would not fit, and a remark for the plan (empty: all fit).
struct FittedPaths {
    std::uint32_t paths = 0, most = 0;  ///< most: that would fit; 0: no limit
    std::string remark;
};

[[nodiscard]] FittedPaths fitCausticPaths(std::uint32_t wanted, const Plan& plan, const Scene& scene,
                                          const RenderRequest& request, const Survey& seen, const Workers& workers);
/// The same for what progressive photon mapping keeps beside the caustics, with the other half of the memory.
[[nodiscard]] FittedPaths fitOtherPaths(std::uint32_t wanted, const Scene& scene, const RenderRequest& request,
                                        const Survey& seen, const Workers& workers);

[[nodiscard]] FittedPaths fitGlobalPaths(std::uint32_t wanted, const Plan& plan, const Scene& scene,
                                         const RenderRequest& request, const Workers& workers);

}  // namespace pellucid

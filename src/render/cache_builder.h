/// Fills an irradiance cache for one view in batch-synchronous rounds, coarse to fine: misses are marked against the frozen
/// cache, their records computed in parallel and inserted in one order. The same bits at any number of threads. With the
/// records of other views to start from only what they do not cover is gathered, and where they are too coarse for this one.
/// Where nearly every pixel wants a record of its own (fine leaves, bumpy normals) the rounds stop: a record of n rays that
/// serves one pixel costs what n samples of that pixel cost, so those pixels gather for themselves, without bias.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <pellucid/render/plan.h>
#include <pellucid/transport/gather_guide.h>
#include <pellucid/transport/irradiance_cache.h>

namespace pellucid {

struct CacheBuild {
    std::unique_ptr<IrradianceCache> cache;
    std::uint64_t rays = 0;
    std::size_t gathered = 0;         ///< records made, with those that others of their batch made needless
    std::vector<std::uint8_t> plain;  ///< by pixel: left to plain gather, records would serve hardly a pixel each
};

/// `known`: records to start from, none where empty, that `views` have made. `size` gives Ward's a of this generation; look-ups
/// while rendering use a little more, so that few points miss. `guide`: see GatherOptions.
[[nodiscard]] CacheBuild buildCache(const TransportContext& context, const Survey& seen, int width, const Plan& plan,
                                    const GenerationSize& size, std::uint64_t seed, const GatherGuide* guide,
                                    const Workers& workers, const std::function<bool()>& stop,
                                    std::unique_ptr<IrradianceCache> known = nullptr, std::uint32_t views = 0);

}  // namespace pellucid

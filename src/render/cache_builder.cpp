#include "cache_builder.h"

#include <algorithm>
#include <numeric>

#include <pellucid/transport/final_gather.h>

namespace pellucid {

namespace {

constexpr int kCoarsestStride = 16;
/// The cache is filled to error a and read at a times this: a point between filled ones still finds a record.
constexpr float kReadSlack = 1.25F;
/// A round is computed in batches, each against the records of those before it.
constexpr std::size_t kFirstBatch = 64;
/// A record of another view covers no point that would have made it so many times smaller.
constexpr float kCoarser = 3.0F;

/// Pixels of this round: on the grid of `stride` but not on the coarser one, in an order that a hash scatters.
[[nodiscard]] std::vector<std::uint32_t> candidates(const Survey& seen, int width, int stride, std::uint64_t seed) {
    std::vector<std::uint32_t> pixels;
    for (std::uint32_t i = 0; i < seen.points.size(); ++i) {
        const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
        if (x % stride != 0 || y % stride != 0 || !seen.points[i].valid) continue;
        const bool coarser = stride < kCoarsestStride && x % (2 * stride) == 0 && y % (2 * stride) == 0;
        if (!coarser) pixels.push_back(i);
    }
    std::sort(pixels.begin(), pixels.end(),
              [seed](std::uint32_t a, std::uint32_t b) { return hashCombine(seed, a) < hashCombine(seed, b); });
    return pixels;
}

}  // namespace

CacheBuild buildCache(const TransportContext& context, const Survey& seen, int width, const Plan& plan,
                      const GenerationSize& size, std::uint64_t seed, const Workers& workers,
                      const std::function<bool()>& stop, std::unique_ptr<IrradianceCache> known) {
    CacheBuild build;
    const float error = size.cacheError, read = error * kReadSlack;
    build.cache = known ? std::move(known) : std::make_unique<IrradianceCache>(context.scene.bounds(), read);
    IrradianceCache& cache = *build.cache;
    const std::size_t old = cache.records().size();
    for (int stride = kCoarsestStride; stride >= 1; stride /= 2) {
        const std::vector<std::uint32_t> round = candidates(seen, width, stride, seed);
        std::size_t done = 0, batch = kFirstBatch;
        while (done < round.size()) {
            if (stop()) return build;
            const std::size_t end = std::min(round.size(), done + batch);
            std::vector<std::uint8_t> missed(end - done, 0);
            workers.forEach(end - done, 64, [&](std::size_t i) {
                const GatherPoint& p = seen.points[round[done + i]];
                const float largest = kCoarser * plan.maxSpacing * p.footprint / error;
                missed[i] = cache.covers(p.position, p.normal, error, old, largest) ? 0 : 1;
            });
            std::vector<std::uint32_t> misses;
            for (std::size_t i = 0; i < missed.size(); ++i)
                if (missed[i] != 0) misses.push_back(round[done + i]);
            std::vector<IrradianceRecord> records(misses.size());
            std::vector<std::uint64_t> rays(misses.size(), 0);
            workers.forEach(misses.size(), 1, [&](std::size_t i) {
                const GatherPoint& p = seen.points[misses[i]];
                Walk walk(context);
                const GatherOptions options{size.gatherRays, plan.minSpacing * p.footprint / error,
                                            plan.maxSpacing * p.footprint / error, seed};
                records[i] = gatherRecord(walk, p, options, misses[i]);
                rays[i] = walk.rays();
            });
            for (std::size_t i = 0; i < records.size(); ++i) {
                const IrradianceRecord& r = records[i];
                const float largest = kCoarser * plan.maxSpacing * seen.points[misses[i]].footprint / error;
                if (!cache.covers(r.position, r.normal, error * 0.7F, old, largest)) cache.insert(r);
            }
            build.rays += std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
            // Grow the batch as the cache fills: late rounds have few misses among many candidates.
            const bool sparse = misses.size() * 8 < end - done;
            done = end;
            batch = std::min<std::size_t>(sparse ? batch * 4 : batch * 3 / 2, 65536);
        }
    }
    return build;
}

}  // namespace pellucid

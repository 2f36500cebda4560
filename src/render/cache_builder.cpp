#include "cache_builder.h"

#include <algorithm>
#include <cmath>
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
/// Of the error: a record that others of its batch serve within this is not inserted.
constexpr float kNearInBatch = 0.7F;

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

/// Where records do not pay: the image in blocks, each closed when its records of a fine round serve too few pixels.
class BlockChoice {
public:
    BlockChoice(const Survey& seen, int width, const Plan& plan)
        : width_(width),
          across_((width + kBlock - 1) / kBlock),
          active_(plan.cacheChoice),
          finest_(plan.minSpacing / std::sqrt(2.0F)),
          blocks_(static_cast<std::size_t>(across_) *
                  (seen.points.size() / static_cast<std::size_t>(width * kBlock) + 1)) {}

    [[nodiscard]] bool isClosed(std::uint32_t pixel) const noexcept { return blocks_[blockOf(pixel)].closed; }

    /// What a batch of `round` (from `begin` to `end`) has made: `made` are pixels that wanted a record.
    void learn(const std::vector<std::uint32_t>& round, std::size_t begin, std::size_t end,
               const std::vector<std::uint32_t>& made, int stride) {
        if (!active_ || static_cast<float>(stride) > finest_) return;
        for (std::size_t i = begin; i < end; ++i) ++blocks_[blockOf(round[i])].asked;
        for (const std::uint32_t pixel : made) ++blocks_[blockOf(pixel)].made;
        for (Block& b : blocks_)
            b.closed = b.closed || (b.asked >= kLeastAsked && b.made > kMostShare * static_cast<float>(b.asked));
    }

    [[nodiscard]] std::vector<std::uint8_t> pixels(std::size_t count) const {
        std::vector<std::uint8_t> closed(count, 0);
        for (std::uint32_t i = 0; i < count; ++i) closed[i] = isClosed(i) ? 1 : 0;
        return closed;
    }

private:
    struct Block {
        std::uint32_t asked = 0;
        float made = 0.0F;
        bool closed = false;
    };
    static constexpr int kBlock = 16;
    /// A block is judged after so many candidates of its fine rounds: a quarter of those of stride 2.
    static constexpr std::uint32_t kLeastAsked = 12;
    /// With f the share of points that want a record of their own, a record serves 1 / f pixels, and of the samples between
    /// pixel centres 1 - f find one: gather rays gain (1 - f) / f over those of plain gather, nothing from a half on.
    static constexpr float kMostShare = 0.5F;

    [[nodiscard]] std::size_t blockOf(std::uint32_t pixel) const noexcept {
        const int x = static_cast<int>(pixel) % width_, y = static_cast<int>(pixel) / width_;
        return static_cast<std::size_t>(y / kBlock * across_ + x / kBlock);
    }

    int width_, across_;
    bool active_;
    float finest_;  ///< pixels: on a smooth surface points so near to each other share even the smallest record
    std::vector<Block> blocks_;
};

/// Of the misses, in order, those that no earlier one is sure to cover: every record speaks as far as its least radius.
[[nodiscard]] std::vector<std::uint32_t> thinned(const std::vector<std::uint32_t>& misses, const Survey& seen,
                                                 const Bounds& bounds, CacheMetric metric, const GenerationSize& size) {
    const float error = size.cacheError;
    IrradianceCache sure(bounds, error, metric);
    std::vector<std::uint32_t> kept;
    for (const std::uint32_t pixel : misses) {
        const GatherPoint& p = seen.points[pixel];
        if (sure.covers(p.position, p.unmappedNormal, error * kNearInBatch)) continue;
        kept.push_back(pixel);
        IrradianceRecord record;
        record.position = p.position;
        record.normal = p.unmappedNormal;
        record.radius = size.minSpacing * p.footprint / error;
        if (record.radius > 0.0F) sure.adopt(record, record.radius * error);
    }
    return kept;
}

}  // namespace

CacheBuild buildCache(const TransportContext& context, const Survey& seen, int width, const Plan& plan,
                      const GenerationSize& size, std::uint64_t seed, const GatherGuide* guide, const Workers& workers,
                      const std::function<bool()>& stop, std::unique_ptr<IrradianceCache> known, std::uint32_t views) {
    CacheBuild build;
    const float error = size.cacheError, read = error * kReadSlack;
    build.cache =
        known ? std::move(known)
              : std::make_unique<IrradianceCache>(context.scene.bounds(), read, plan.cacheMetric, &context.scene);
    IrradianceCache& cache = *build.cache;
    const std::size_t old = cache.records().size();
    const bool mapped = context.scene.surfaces().mapsDiffuseNormals();
    BlockChoice choice(seen, width, plan);
    for (int stride = kCoarsestStride; stride >= 1; stride /= 2) {
        const std::vector<std::uint32_t> round = candidates(seen, width, stride, seed);
        std::size_t done = 0, batch = kFirstBatch;
        while (done < round.size()) {
            if (stop()) break;
            const std::size_t end = std::min(round.size(), done + batch);
            std::vector<std::uint8_t> missed(end - done, 0);
            workers.forEach(end - done, 64, [&](std::size_t i) {
                const GatherPoint& p = seen.points[round[done + i]];
                if (choice.isClosed(round[done + i])) return;
                const float largest = kCoarser * plan.maxSpacing * p.footprint / error;
                missed[i] = cache.covers(p.position, p.unmappedNormal, error, old, largest) ? 0 : 1;
            });
            std::vector<std::uint32_t> misses;
            for (std::size_t i = 0; i < missed.size(); ++i)
                if (missed[i] != 0) misses.push_back(round[done + i]);
            const std::size_t missing = misses.size();
            misses = thinned(misses, seen, context.scene.bounds(), plan.cacheMetric, size);
            std::vector<IrradianceRecord> records(misses.size());
            std::vector<LightByDirection> lights(mapped ? misses.size() : 0);
            std::vector<std::uint64_t> rays(misses.size(), 0);
            workers.forEach(misses.size(), 1, [&](std::size_t i) {
                const GatherPoint& p = seen.points[misses[i]];
                Walk walk(context);
                const GatherOptions options{size.gatherRays,
                                            size.minSpacing * p.footprint / error,
                                            plan.maxSpacing * p.footprint / error,
                                            seed,
                                            plan.cacheMetric,
                                            context.scene.radius(),
                                            read,
                                            guide};
                records[i] = gatherRecord(walk, p, options, misses[i], mapped ? &lights[i] : nullptr);
                rays[i] = walk.rays();
            });
            for (std::size_t i = 0; i < records.size(); ++i) {
                IrradianceRecord& r = records[i];
                r.born = views;
                const float largest = kCoarser * plan.maxSpacing * seen.points[misses[i]].footprint / error;
                if (!cache.covers(r.position, r.normal, error * kNearInBatch, old, largest))
                    cache.insert(r, mapped ? &lights[i] : nullptr);
            }
            build.gathered += records.size();
            choice.learn(round, done, end, misses, stride);
            build.rays += std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
            // Grow the batch as the cache fills: late rounds have few misses among many candidates.
            const bool sparse = missing * 8 < end - done;
            done = end;
            batch = std::min<std::size_t>(sparse ? batch * 4 : batch * 3 / 2, 65536);
        }
    }
    build.plain = choice.pixels(seen.points.size());
    return build;
}

}  // namespace pellucid

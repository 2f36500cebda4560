/// What the cache's records have in common over all samples does not show between the halves of a render's samples: each record
/// carries a draw of its error along, and the error estimate knows it.
#include <cmath>
#include <cstdio>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>

#include "../support/files.h"
#include "small_scenes.h"

namespace pellucid {
namespace {

using namespace testing;

constexpr int kSeeds = 10;

/// Relative variance over the seeds, on the mean over the pixels, as relmse counts it; and the mean of the estimates' squares.
struct Spread {
    double variance = 0.0, noise = 0.0, records = 0.0;
};

[[nodiscard]] Spread spreadOf(const Scene& scene, int gatherRays, const Workers& workers) {
    Spread spread;
    std::vector<double> sum, square;
    for (int k = 0; k < kSeeds; ++k) {
        RenderRequest request;
        request.width = 32;
        request.height = 24;
        request.seed = static_cast<std::uint64_t>(k) + 1;
        request.budget.samples = 64;
        request.settings.gatherRays = gatherRays;
        const RenderResult result = render(scene, request, workers);
        const Image& image = result.image;
        sum.resize(image.pixels());
        square.resize(image.pixels());
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const auto y = static_cast<double>(image.at(i, 1));
            sum[i] += y / kSeeds;
            square[i] += y * y / kSeeds;
        }
        spread.noise += std::pow(result.record.noiseEstimate, 2.0) / kSeeds;
        spread.records += std::pow(result.record.recordsEstimate, 2.0) / kSeeds;
    }
    const auto pixels = static_cast<double>(sum.size());
    const double mean = std::accumulate(sum.begin(), sum.end(), 0.0) / pixels;
    for (std::size_t i = 0; i < sum.size(); ++i)
        spread.variance +=
            (square[i] - sum[i] * sum[i]) * kSeeds / (kSeeds - 1.0) / (sum[i] * sum[i] + 0.01 * mean * mean) / pixels;
    return spread;
}

TEST(RecordNoise, IsPartOfTheErrorEstimate) {
    const Workers workers;
    const Scene scene(roomLitByItsCeiling(), std::nullopt, SceneOptions{}, workers);
    for (const int rays : {24, 48}) {
        const Spread s = spreadOf(scene, rays, workers);
        std::printf("%d rays a record: variance %.2e, estimated %.2e + %.2e\n", rays, s.variance, s.noise, s.records);
        EXPECT_LT(s.noise, 0.5 * s.variance) << rays << " rays: the test would not see whether records count";
        // The estimate's promise is a factor of 1.5 of the error.
        EXPECT_GT(s.noise + s.records, s.variance / (1.5 * 1.5)) << rays;
        EXPECT_LT(s.noise + s.records, s.variance * (1.5 * 1.5)) << rays;
    }
}

/// A limit of rays that leaves no time for a second generation: the first one's records get more rays of the same map. What
/// a checkpoint brings back are those records, not the noisier ones that they replaced.
TEST(RecordNoise, RefinesRecordsThatNoNextGenerationWillReplace) {
    const Workers workers(2);
    const Scene scene(roomLitByItsCeiling(), std::nullopt, SceneOptions{}, workers);
    const test::TemporaryFolder folder;
    RenderRequest request;
    request.width = 64;
    request.height = 48;
    request.budget.rays = 1'000'000;
    request.checkpoint = folder / "checkpoint";
    request.pointsFolder = folder / "first";
    const RenderResult first = render(scene, request, workers);
    RenderRequest plain;
    plain.width = request.width;
    plain.height = request.height;
    plain.budget = request.budget;
    plain.settings.gatherRays = 128;  // what the plan begins with, and no others
    EXPECT_LT(first.record.recordsEstimate, 0.7 * render(scene, plain, workers).record.recordsEstimate);
    request.budget.samples = 1;  // there are more already
    request.resume = true;
    request.pointsFolder = folder / "again";
    const RenderResult again = render(scene, request, workers);
    EXPECT_TRUE(test::bytesOf(folder / "first" / "records.ply") == test::bytesOf(folder / "again" / "records.ply"));
    EXPECT_EQ(again.record.recordsEstimate, first.record.recordsEstimate);
}

}  // namespace
}  // namespace pellucid

/// The irradiance cache: look-ups a second over caches of 1e3 to 1e5 records, inserts a second, and whole records (gather of
/// 256 rays, then insert) a second in a small room.
#include <cmath>
#include <cstdint>
#include <random>

#include <benchmark/benchmark.h>

#include <pellucid/transport/final_gather.h>
#include <pellucid/transport/irradiance_cache.h>

#include "../../src/study/check_scenes.h"

namespace pellucid {
namespace {

constexpr float kError = 0.25F;
/// A record's disc has this many others' centres in it, about as in a picture.
constexpr double kOverlap = 4.0;

[[nodiscard]] Bounds unitBox() {
    Bounds b;
    b.extend(glm::vec3(0.0F));
    b.extend(glm::vec3(1.0F));
    return b;
}

[[nodiscard]] IrradianceRecord recordAt(float x, float y, float radius) {
    IrradianceRecord r;
    r.position = {x, y, 0.5F};
    r.normal = {0.0F, 0.0F, 1.0F};
    r.irradiance = Rgb(1.0F);
    r.harmonicDistance = r.radius = radius;
    return r;
}

/// `count` records over a unit square.
[[nodiscard]] IrradianceCache cacheOf(std::size_t count) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> u(0.0F, 1.0F);
    const auto radius = static_cast<float>(std::sqrt(kOverlap / (3.14159265 * static_cast<double>(count)))) / kError;
    IrradianceCache cache(unitBox(), kError, CacheMetric::Hessian);
    for (std::size_t i = 0; i < count; ++i) cache.insert(recordAt(u(random), u(random), radius));
    return cache;
}

void insert(benchmark::State& state) {
    const auto count = static_cast<std::size_t>(state.range(0));
    for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(cacheOf(count).records().size());
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

void lookup(benchmark::State& state) {
    const IrradianceCache cache = cacheOf(static_cast<std::size_t>(state.range(0)));
    constexpr std::uint32_t kSide = 512;
    std::uint32_t i = 0;
    std::int64_t spoke = 0;
    for ([[maybe_unused]] auto _ : state) {
        const glm::vec3 at(static_cast<float>(i % kSide) / kSide, static_cast<float>(i / kSide % kSide) / kSide, 0.5F);
        ++i;
        const auto found = cache.lookup(at, {0.0F, 0.0F, 1.0F});
        if (found) spoke += found->records;
        benchmark::DoNotOptimize(spoke);
    }
    state.SetItemsProcessed(state.iterations());
    state.counters["records_that_speak"] = static_cast<double>(spoke) / static_cast<double>(state.iterations());
}

/// A closed room with a lamp and a block, gathered by path tracing to the end: no photon map behind it.
void record(benchmark::State& state) {
    check::SceneBuilder b;
    b.box({0, 0, 0}, {2, 2, 2}, check::lambert(0.6F), true);
    b.box({0.3, 0, 0.3}, {0.9, 0.8, 0.9}, check::lambert(0.5F));
    b.square({1.0, 1.99, 1.0}, {0, -1, 0}, 0.3, check::lamp(8.0F));
    b.perspective({1.0, 1.0, 1.95}, {1, 0.8, 0}, 0.9);
    const Workers workers(1);
    const Scene scene(b.description(), std::nullopt, {}, workers);
    const Camera camera = scene.camera("", 64, 64);
    const TransportContext context{scene, {}, {}};
    Walk walk(context);
    std::vector<GatherPoint> points;
    for (int i = 0; i < 64 * 64; ++i) {
        Sampler sampler(1, static_cast<std::uint64_t>(i), 0);
        const CameraRay ray =
            camera.ray({static_cast<float>(i % 64) + 0.5F, static_cast<float>(i / 64) + 0.5F}, {0.5F, 0.5F});
        const GatherPoint p = walk.findGatherPoint({ray.ray, ray.footprintAtOrigin, ray.footprintSpread}, sampler);
        if (p.valid) points.push_back(p);
    }
    GatherOptions options;
    options.rays = 256;
    options.metric = CacheMetric::Hessian;
    options.sceneRadius = scene.radius();
    const std::uint64_t before = walk.rays();
    std::uint64_t key = 0;
    for ([[maybe_unused]] auto _ : state) {
        benchmark::DoNotOptimize(gatherRecord(walk, points[key * 37 % points.size()], options, key));
        ++key;
    }
    state.SetItemsProcessed(state.iterations());
    state.counters["rays"] = benchmark::Counter(static_cast<double>(walk.rays() - before), benchmark::Counter::kIsRate);
}

BENCHMARK(insert)->Arg(1000)->Arg(10'000)->Arg(100'000)->Unit(benchmark::kMillisecond);
BENCHMARK(lookup)->Arg(1000)->Arg(10'000)->Arg(100'000);
BENCHMARK(record)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pellucid

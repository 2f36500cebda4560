/// The photon tree: build, and look-ups that accumulate within the search against lists of the k nearest and of all within a
/// radius, with the same nanoflann tree under each, and against a grid of cells of two radii made by a counting sort. A look-up
/// meets about kWanted photons. Bytes a photon are what the heap holds after the build. 1e7 photons with `--large` (2 GB).
#include <malloc.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string_view>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <pellucid/transport/caustic_map.h>

#include "../../src/transport/photon_tree.h"

namespace pellucid {
namespace {

constexpr double kWanted = 50.0;
const glm::vec3 kUp(0.0F, 0.0F, 1.0F);

/// Even on a unit square with a little height, in random order as paths leave them.
[[nodiscard]] PhotonList photonsOnAFloor(std::size_t count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> u(0.0F, 1.0F);
    PhotonList photons(count);
    for (Photon& p : photons) {
        p.position = {u(random), u(random), 1e-6F * u(random)};
        p.wi = p.normal = kUp;
        p.flux = Rgb(1.0F / static_cast<float>(count));
    }
    return photons;
}

[[nodiscard]] float radiusFor(std::size_t count) {
    return static_cast<float>(std::sqrt(kWanted / (3.14159265 * static_cast<double>(count))));
}

[[nodiscard]] double heapBytes() {
    const struct mallinfo2 info = mallinfo2();
    return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

/// Query points row by row, as pixels ask.
class Queries {
public:
    [[nodiscard]] glm::vec3 next() noexcept {
        constexpr std::uint32_t kSide = 512;
        const std::uint32_t i = at_++ % (kSide * kSide);
        return {0.05F + 0.9F * static_cast<float>(i % kSide) / kSide,
                0.05F + 0.9F * static_cast<float>(i / kSide) / kSide, 0.0F};
    }

private:
    std::uint32_t at_ = 0;
};

struct PlainTree {
    PhotonList photons;
    PointTree<Photon> tree;
    explicit PlainTree(PhotonList list) : photons(std::move(list)), tree(photons) {}
};

/// Made once for each count: the last one is kept.
[[nodiscard]] const CausticMap& mapOf(std::size_t count) {
    static std::size_t made = 0;
    static std::unique_ptr<CausticMap> map;
    if (made != count) map = std::make_unique<CausticMap>(photonsOnAFloor(count)), made = count;
    return *map;
}

[[nodiscard]] const PlainTree& treeOf(std::size_t count) {
    static std::size_t made = 0;
    static std::unique_ptr<PlainTree> tree;
    if (made != count) {
        PhotonList photons = photonsOnAFloor(count);
        sortAlongMortonCurve(photons);
        tree = std::make_unique<PlainTree>(std::move(photons));
        made = count;
    }
    return *tree;
}

void build(benchmark::State& state) {
    const auto count = static_cast<std::size_t>(state.range(0));
    double bytes = 0.0;
    for ([[maybe_unused]] auto _ : state) {
        state.PauseTiming();
        const double before = heapBytes();
        PhotonList photons = photonsOnAFloor(count);
        state.ResumeTiming();
        const CausticMap map(std::move(photons));
        benchmark::DoNotOptimize(map.size());
        state.PauseTiming();
        bytes = heapBytes() - before;
        state.ResumeTiming();
    }
    state.counters["bytes_a_photon"] = bytes / static_cast<double>(count);
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

void accumulate(benchmark::State& state) {
    const auto count = static_cast<std::size_t>(state.range(0));
    const CausticMap& map = mapOf(count);
    const float radius = radiusFor(count);
    const DiffuseLobe lobe{Rgb(1.0F)};
    Queries queries;
    for ([[maybe_unused]] auto _ : state)
        benchmark::DoNotOptimize(map.estimate({queries.next(), kUp, kUp, lobe, radius}));
    state.SetItemsProcessed(state.iterations());
}

/// One photon of a list, with all that CausticMap does to it: rejects, transmittance, kernel, and the kernel of half the area.
struct ListSum {
    glm::vec3 point;
    float radius2;
    DiffuseLobe lobe{Rgb(1.0F)};
    glm::dvec3 sum{0.0};
    double inner = 0.0;

    void add(const Photon& p, float distance2) noexcept {
        const float height = glm::dot(p.position - point, kUp);
        if (glm::dot(p.normal, kUp) < 0.5F || height * height > 0.09F * radius2) return;
        const float part = distance2 / radius2,
                    through = lobe.b != 0.0F ? lobe.transmittance(std::max(0.0F, glm::dot(p.wi, kUp))) : 1.0F;
        sum += glm::dvec3(p.flux * ((1.0F - part) * through));
        if (part < 0.5F) inner += static_cast<double>(luminance(p.flux) * (2.0F * (1.0F - 2.0F * part) * through));
    }
};

void nearest(benchmark::State& state) {
    const auto count = static_cast<std::size_t>(state.range(0));
    const PlainTree& map = treeOf(count);
    constexpr auto kCount = static_cast<std::size_t>(kWanted);
    std::array<std::uint32_t, kCount> indices{};
    std::array<float, kCount> distances{};
    Queries queries;
    for ([[maybe_unused]] auto _ : state) {
        nanoflann::KNNResultSet<float, std::uint32_t> result(kCount);
        result.init(indices.data(), distances.data());
        const glm::vec3 point = queries.next();
        map.tree.search(point, result);
        ListSum list{point, distances[kCount - 1]};
        for (std::size_t i = 0; i < result.size(); ++i) list.add(map.photons[indices[i]], distances[i]);
        benchmark::DoNotOptimize(list);
    }
    state.SetItemsProcessed(state.iterations());
}

/// The tree and the grid with the very same work for each photon that they meet. `spread`: of the radii of look-ups, as pixels
/// near and far have them: a quarter, a half, once and twice the radius that the grid was made for.
struct SumWithin {
    const PhotonList& photons;
    ListSum list;
    void init() noexcept {}
    [[nodiscard]] std::size_t size() const noexcept { return 0; }
    [[nodiscard]] bool full() const noexcept { return true; }
    [[nodiscard]] float worstDist() const noexcept { return list.radius2; }
    bool addPoint(float distance2, std::uint32_t index) noexcept {
        if (distance2 < list.radius2) list.add(photons[index], distance2);
        return true;
    }
};

[[nodiscard]] float radiusOf(std::uint32_t query, float radius, bool spread) {
    return spread ? radius * std::ldexp(0.25F, static_cast<int>(query % 4)) : radius;
}

void treeWithin(benchmark::State& state, bool spread) {
    const auto count = static_cast<std::size_t>(state.range(0));
    const PlainTree& map = treeOf(count);
    Queries queries;
    std::uint32_t i = 0;
    for ([[maybe_unused]] auto _ : state) {
        const float r = radiusOf(i++, radiusFor(count), spread);
        SumWithin sum{map.photons, {queries.next(), r * r}};
        map.tree.search(sum.list.point, sum);
        benchmark::DoNotOptimize(sum.list);
    }
    state.SetItemsProcessed(state.iterations());
}

/// Cells in the plane of the floor, each a stretch of the photons.
class Grid {
public:
    Grid(const PhotonList& from, float cell) : cell_(cell), side_(static_cast<int>(std::ceil(1.0F / cell))) {
        start_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_) + 1, 0);
        for (const Photon& p : from) ++start_[cellOf(p.position) + 1];
        for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
        std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
        photons_.resize(from.size());
        for (const Photon& p : from) photons_[next[cellOf(p.position)]++] = p;
    }
    void sum(ListSum& list, float radius) const noexcept {
        const int x0 = column(list.point.x - radius), x1 = column(list.point.x + radius),
                  y0 = column(list.point.y - radius), y1 = column(list.point.y + radius);
        for (int y = y0; y <= y1; ++y) {
            const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(side_);
            for (std::uint32_t i = start_[row + static_cast<std::size_t>(x0)],
                               end = start_[row + static_cast<std::size_t>(x1) + 1];
                 i < end; ++i) {
                const glm::vec3 offset = photons_[i].position - list.point;
                const float distance2 = glm::dot(offset, offset);
                if (distance2 < list.radius2) list.add(photons_[i], distance2);
            }
        }
    }

private:
    [[nodiscard]] int column(float v) const noexcept { return std::clamp(static_cast<int>(v / cell_), 0, side_ - 1); }
    [[nodiscard]] std::size_t cellOf(const glm::vec3& p) const noexcept {
        return static_cast<std::size_t>(column(p.y)) * static_cast<std::size_t>(side_) +
               static_cast<std::size_t>(column(p.x));
    }
    float cell_;
    int side_;
    std::vector<std::uint32_t> start_;
    PhotonList photons_;
};

void gridBuild(benchmark::State& state) {
    const auto count = static_cast<std::size_t>(state.range(0));
    const PhotonList photons = photonsOnAFloor(count);
    for ([[maybe_unused]] auto _ : state) {
        const Grid grid(photons, 2.0F * radiusFor(count));
        benchmark::DoNotOptimize(grid);
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

void gridWithin(benchmark::State& state, bool spread) {
    const auto count = static_cast<std::size_t>(state.range(0));
    const Grid grid(photonsOnAFloor(count), 2.0F * radiusFor(count));
    Queries queries;
    std::uint32_t i = 0;
    for ([[maybe_unused]] auto _ : state) {
        const float r = radiusOf(i++, radiusFor(count), spread);
        ListSum list{queries.next(), r * r};
        grid.sum(list, r);
        benchmark::DoNotOptimize(list);
    }
    state.SetItemsProcessed(state.iterations());
}

void listWithin(benchmark::State& state) {
    const auto count = static_cast<std::size_t>(state.range(0));
    const PlainTree& map = treeOf(count);
    const float radius2 = radiusFor(count) * radiusFor(count);
    std::vector<std::pair<std::uint32_t, float>> matches;
    Queries queries;
    for ([[maybe_unused]] auto _ : state) {
        nanoflann::RadiusResultSet<float, std::uint32_t> result(radius2, matches);
        const glm::vec3 point = queries.next();
        map.tree.search(point, result);
        ListSum list{point, radius2};
        for (const auto& [index, distance2] : matches) list.add(map.photons[index], distance2);
        benchmark::DoNotOptimize(list);
    }
    state.SetItemsProcessed(state.iterations());
}

BENCHMARK(build)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);
BENCHMARK(accumulate)->Arg(100'000)->Arg(1'000'000);
BENCHMARK(listWithin)->Arg(100'000)->Arg(1'000'000);
BENCHMARK(nearest)->Arg(100'000)->Arg(1'000'000);
BENCHMARK(gridBuild)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(treeWithin, one_radius, false)->Arg(100'000)->Arg(1'000'000);
BENCHMARK_CAPTURE(gridWithin, one_radius, false)->Arg(100'000)->Arg(1'000'000);
BENCHMARK_CAPTURE(treeWithin, spread_radii, true)->Arg(100'000)->Arg(1'000'000);
BENCHMARK_CAPTURE(gridWithin, spread_radii, true)->Arg(100'000)->Arg(1'000'000);

}  // namespace
}  // namespace pellucid

/// `--large` adds 1e7 photons.
int main(int argc, char** argv) {
    bool large = false;
    int kept = 0;
    for (int i = 0; i < argc; ++i) {
        if (std::string_view(argv[i]) == "--large")
            large = true;
        else
            argv[kept++] = argv[i];
    }
    if (large) {
        using namespace pellucid;
        benchmark::RegisterBenchmark("build", build)->Arg(10'000'000)->Unit(benchmark::kMillisecond);
        benchmark::RegisterBenchmark("accumulate", accumulate)->Arg(10'000'000);
        benchmark::RegisterBenchmark("listWithin", listWithin)->Arg(10'000'000);
        benchmark::RegisterBenchmark("nearest", nearest)->Arg(10'000'000);
    }
    benchmark::Initialize(&kept, argv);
    if (benchmark::ReportUnrecognizedArguments(kept, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}

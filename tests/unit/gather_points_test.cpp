/// What records and places of the global map are made for: D vertices on and behind what scatters and lets through.
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/render/plan.h>
#include <pellucid/transport/radiance_map.h>
#include <pellucid/transport/walk.h>

#include "../../src/study/check_scenes.h"

namespace pellucid {
namespace {

constexpr int kSize = 64;

/// A floor below a veil that scatters 1 - `transmission` of the light and lets the rest through, seen from above.
[[nodiscard]] SceneDescription veiledFloor(float transmission) {
    check::SceneBuilder b;
    b.square({0, 0, 0}, {0, 1, 0}, 1.0, check::lambert(0.5F));
    Material veil = check::lambert(1.0F);
    veil.transmission = transmission;
    veil.roughness = 0.0F;
    b.square({0, 0.2, 0}, {0, 1, 0}, 1.0, veil);
    b.square({0, 1, 0}, {0, -1, 0}, 1.0, check::lambert(0.5F, 1.0F));
    b.view({0, 0, 0}, {0, 1, 0}, 1.0, 0.5);
    return b.description();
}

[[nodiscard]] double heightOf(const Scene& scene, const glm::vec3& p) {
    return static_cast<double>(p.y) / scene.normalisation().scale() + scene.normalisation().centre.y;
}

[[nodiscard]] std::vector<GatherPoint> seenFromAbove(const TransportContext& context) {
    const Camera camera = context.scene.camera("", kSize, kSize);
    std::vector<GatherPoint> points;
    Walk walk(context);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            WalkRay start;
            start.ray = camera.ray({static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F}, {0.5F, 0.5F}).ray;
            Sampler sampler(1, static_cast<std::uint64_t>(y * kSize + x), 0);
            points.push_back(walk.findGatherPoint(start, sampler, GatherStop::ByChance));
        }
    return points;
}

class Veil : public ::testing::TestWithParam<float> {};

/// An eye path stops on the veil as often as it scatters, and else on the floor: within four standard deviations.
TEST_P(Veil, StopsEyePathsByItsShare) {
    const Workers workers(2);
    const Scene scene(veiledFloor(GetParam()), std::nullopt, SceneOptions{}, workers);
    const TransportContext context{scene, {}, {}};
    int behind = 0, all = 0;
    for (const GatherPoint& p : seenFromAbove(context)) {
        ASSERT_TRUE(p.valid);
        behind += heightOf(scene, p.position) < 0.1 ? 1 : 0;
        ++all;
    }
    const double t = static_cast<double>(GetParam()), n = all;
    EXPECT_NEAR(behind / n, t, 4.0 * std::sqrt(t * (1.0 - t) / n));
}

/// Looks that stop on the veil tell of the floor beyond.
TEST_P(Veil, TellsOfWhatLiesBeyond) {
    const Workers workers(2);
    const Scene scene(veiledFloor(GetParam()), std::nullopt, SceneOptions{}, workers);
    const TransportContext context{scene, {}, {}};
    const Survey seen = survey(context, scene.camera("", kSize, kSize), 1, 1.0F, scene.radius(), workers);
    EXPECT_EQ(seen.receivers, seen.points.size());
    for (const GatherPoint& p : seen.points) ASSERT_NEAR(heightOf(scene, p.position), 0.2, 1e-3);
    ASSERT_EQ(seen.beyond.size(), seen.points.size());
    for (const Receiver& r : seen.beyond) {
        ASSERT_NEAR(heightOf(scene, r.position), 0.0, 1e-3);
        ASSERT_TRUE(seen.visible.seen(r.position));
    }
}

/// The floor below has places, found from the ceiling, and the ceiling from the floor.
TEST_P(Veil, HasPlacesOfTheGlobalMapOnBothSides) {
    const Workers workers(2);
    const Scene scene(veiledFloor(GetParam()), std::nullopt, SceneOptions{}, workers);
    const TransportContext context{scene, {}, {}};
    constexpr std::size_t kPlaces = 4000;
    const auto places = findPlaces(context, seenFromAbove(context), kPlaces, 1, workers);
    std::array<double, 3> on{};
    for (const GatherPoint& p : places)
        on[heightOf(scene, p.position) < 0.1 ? 0 : heightOf(scene, p.position) < 0.9 ? 1 : 2] += 1.0;
    for (const double share : on) EXPECT_GT(share, 0.05 * static_cast<double>(kPlaces));
}

INSTANTIATE_TEST_SUITE_P(Transmission, Veil, ::testing::Values(0.3F, 0.6F));

}  // namespace
}  // namespace pellucid

/// Where records do not pay: among fine leaves every point wants a record of its own, and gathers for itself instead. Rough
/// normal maps, by contrast, cost no records: each answers for all normals (mapped_normals_test.cpp).
#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/math/hash.h>
#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>

#include "agreement.h"
#include "small_scenes.h"

namespace pellucid {
namespace {

using namespace testing;
using namespace testing::detail;

constexpr int kWidth = 48, kHeight = 36;

/// Normals that differ from texel to texel by some 40 degrees.
[[nodiscard]] TextureRef roughNormals() {
    auto image = std::make_shared<TextureImage>();
    image->width = image->height = 64;
    for (std::uint64_t i = 0; i < 64 * 64; ++i) {
        const auto of = [&](std::uint64_t axis) { return static_cast<int>(hashCombine(axis, i) % 160U) + 48; };
        image->texels8.emplace_back(of(1), of(2), 220, 255);
    }
    TextureRef t;
    t.image = image;
    t.linear = false;
    return t;
}

/// Looks down on a floor, rough or smooth, beside a smooth wall.
[[nodiscard]] SceneDescription floorAndWall(bool rough) {
    check::SceneBuilder b;
    Material floor = check::lambert(0.6F);
    if (rough) floor.normalTexture = roughNormals();
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, floor);
    b.description().meshes.back().uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    b.quad({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, check::lambert(0.7F));
    b.quad({-1, 0, -1}, {0, 2, 0}, {0, 0, 2}, check::lambert(0.7F));
    b.square({0.3, 1.6, 0.2}, {-0.6, 0, -0.8}, 0.4, check::lamp(4.0F));
    b.perspective({0.4, 1.2, 1.9}, {0, 0.35, 0}, 0.62);
    b.description().contentHash = rough ? "rough" : "smooth";
    return b.description();
}

/// A cloud of leaves, each about as large as a pixel, before a smooth wall.
[[nodiscard]] SceneDescription leavesBeforeWall() {
    check::SceneBuilder b;
    Mesh leaves;
    std::uint64_t counter = 0;
    const auto next = [&counter] { return static_cast<float>(hashCombine(5, counter++) >> 40U) * 0x1p-23F - 1.0F; };
    for (std::uint32_t i = 0; i < 12'000; ++i) {
        const glm::vec3 centre(0.45F * next() + 0.45F, 0.5F * next() + 0.6F, 0.3F * next());
        for (int corner = 0; corner < 3; ++corner)
            leaves.positions.push_back(centre + 0.03F * glm::vec3(next(), next(), next()));
        leaves.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    b.mesh(leaves, check::lambert(0.5F));
    b.quad({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, check::lambert(0.7F));
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, check::lambert(0.7F));
    b.square({0.0, 1.9, 0.6}, {0, -1, 0}, 0.4, check::lamp(4.0F));
    b.perspective({0, 0.8, 2.6}, {0, 0.7, 0}, 0.62);
    b.description().contentHash = "leaves";
    return b.description();
}

[[nodiscard]] RenderRequest requestOf(const std::string& choice, std::uint64_t seed = 1) {
    RenderRequest request;
    request.width = kWidth;
    request.height = kHeight;
    request.seed = seed;
    request.budget.samples = 8;
    request.settings.cacheChoice = choice;
    request.settings.globalPhotons = 20'000;
    request.layers = {"normal", "record_reason"};
    return request;
}

[[nodiscard]] StageRecord cacheStage(const RenderResult& result) {
    for (const StageRecord& s : result.record.stages)
        if (s.name == "irradiance cache") return s;
    return {};
}

TEST(CacheChoice, LeavesGatherPointByPoint) {
    const Workers workers(2);
    const Scene scene(leavesBeforeWall(), std::nullopt, SceneOptions{}, workers);
    const RenderResult chosen = render(scene, requestOf("on"), workers), all = render(scene, requestOf("off"), workers);
    const auto ofLeft = [&](const RenderResult& result, float reason) {  // there is only wall and floor
        int count = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth / 3; ++x)
                count += result.image.at(static_cast<std::size_t>(y * kWidth + x),
                                         result.image.channel("record_reason.Y")) == reason;
        return count;
    };
    int plain = 0;
    for (std::size_t i = 0; i < chosen.image.pixels(); ++i)
        plain += chosen.image.at(i, chosen.image.channel("record_reason.Y")) == 7.0F ? 1 : 0;
    EXPECT_LT(1.5 * static_cast<double>(cacheStage(chosen).rays), static_cast<double>(cacheStage(all).rays));
    EXPECT_GT(plain, kWidth * kHeight / 10);
    EXPECT_EQ(ofLeft(chosen, 7.0F), 0) << "smooth surfaces keep their records";
    EXPECT_GT(10 * ofLeft(chosen, 0.0F), 9 * (kWidth / 3 * kHeight - ofLeft(chosen, 8.0F)));
}

TEST(CacheChoice, RoughNormalsLookAsPathTracingHasThem) {
    const Workers workers(2);
    const Scene scene(floorAndWall(true), std::nullopt, SceneOptions{}, workers);
    Rendering path{Method::Path, 64, 6, 100, {}, kWidth, kHeight}, photon{Method::Photon, 8, 6, 1, {}, kWidth, kHeight};
    photon.settings.globalPhotons = 20'000;
    // Blocks of twelve pixels: the map's blur at corners is no matter of normals.
    const Agreement agreement = agreementOf(valuesOf(renderSeeds(scene, path, workers), 12, "indirect"),
                                            valuesOf(renderSeeds(scene, photon, workers), 12, "indirect"));
    EXPECT_NEAR(agreement.ratio, 1.0, 0.01 + 2.0 * agreement.error) << agreement;
}

TEST(CacheChoice, SmoothSurfacesKeepTheirRecords) {
    const Workers workers(2);
    const Scene scene(floorAndWall(false), std::nullopt, SceneOptions{}, workers);
    const RenderResult on = render(scene, requestOf("on"), workers), off = render(scene, requestOf("off"), workers);
    ASSERT_EQ(on.image.data().size(), off.image.data().size());
    EXPECT_EQ(std::memcmp(on.image.data().data(), off.image.data().data(), on.image.data().size() * sizeof(float)), 0);
}

}  // namespace
}  // namespace pellucid

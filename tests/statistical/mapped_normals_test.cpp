/// Records under normal maps: they are of the surface's own normal, and the light by direction that each keeps answers for the
/// mapped ones. Pixel by pixel the bumps' light is that of path tracing, from as few records as a smooth floor needs.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>

#include "agreement.h"
#include "small_scenes.h"

namespace pellucid {
namespace {

using namespace testing;
using namespace testing::detail;

constexpr int kWidth = 40, kHeight = 30;

/// Waves of some 40 degrees, four to the floor's side.
[[nodiscard]] TextureRef waves() {
    auto image = std::make_shared<TextureImage>();
    image->width = image->height = 64;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const auto slope = [](int at) { return 0.8 * std::sin(2.0 * kPiD * 4.0 * (at + 0.5) / 64.0); };
            const glm::dvec3 n = glm::normalize(glm::dvec3(slope(x), slope(y), 1.0)) * 127.5 + 127.5;
            image->texels8.emplace_back(std::lround(n.x), std::lround(n.y), std::lround(n.z), 255);
        }
    TextureRef t;
    t.image = image;
    return t;
}

/// A floor in the light of two walls of different colours that a lamp above shines on.
[[nodiscard]] SceneDescription wavyFloor(bool wavy) {
    check::SceneBuilder b;
    Material floor = check::lambert(0.6F);
    if (wavy) floor.normalTexture = waves();
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, floor);
    b.description().meshes.back().uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    b.quad({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, coloured({0.2F, 0.5F, 0.8F}));
    b.quad({-1, 0, 1}, {0, 0, -2}, {0, 2, 0}, coloured({0.8F, 0.5F, 0.2F}));
    b.square({0.5, 1.6, 0.5}, glm::normalize(glm::dvec3(-1, 0, -1)), 0.6, check::lamp(4.0F));
    b.view({0, 0, 0}, {0, 1, 0}, 1.9, 1.4);
    return b.description();
}

[[nodiscard]] std::uint64_t recordsOf(const Scene& scene, const Settings& settings, const Workers& workers) {
    RenderRequest request;
    request.width = kWidth;
    request.height = kHeight;
    request.budget.samples = 1;
    request.settings = settings;
    for (const StageRecord& s : render(scene, request, workers).record.stages)
        if (s.name == "irradiance cache") return s.records;
    return 0;
}

/// Mean of squares of the bias by pixel, over that of the mean, the noise of both taken off.
[[nodiscard]] double bias2(const SeedValues& truth, const SeedValues& found) {
    double sum = 0.0, mean = 0.0;
    const std::size_t cells = truth.front().size();
    for (std::size_t i = 0; i < cells; ++i) {
        const MeanOfSeeds a = cellOverSeeds(truth, i), b = cellOverSeeds(found, i);
        sum += (a.mean - b.mean) * (a.mean - b.mean) - a.variance - b.variance;
        mean += a.mean;
    }
    return sum * static_cast<double>(cells) / (mean * mean);
}

TEST(MappedNormals, RecordsAnswerForThemPixelByPixel) {
    const Workers workers(2);
    const Scene scene(wavyFloor(true), std::nullopt, SceneOptions{}, workers),
        smooth(wavyFloor(false), std::nullopt, SceneOptions{}, workers);
    Rendering path{Method::Path, 256, 4, 100, {}, kWidth, kHeight},
        photon{Method::Photon, 4, 6, 1, {}, kWidth, kHeight};
    photon.settings.cache = "on";
    photon.settings.gatherRays = 512;
    photon.settings.globalPhotons = 0;
    const SeedValues truth = valuesOf(renderSeeds(scene, path, workers), 1, "indirect"),
                     found = valuesOf(renderSeeds(scene, photon, workers), 1, "indirect");
    EXPECT_NEAR(agreementOf(truth, found).ratio, 1.0, 0.02);
    EXPECT_LT(bias2(truth, found), 0.005) << "the floor without its map differs by some hundredths";
    const auto records = static_cast<double>(recordsOf(scene, photon.settings, workers));
    EXPECT_GT(records, 0.0);
    EXPECT_LT(records, 1.5 * static_cast<double>(recordsOf(smooth, photon.settings, workers)));
}

}  // namespace
}  // namespace pellucid

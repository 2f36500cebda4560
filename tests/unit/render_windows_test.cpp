// Windows of an image and the limit in rays: what the tuner's trials rely on.
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include <pellucid/base/parallel.h>
#include <pellucid/io/gltf.h>
#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>

namespace pellucid {
namespace {

class RenderWindows : public testing::Test {
protected:
    [[nodiscard]] RenderResult renderWith(RenderRequest request, int threads = 2) const {
        const Workers workers(threads);
        const Scene scene(loadGltf(PELLUCID_SOURCE_DIR "/scenes/diffuse-room.glb", {}), {}, SceneOptions{}, workers);
        request.width = 48;
        request.height = 36;
        return render(scene, request, workers);
    }
    [[nodiscard]] static std::uint64_t raysOf(const RenderRecord& record) {
        std::uint64_t rays = 0;
        for (const StageRecord& s : record.stages) rays += s.rays;
        return rays;
    }
};

TEST_F(RenderWindows, HoldTheBitsOfTheWholeImageAndStateItsCost) {
    RenderRequest request;
    request.method = Method::Path;
    request.budget.samples = 4;
    const RenderResult whole = renderWith(request);
    request.windows = {{0, 0, 12, 18}, {24, 18, 36, 36}};
    const RenderResult part = renderWith(request);
    for (int y = 0; y < 36; ++y)
        for (int x = 0; x < 48; ++x) {
            const bool inside = (x < 12 && y < 18) || (x >= 24 && x < 36 && y >= 18);
            const auto pixel = static_cast<std::size_t>(y * 48 + x);
            for (int c = 0; c < 3; ++c) EXPECT_EQ(part.image.at(pixel, c), inside ? whole.image.at(pixel, c) : 0.0F);
        }
    const auto wholeRays = static_cast<double>(raysOf(whole.record));
    // Two ninths of the pixels, scaled up; what other pixels see differs.
    EXPECT_NEAR(static_cast<double>(raysOf(part.record)), wholeRays, 0.25 * wholeRays);
}

TEST_F(RenderWindows, RecordsOfTheCacheAreMadeInThemOnly) {
    RenderRequest request;
    request.budget.samples = 1;
    request.settings.globalPhotons = 2000;
    request.settings.gatherRays = 32;
    request.layers = {"records"};
    const RenderResult whole = renderWith(request);
    request.windows = {{0, 0, 24, 36}};
    const RenderResult part = renderWith(request);
    const int records = part.image.channel("records.Y");
    ASSERT_GE(records, 0);
    double inside = 0.0, outside = 0.0;
    for (int y = 0; y < 36; ++y)
        for (int x = 0; x < 48; ++x)
            (x < 24 ? inside : outside) +=
                static_cast<double>(part.image.at(static_cast<std::size_t>(y * 48 + x), records));
    EXPECT_GT(inside, 0.0);
    EXPECT_EQ(outside, 0.0);
    const auto wholeRays = static_cast<double>(raysOf(whole.record));
    EXPECT_NEAR(static_cast<double>(raysOf(part.record)), wholeRays, 0.5 * wholeRays);
}

TEST_F(RenderWindows, ALimitInRaysEndsEveryThreadCountAlike) {
    RenderRequest request;
    request.method = Method::Path;
    request.budget.rays = 60'000;
    const RenderResult one = renderWith(request, 1), two = renderWith(request, 2);
    EXPECT_GT(one.record.samplesPerPixel, 1U);
    EXPECT_EQ(one.record.samplesPerPixel, two.record.samplesPerPixel);
    EXPECT_EQ(one.image.data(), two.image.data());
    EXPECT_NEAR(static_cast<double>(raysOf(one.record)), 60'000.0, 12'000.0);
}

}  // namespace
}  // namespace pellucid

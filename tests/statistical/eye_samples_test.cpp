/// How eye samples are spread: over noisy pixels, and over both ways that an interface leads. Neither may change
/// what the image means, nor its bits with threads or a break.
#include <cstdint>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include <pellucid/io/gltf.h>

#include "../support/files.h"
#include "../support/same_bits.h"
#include "agreement.h"
#include "small_scenes.h"

namespace pellucid {
namespace {

using test::expectSameBits;
using namespace testing;

Settings with(Settings settings, const std::string& name, const std::string& value) {
    setParameter(settings, name, value);
    return settings;
}

/// A glass ball under a lamp that it shows as a glint.
SmallScene glint() {
    check::SceneBuilder b;
    detail::addCorner(b, detail::coloured({0.5F, 0.5F, 0.5F}), detail::coloured({0.4F, 0.5F, 0.6F}));
    b.sphere({0.0, 0.6, 0.0}, 0.55, 24, check::glass(1.5F), true);
    b.square({0.6, 2.2, 1.2}, {0, -1, 0}, 0.25, check::lamp(60.0F));
    return {"glint", b.description()};
}

TEST(EyeSamples, SplitLampChainsMeanTheSame) {
    const Workers workers;
    for (const SmallScene& small : {smoothCasters(), glint()}) {
        const Scene scene(small.scene, small.environment, SceneOptions{}, workers);
        for (const Method method : {Method::Path, Method::Bdpt}) {
            Rendering plain{method, 128};
            plain.width = plain.height = 24;
            const auto a = renderSeeds(scene, plain, workers);
            Rendering split = plain;
            split.settings = with({}, "path.split", "on");
            split.firstSeed = 1000;
            split.samples = 48;
            const auto b = renderSeeds(scene, split, workers);
            for (const char* layer : {"emission", "indirect", ""}) {
                const Agreement agreement = agreementOf(valuesOf(a, 4, layer), valuesOf(b, 4, layer));
                EXPECT_TRUE(agreement.holds(sidakLevel(12))) << small.name << " " << layer << ": " << agreement;
            }
        }
    }
}

/// Mean over pixels of the variance over seeds.
double variance(const std::vector<Image>& images, const std::string& layer) {
    const SeedValues values = valuesOf(images, 1, layer);
    double sum = 0.0;
    for (std::size_t i = 0; i < values.front().size(); ++i) sum += cellOverSeeds(values, i).variance;
    return sum / static_cast<double>(values.front().size());
}

TEST(EyeSamples, SplitLampChainsTameGlints) {
    const Workers workers;
    const SmallScene small = glint();
    const Scene scene(small.scene, small.environment, SceneOptions{}, workers);
    Rendering plain{Method::Path, 16, 16};
    plain.width = plain.height = 24;
    Rendering split = plain;
    split.settings = with({}, "path.split", "on");
    EXPECT_LT(variance(renderSeeds(scene, split, workers), "emission"),
              0.5 * variance(renderSeeds(scene, plain, workers), "emission"));
}

/// A board between a floor and a wide lamp, in a corner whose other light the maps serve: path tracing by next-event estimation
/// alone has one shadow ray a sample, photon mapping from the second iteration on several where they differ.
TEST(EyeSamples, PenumbraeTakeMoreShadowRaysAndMeanTheSame) {
    check::SceneBuilder b;
    detail::addCorner(b, detail::coloured({0.5F, 0.5F, 0.5F}), detail::coloured({0.4F, 0.5F, 0.6F}));
    b.box({-0.4, 0.8, -0.4}, {0.4, 0.85, 0.4}, detail::coloured({0.5F, 0.5F, 0.5F}));
    b.square({0.0, 2.2, 0.0}, {0, -1, 0}, 0.5, check::lamp(10.0F));
    const Workers workers;
    const Scene scene(b.description(), std::nullopt, SceneOptions{}, workers);
    Rendering path{Method::Path, 12, 16};
    path.width = path.height = 24;
    path.settings = with({}, "path.lights", "nee");
    Rendering photon = path.by(Method::Photon, 12, 1000);
    photon.settings = with(with(with({}, "cache.mode", "on"), "photon.global", "5000"), "path.adaptive", "off");
    const auto one = renderSeeds(scene, path, workers), several = renderSeeds(scene, photon, workers);
    const Agreement agreement = agreementOf(valuesOf(one, 4, "direct"), valuesOf(several, 4, "direct"));
    EXPECT_TRUE(agreement.holds(sidakLevel(3))) << agreement;
    EXPECT_LT(variance(several, "direct"), 0.6 * variance(one, "direct"));
}

/// A pane before a bright wall that mirrors the dark: one look in twenty found nothing.
TEST(EyeSamples, BothWaysAtGlassTakeItsNoise) {
    const Workers workers;
    check::SceneBuilder b;
    b.box({-1, -1, 0}, {1, 1, 0.1}, check::glass(1.5F));
    b.square({0, 0, -0.5}, {0, 0, 1}, 3.0, check::lambert(0.8F));
    b.point({0, 1.6, -0.25}, 3.0);
    b.perspective({0, 0, 3}, {0, 0, 0}, 0.5);
    const Scene scene(b.description(), std::nullopt, SceneOptions{}, workers);
    Rendering plain{Method::Path, 16, 16};
    plain.width = plain.height = 24;
    plain.settings = with({}, "path.split", "off");
    Rendering split = plain;
    split.settings = with({}, "path.split", "on");
    split.firstSeed = 1000;
    const auto a = renderSeeds(scene, plain, workers), s = renderSeeds(scene, split, workers);
    EXPECT_LT(variance(s, "direct"), 0.1 * variance(a, "direct"));
    for (const char* layer : {"direct", "indirect"}) {
        const Agreement agreement = agreementOf(valuesOf(a, 4, layer), valuesOf(s, 4, layer));
        EXPECT_TRUE(agreement.holds(sidakLevel(2))) << layer << ": " << agreement;
    }
}

/// Rays of two samples a pixel by eight seeds.
double raysOf(const Scene& scene, Method method, const char* split, const Workers& workers) {
    std::uint64_t rays = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        RenderRequest request;
        request.method = method;
        request.width = request.height = 64;
        request.seed = seed;
        request.budget.samples = 2;
        request.settings = with({}, "path.split", split);
        for (const StageRecord& stage : render(scene, request, workers).record.stages) rays += stage.rays;
    }
    return static_cast<double>(rays);
}

/// Total reflection keeps a few chains in glass for thousands of bounces, where shading normals are not those of the facets.
/// Both ways must not look for them.
TEST(EyeSamples, BothWaysDoNotGetLostInGlass) {
    const Workers workers;
    const Scene goblet(loadGltf(PELLUCID_SOURCE_DIR "/scenes/goblet.glb", {}), std::nullopt, SceneOptions{}, workers);
    check::SceneBuilder b;
    detail::addCorner(b, detail::coloured({0.5F, 0.5F, 0.5F}), detail::coloured({0.4F, 0.5F, 0.6F}));
    b.sphere({0.0, 0.6, 0.0}, 0.55, 8, check::glass(2.4F), true);
    b.square({0.6, 2.2, 1.2}, {0, -1, 0}, 0.25, check::lamp(60.0F));
    const Scene facets(b.description(), std::nullopt, SceneOptions{}, workers);
    const auto expectFew = [&](const Scene& scene, Method method) {
        const double both = raysOf(scene, method, "on", workers), one = raysOf(scene, method, "off", workers);
        EXPECT_LT(both, 1.25 * one) << both / one << " times: a branch is followed more often than by chance";
    };
    expectFew(facets, Method::Path);
    expectFew(goblet, Method::Bdpt);
}

/// One pixel's noise feeds its later shares: a mean in which noisier pixels counted their samples more would be off.
TEST(EyeSamples, SharesByNoiseMeanTheSame) {
    const Workers workers;
    const SmallScene small = glint();
    const Scene scene(small.scene, small.environment, SceneOptions{}, workers);
    Rendering plain{Method::Path, 256};
    plain.width = plain.height = 24;
    Rendering adaptive = plain;
    adaptive.samples = 24;  // few iterations: decisions follow each other closely
    adaptive.seeds = 24;
    adaptive.settings = with({}, "path.adaptive", "on");
    adaptive.firstSeed = 1000;
    const Agreement agreement = agreementOf(valuesOf(renderSeeds(scene, plain, workers), 4),
                                            valuesOf(renderSeeds(scene, adaptive, workers), 4));
    EXPECT_TRUE(agreement.holds(sidakLevel(1))) << agreement;
}

RenderRequest adaptiveRequest(std::uint32_t samples) {
    RenderRequest request;
    request.width = request.height = 24;
    request.budget.samples = samples;
    request.layers = {"samples"};
    setParameter(request.settings, "path.adaptive", "on");
    setParameter(request.settings, "photon.global", "3000");
    setParameter(request.settings, "photon.caustic", "3000");
    return request;
}

/// The image of a render that broke off after `samples` and went on.
Image overABreak(const Scene& scene, RenderRequest request, std::uint32_t samples, const Workers& workers) {
    const test::TemporaryFolder folder;
    request.checkpoint = folder / "checkpoint";
    const auto all = std::exchange(request.budget.samples, samples);
    (void)render(scene, request, workers);
    request.budget.samples = all;
    request.resume = true;
    return render(scene, request, workers).image;
}

/// Photon paths are as many as their noise is worth: what decides that must outlive the break, too.
TEST(EyeSamples, PhotonsByNoiseKeepTheBitsOverABreak) {
    const SmallScene small = glint();
    const Workers one(1), two(2);
    const Scene scene(small.scene, small.environment, SceneOptions{}, one);
    RenderRequest request = adaptiveRequest(60);
    setParameter(request.settings, "photon.caustic", "auto");
    setParameter(request.settings, "photon.chance", "on");
    const Image whole = render(scene, request, two).image;
    expectSameBits(whole, overABreak(scene, request, 12, one));
}

TEST(EyeSamples, SharesByNoiseKeepTheBits) {
    const SmallScene small = glint();
    const Workers one(1), three(3);
    const Scene scene(small.scene, small.environment, SceneOptions{}, one);
    const RenderRequest request = adaptiveRequest(20);
    const Image alone = render(scene, request, one).image;
    expectSameBits(alone, render(scene, request, three).image);
    float least = 1e9F, most = 0.0F;
    const int channel = alone.channel("samples.Y");
    for (std::size_t i = 0; i < alone.pixels(); ++i) {
        least = std::min(least, alone.at(i, channel));
        most = std::max(most, alone.at(i, channel));
    }
    EXPECT_LT(least, most);

    expectSameBits(alone, overABreak(scene, request, 9, one));
}

}  // namespace
}  // namespace pellucid

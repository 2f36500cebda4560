/// Rough casters: whoever carries their light (photons up to surface.cast_roughness, eye paths at rough metal, path tracing and
/// cache beyond), the picture's energy is the reference's, and nothing jumps where the carrier changes.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>

#include "../../src/study/check_scenes.h"

namespace pellucid {
namespace {

constexpr int kSize = 16;
constexpr std::uint64_t kSeeds = 4;

/// Mean luminance of the picture, without lamps in view, over seeds, with its standard error.
struct Energy {
    double mean = 0.0, error = 0.0;
};

/// A lamp lights a floor and the caster; a screen keeps the lamp itself from most of what is seen.
[[nodiscard]] SceneDescription casterOverFloor(bool glass, float roughness) {
    check::SceneBuilder b;
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, check::lambert(0.6F));
    if (glass) {
        b.sphere({0, 0.45, 0}, 0.35, 16, check::glass(1.5F, 0.0F, roughness), true);
        b.square({0.2, 1.8, 0.1}, {0, -1, 0}, 0.3, check::lamp(10.0F));
    } else {
        b.quad({0.7, 0, 0.8}, {0, 0, -1.6}, {0, 1.4, 0}, check::mirror(0.9F, roughness));
        b.quad({-0.1, 0.7, -0.3}, {0, 0, 0.6}, {0, 0.6, 0}, check::lamp(10.0F));
    }
    b.perspective({0.0, 2.6, 0.4}, {0, 0, 0}, 0.6);
    return b.description();
}

[[nodiscard]] Energy energyOf(const Scene& scene, Method method, const Settings& settings, std::uint32_t samples,
                              const Workers& workers) {
    std::vector<double> means;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        RenderRequest request;
        request.method = method;
        request.width = request.height = kSize;
        request.seed = seed + (method == Method::Photon ? 0 : 100);
        request.budget.samples = samples;
        request.settings = settings;
        const Image image = render(scene, request, workers).image;
        const int emission = image.channel("emission.R");
        double sum = 0.0;
        for (std::size_t i = 0; i < image.pixels(); ++i)
            sum += static_cast<double>(luminance(image.rgb(i) - image.rgb(i, emission)));
        means.push_back(sum / static_cast<double>(image.pixels()));
    }
    Energy energy;
    for (const double m : means) energy.mean += m / kSeeds;
    for (const double m : means) energy.error += (m - energy.mean) * (m - energy.mean);
    energy.error = std::sqrt(energy.error / (kSeeds * (kSeeds - 1.0)));
    return energy;
}

[[nodiscard]] Energy photonEnergy(bool glass, float roughness, const SceneOptions& options, const Settings& more,
                                  const Workers& workers, std::uint32_t samples = 16) {
    const Scene scene(casterOverFloor(glass, roughness), std::nullopt, options, workers);
    Settings settings = more;
    settings.castRoughness = static_cast<double>(options.lobeRules.castRoughness);
    settings.glassCastRoughness = static_cast<double>(options.lobeRules.glassCastRoughness);
    settings.causticPhotons = settings.globalPhotons = 20'000;
    return energyOf(scene, Method::Photon, settings, samples, workers);
}

/// A bias of one part in a hundred is allowed, beside three standard errors, which have to be narrow enough to mean something.
void expectAlike(const Energy& a, const Energy& b, const std::string& what) {
    const double error = std::hypot(a.error, b.error) / b.mean;
    EXPECT_LT(error, 0.01) << what;
    EXPECT_NEAR(a.mean / b.mean, 1.0, 0.01 + 3.0 * error) << what << ", standard error " << error;
}

class Roughness : public ::testing::TestWithParam<bool> {};

/// The glass is rendered without the cache: behind it little light is indirect, which few of a record's rays meet, and the cache
/// then loses it (up to 0.7 % of the picture here, with 128 rays; none with 2000).
[[nodiscard]] Settings carrier(bool glass) {
    Settings settings;
    if (glass) settings.cache = "off";
    return settings;
}

TEST_P(Roughness, EnergyIsTheReferences) {
    const Workers workers;
    for (const float roughness : {0.0F, 0.32F, 0.6F, 1.0F}) {
        const Scene scene(casterOverFloor(GetParam(), roughness), std::nullopt, SceneOptions{}, workers);
        const Energy reference = energyOf(scene, Method::Reference, {}, 60, workers);
        expectAlike(photonEnergy(GetParam(), roughness, SceneOptions{}, carrier(GetParam()), workers), reference,
                    "roughness " + std::to_string(roughness));
    }
}

/// The same surface as the last that casts and as the first that does not.
TEST_P(Roughness, NothingJumpsAtTheThreshold) {
    const Workers workers;
    constexpr float kRoughness = 0.3F;
    SceneOptions casts, leaves;
    casts.lobeRules.castRoughness = casts.lobeRules.glassCastRoughness = kRoughness + 1e-3F;
    leaves.lobeRules.castRoughness = leaves.lobeRules.glassCastRoughness = kRoughness - 1e-3F;
    const Settings settings = carrier(GetParam());
    // Path tracing meets the lamp behind rough glass rarely, but its samples cost little.
    expectAlike(photonEnergy(GetParam(), kRoughness, casts, settings, workers),
                photonEnergy(GetParam(), kRoughness, leaves, settings, workers, GetParam() ? 600 : 16), "threshold");
}

INSTANTIATE_TEST_SUITE_P(Casters, Roughness, ::testing::Bool(),
                         [](const auto& p) { return p.param ? "Glass" : "Metal"; });

}  // namespace
}  // namespace pellucid

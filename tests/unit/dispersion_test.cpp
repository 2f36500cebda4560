/// Iors by wavelength, and wavelengths for paths.
#include <pellucid/surface/dispersion.h>

#include <cmath>

#include <gtest/gtest.h>

#include <pellucid/surface/bsdf.h>

namespace pellucid {
namespace {

/// Schott's N-BK7: 1.5168 at 587.6 nm, Abbe number 64.17, 1.52238 at 486.1 nm and 1.51432 at 656.3 nm.
TEST(Dispersion, BorosilicateCrown) {
    const float dispersion = 20.0F / 64.17F;
    EXPECT_NEAR(iorAt(1.5168F, dispersion, {587.6F}), 1.5168F, 2e-5);
    EXPECT_NEAR(iorAt(1.5168F, dispersion, {486.1F}), 1.52238F, 3e-4);
    EXPECT_NEAR(iorAt(1.5168F, dispersion, {656.3F}), 1.51432F, 3e-4);
    const double spread = static_cast<double>(iorAt(1.5168F, dispersion, {486.1F})) -
                          static_cast<double>(iorAt(1.5168F, dispersion, {656.3F}));
    EXPECT_NEAR(0.5168 / spread, 64.17, 0.1) << "the Abbe number";
}

TEST(Dispersion, NoneWithoutWavelengthOrNumber) {
    EXPECT_EQ(iorAt(1.7F, 0.0F, {450.0F}), 1.7F);
    EXPECT_EQ(iorAt(1.7F, 5.0F, {}), 1.7F);
    EXPECT_GE(iorAt(1.01F, 1e3F, {700.0F}), 1.0F) << "never below that of a vacuum";
}

TEST(Dispersion, WeightsMeanOneInEachChannel) {
    glm::dvec3 sum(0.0), integral(0.0);
    constexpr int kDraws = 20000;
    float before = kShortestWave;
    for (int i = 0; i < kDraws; ++i) {
        const WaveSample s = sampleWave((static_cast<float>(i) + 0.5F) / kDraws);
        EXPECT_GE(s.wave.nanometres, before - 1e-3F);
        before = s.wave.nanometres;
        EXPECT_NEAR(s.weight.r + s.weight.g + s.weight.b, 3.0F, 1e-5F);
        EXPECT_GE(std::min({s.weight.r, s.weight.g, s.weight.b}), 0.0F);
        sum += glm::dvec3(s.weight) / static_cast<double>(kDraws);
    }
    EXPECT_LE(before, kLongestWave);
    for (float nm = kShortestWave + 0.05F; nm < kLongestWave; nm += 0.1F) integral += glm::dvec3(channelsAt(nm)) * 0.1;
    for (glm::length_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(sum[c], 1.0, 1e-3) << c;
        EXPECT_NEAR(integral[c], 1.0, 1e-3) << c;
    }
    EXPECT_TRUE(sampleWave(0.0F).wave.chosen());
    EXPECT_TRUE(sampleWave(0x1.fffffep-1F).wave.nanometres <= kLongestWave);
}

TEST(Dispersion, ColoursStandInTheOrderOfTheRainbow) {
    const Rgb blue = channelsAt(455.0F), green = channelsAt(535.0F), red = channelsAt(620.0F);
    EXPECT_GT(blue.b, 3.0F * std::max(blue.r, blue.g));
    EXPECT_GT(green.g, 3.0F * std::max(green.r, green.b));
    EXPECT_GT(red.r, 3.0F * std::max(red.g, red.b));
    EXPECT_EQ(channelsAt(300.0F), Rgb(0.0F));
    EXPECT_EQ(channelsAt(800.0F), Rgb(0.0F));
}

/// Of bodies of smooth glass alone; there the direction is Snell's for that wavelength.
TEST(Dispersion, BelongsToSmoothBodiesOfGlass) {
    Material flint;
    flint.metallic = 0.0F;
    flint.roughness = 0.0F;
    flint.transmission = 1.0F;
    flint.thickness = 1.0F;
    flint.ior = 1.7F;
    flint.dispersion = 1.0F;
    Material rough = flint, thin = flint, plain = flint;
    rough.roughness = 0.4F;
    thin.thickness = 0.0F;
    plain.dispersion = 0.0F;
    const std::vector<Material> materials{flint, rough, thin, plain};
    const SurfaceModel model(materials, LobeRules{});
    EXPECT_TRUE(model.disperses(0));
    for (std::uint32_t m = 1; m < 4; ++m) EXPECT_FALSE(model.disperses(m)) << m;
    SurfacePoint point;
    point.geometricNormal = point.shadingNormal = glm::vec3(0.0F, 0.0F, 1.0F);
    const glm::vec3 wo = glm::normalize(glm::vec3(0.8F, 0.0F, 0.6F));
    for (const float nm : {430.0F, 530.0F, 660.0F}) {
        const DeltaBranches ways = model.bsdf(point, wo, {nm}).deltaBranches(wo, TransportMode::Flux);
        ASSERT_EQ(ways.count, 2);
        for (const BsdfSample& way : ways.branch)
            if (way.transmitted) {
                EXPECT_NEAR(-way.wi.x, 0.8F / iorAt(1.7F, 1.0F, {nm}), 1e-6F) << nm;
            }
    }
}

}  // namespace
}  // namespace pellucid

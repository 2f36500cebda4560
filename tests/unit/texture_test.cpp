#include <cmath>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include <pellucid/math/constants.h>
#include <pellucid/surface/texture.h>

namespace pellucid {
namespace {

/// Grey texels in rows from the top.
TextureRef grey(int width, int height, const std::vector<std::uint8_t>& values) {
    auto image = std::make_shared<TextureImage>();
    image->width = width;
    image->height = height;
    for (const std::uint8_t v : values) image->texels8.emplace_back(v, v, v, 255);
    TextureRef ref;
    ref.image = image;
    return ref;
}

float red(const TextureRef& texture, float u, float v) { return 255.0F * sampleTexture(texture, {u, v}).r; }

TEST(Texture, WithoutAnImageIsWhite) { EXPECT_EQ(sampleTexture({}, {0.3F, 0.7F}), glm::vec4(1.0F)); }

TEST(Texture, TexelCentresLieAtHalves) {
    const TextureRef t = grey(2, 2, {0, 100, 200, 40});
    EXPECT_NEAR(red(t, 0.25F, 0.25F), 0.0F, 1e-4F);
    EXPECT_NEAR(red(t, 0.75F, 0.25F), 100.0F, 1e-4F) << "v = 0 is the upper row";
    EXPECT_NEAR(red(t, 0.25F, 0.75F), 200.0F, 1e-4F);
    EXPECT_NEAR(red(t, 0.5F, 0.25F), 50.0F, 1e-4F);
    EXPECT_NEAR(red(t, 0.5F, 0.5F), 85.0F, 1e-4F);
}

TEST(Texture, WrapModes) {
    TextureRef t = grey(4, 1, {0, 80, 160, 240});
    const float first = 0.125F;
    for (const float u : {first, first + 1.0F, first - 3.0F}) EXPECT_NEAR(red(t, u, 0.5F), 0.0F, 1e-3F);
    EXPECT_NEAR(red(t, 0.0F, 0.5F), 120.0F, 1e-3F) << "between the last and the first";
    EXPECT_NEAR(red(t, 1.0F, 0.5F), 120.0F, 1e-3F);

    t.wrapS = Wrap::Clamp;
    EXPECT_NEAR(red(t, 0.0F, 0.5F), 0.0F, 1e-3F);
    EXPECT_NEAR(red(t, -7.0F, 0.5F), 0.0F, 1e-3F);
    EXPECT_NEAR(red(t, 7.0F, 0.5F), 240.0F, 1e-3F);

    t.wrapS = Wrap::Mirror;
    EXPECT_NEAR(red(t, 0.0F, 0.5F), 0.0F, 1e-3F);
    EXPECT_NEAR(red(t, 1.0F, 0.5F), 240.0F, 1e-3F);
    EXPECT_NEAR(red(t, 1.375F, 0.5F), 160.0F, 1e-3F) << "runs backwards between 1 and 2";
    EXPECT_NEAR(red(t, -0.375F, 0.5F), 80.0F, 1e-3F);
    EXPECT_NEAR(red(t, 2.0F + first, 0.5F), 0.0F, 1e-3F);
}

TEST(Texture, NearestTakesTheTexelThatHoldsThePoint) {
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror}) {
        TextureRef t = grey(2, 1, {10, 20});
        t.linear = false;
        t.wrapS = wrap;
        EXPECT_EQ(std::lround(red(t, 0.49F, 0.5F)), 10);
        EXPECT_EQ(std::lround(red(t, 0.51F, 0.5F)), 20);
        EXPECT_EQ(std::lround(red(t, 1.25F, 0.5F)), wrap == Wrap::Repeat ? 10 : 20);
        EXPECT_EQ(std::lround(red(t, 1.0F, 0.5F)), wrap == Wrap::Repeat ? 10 : 20);
    }
}

/// The extension's own example: offset (0, 1), a quarter turn, scale 1/2 show the lower left quadrant.
TEST(Texture, TransformIsOffsetTimesRotationTimesScale) {
    TextureRef t = grey(2, 2, {10, 20, 30, 40});
    t.linear = false;
    t.offset = {0.0F, 1.0F};
    t.rotation = 0.5F * kPi;
    t.scale = {0.5F, 0.5F};
    for (const float u : {0.05F, 0.95F})
        for (const float v : {0.05F, 0.95F}) EXPECT_EQ(std::lround(red(t, u, v)), 30) << u << " " << v;
    t.rotation = 0.0F;
    t.offset = {0.5F, 0.0F};
    EXPECT_EQ(std::lround(red(t, 0.5F, 0.5F)), 20) << "0.5 + 0.5 * 0.5, 0.25";
}

TEST(Texture, FiltersDecodedValues) {
    TextureRef t = grey(2, 1, {0, 255});
    t.srgb = true;
    t.wrapS = Wrap::Clamp;
    const glm::vec4 middle = sampleTexture(t, {0.5F, 0.5F});
    EXPECT_NEAR(middle.r, 0.5F, 1e-6F);
    EXPECT_NEAR(middle.a, 1.0F, 1e-6F) << "alpha is never decoded";
}

TEST(Texture, SixteenBitTexels) {
    auto image = std::make_shared<TextureImage>();
    image->width = image->height = 1;
    image->texels16 = {{65535, 32768, 0, 13107}};
    TextureRef t;
    t.image = image;
    EXPECT_NEAR(sampleTexture(t, {0, 0}).g, 0.5F, 1e-4F);
    EXPECT_NEAR(sampleTexture(t, {0, 0}).a, 0.2F, 1e-6F);
    t.srgb = true;
    EXPECT_NEAR(sampleTexture(t, {0, 0}).g, srgbToLinear(32768.0F / 65535.0F), 1e-6F);
    EXPECT_NEAR(sampleTexture(t, {0, 0}).a, 0.2F, 1e-6F);
}

TEST(Texture, AnyCoordinateIsSafe) {
    const float huge = std::numeric_limits<float>::max(), nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror})
        for (const bool linear : {false, true})
            for (const float u :
                 {nan, infinity, -infinity, huge, -huge, 1e9F, -1e-30F, std::nextafter(1.0F, 0.0F), -0.0F})
                for (const int width : {1, 3, 8}) {
                    TextureRef t = grey(width, 1, std::vector<std::uint8_t>(static_cast<std::size_t>(width), 77));
                    t.wrapS = t.wrapT = wrap;
                    t.linear = linear;
                    EXPECT_NEAR(red(t, u, u), 77.0F, 1e-3F);
                    t.scale = {huge, -huge};
                    EXPECT_NEAR(red(t, u, u), 77.0F, 1e-3F);
                }
}

TEST(Srgb, TheTwoCurvesAreInverses) {
    for (int i = 0; i <= 255; ++i) {
        const float encoded = static_cast<float>(i) / 255.0F;
        EXPECT_NEAR(linearToSrgb(srgbToLinear(encoded)), encoded, 1e-6F);
    }
    EXPECT_NEAR(srgbToLinear(0.5F), 0.214041F, 1e-6F);  // IEC 61966-2-1
    EXPECT_NEAR(srgbToLinear(0.04045F), 0.04045F / 12.92F, 1e-7F);
    EXPECT_NEAR(linearToSrgb(1.0F), 1.0F, 1e-6F);
    EXPECT_EQ(linearToSrgb(0.0F), 0.0F);
}

}  // namespace
}  // namespace pellucid

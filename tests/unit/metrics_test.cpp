// The metrics against hand-computed figures, and HDR-FLIP against a direct evaluation with two-dimensional filters.
#include <cmath>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include <pellucid/base/error.h>
#include <pellucid/study/metrics.h>

namespace pellucid {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Image colour(int width, int height, const Rgb& value = Rgb(1.0F)) {
    Image image(width, height, {"R", "G", "B"});
    for (std::size_t i = 0; i < image.pixels(); ++i) image.setRgb(i, value);
    return image;
}

template <class Function>
Image paint(int width, int height, Function&& function) {
    Image image(width, height, {"R", "G", "B"});
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        const auto w = static_cast<std::size_t>(width);
        image.setRgb(i, function(static_cast<double>(i % w), static_cast<double>(i / w)));
    }
    return image;
}

Rgb wave(double x, double y) {
    const double scale = (x - 6) * (x - 6) + (y - 5) * (y - 5) < 6 ? 8.0 : 1.0;
    return Rgb(glm::dvec3{0.5 + 0.4 * std::sin(0.7 * x + 0.2 * y), 0.4 + 0.3 * std::cos(0.5 * y),
                          0.3 + 0.25 * std::sin(0.03 * x * y)} *
               scale);
}

Rgb disturbedWave(double x, double y) {
    const auto k = static_cast<float>(1 + 0.3 * std::sin(1.9 * x) * std::cos(2.3 * y));
    const Rgb c = wave(x, y);
    return {c.r * k, c.g * (2.0F - k), c.b * k + (x > 16 ? 0.2F : 0.0F)};
}

TEST(Metrics, IdenticalImagesDifferByNothing) {
    const Image image = paint(24, 18, wave);
    const Metrics m = compareImages(image, image);
    EXPECT_EQ(m.rmse, 0.0);
    EXPECT_EQ(m.relmse, 0.0);
    EXPECT_EQ(m.relmseTrimmed, 0.0);
    EXPECT_EQ(m.smape, 0.0);
    EXPECT_EQ(m.flip, 0.0);
    EXPECT_EQ(m.bias, 0.0);
    EXPECT_EQ(m.nonfinite, 0U);
}

TEST(Metrics, ConstantImagesByHand) {
    const Metrics m = compareImages(colour(8, 8, Rgb(2.0F)), colour(8, 8, Rgb(3.0F)), false);
    EXPECT_DOUBLE_EQ(m.rmse, 1.0);
    EXPECT_NEAR(m.relmse, 1.0 / 4.04, 1e-14);
    EXPECT_NEAR(m.relmseTrimmed, 1.0 / 4.04, 1e-14);
    EXPECT_DOUBLE_EQ(m.smape, 0.4);
    EXPECT_DOUBLE_EQ(m.bias, 0.5);
    EXPECT_EQ(m.flip, 0.0);
}

TEST(Metrics, RelmseUsesTheMeanOfAllChannels) {
    // mean(R) = (1 + 2 + 6)/3 = 3; floor 0.09
    const Metrics m = compareImages(colour(3, 3, {1, 2, 6}), colour(3, 3, {2, 2, 6}), false);
    EXPECT_NEAR(m.relmse, (1.0 / 1.09) / 3.0, 1e-12);
}

TEST(Metrics, RelativeMetricsIgnoreExposure) {
    const Image r = paint(24, 18, wave), i = paint(24, 18, disturbedWave);
    Image r4 = r, i4 = i;
    for (float& v : r4.data()) v *= 4.0F;
    for (float& v : i4.data()) v *= 4.0F;
    const Metrics a = compareImages(r, i), b = compareImages(r4, i4);
    EXPECT_NEAR(a.relmse, b.relmse, 1e-12);
    EXPECT_NEAR(a.relmseTrimmed, b.relmseTrimmed, 1e-12);
    EXPECT_NEAR(a.smape, b.smape, 1e-12);
    EXPECT_NEAR(a.bias, b.bias, 1e-12);
    EXPECT_NEAR(a.flip, b.flip, 1e-4);
    EXPECT_NEAR(4.0 * a.rmse, b.rmse, 1e-9);
}

TEST(Metrics, TrimmedLeavesOutTheWorstThousandth) {
    const Image r = colour(50, 40);
    Image i = r;
    i.setRgb(17, Rgb(1001.0F));
    i.setRgb(900, Rgb(501.0F));
    const Metrics two = compareImages(r, i, false);  // 2000 pixels: two are left out
    EXPECT_NEAR(two.relmse, (1e6 + 250000.0) / 1.01 / 2000.0, 1e-6);
    EXPECT_EQ(two.relmseTrimmed, 0.0);
    i.setRgb(1000, Rgb(2.0F));
    EXPECT_NEAR(compareImages(r, i, false).relmseTrimmed, 1.0 / 1.01 / 1998.0, 1e-12);
}

TEST(Metrics, NonFiniteValuesAreLeftOutAndCounted) {
    Image r = colour(4, 4, Rgb(2.0F)), i = colour(4, 4, Rgb(3.0F));
    i.at(3, 1) = kNan;
    i.setRgb(5, Rgb(std::numeric_limits<float>::infinity()));
    r.at(7, 0) = kNan;
    const Metrics m = compareImages(r, i);
    EXPECT_EQ(m.nonfinite, 5U);
    EXPECT_DOUBLE_EQ(m.rmse, 1.0);
    EXPECT_DOUBLE_EQ(m.bias, 0.5);
    EXPECT_NEAR(m.relmse, 1.0 / 4.04, 1e-12);
    EXPECT_TRUE(std::isfinite(m.flip));
    EXPECT_GT(m.flip, 0.0);
}

TEST(Metrics, MaskedPixelsDoNotCount) {
    Image r(6, 5, {"R", "G", "B", "mask.Y"});
    for (std::size_t p = 0; p < r.pixels(); ++p) {
        r.setRgb(p, Rgb(1.0F));
        r.at(p, 3) = p == 8 ? 0.0F : 1.0F;
    }
    r.setRgb(8, Rgb(1e6F));
    const Metrics m = compareImages(r, colour(6, 5));
    EXPECT_EQ(m.rmse, 0.0);
    EXPECT_EQ(m.relmse, 0.0);
    EXPECT_EQ(m.bias, 0.0);
    EXPECT_EQ(m.flip, 0.0);
}

TEST(Metrics, BlackReference) {
    const Metrics same = compareImages(colour(4, 4, Rgb(0.0F)), colour(4, 4, Rgb(0.0F)));
    EXPECT_EQ(same.relmse, 0.0);
    EXPECT_EQ(same.bias, 0.0);
    EXPECT_EQ(same.flip, 0.0);
    const Metrics other = compareImages(colour(4, 4, Rgb(0.0F)), colour(4, 4, Rgb(1.0F)));
    EXPECT_TRUE(std::isinf(other.relmse));
    EXPECT_DOUBLE_EQ(other.smape, 2.0);
    EXPECT_GT(other.flip, 0.9);
}

TEST(Metrics, RefusesOtherSizesAndMissingChannels) {
    EXPECT_THROW(static_cast<void>(compareImages(colour(4, 4), colour(4, 5))), Error);
    EXPECT_THROW(static_cast<void>(compareImages(colour(4, 4), Image(4, 4, {"U", "V"}))), Error);
}

TEST(Metrics, ErrorMapAveragesToRelmse) {
    const Image r = paint(24, 18, wave), i = paint(24, 18, disturbedWave);
    const Image map = relativeErrorMap(r, i);
    double sum = 0.0;
    for (const float v : map.data()) sum += static_cast<double>(v);
    EXPECT_NEAR(sum / static_cast<double>(map.pixels()), compareImages(r, i, false).relmse, 1e-7);
}

TEST(Crop, TakesTheBoxWithEveryChannel) {
    Image image(5, 4, {"R", "G", "B", "depth.Z"});
    for (std::size_t i = 0; i < image.data().size(); ++i) image.data()[i] = static_cast<float>(i);
    const Image part = crop(image, {1, 2, 4, 4});
    ASSERT_EQ(part.width(), 3);
    ASSERT_EQ(part.height(), 2);
    EXPECT_EQ(part.at(0, 0), image.at(2 * 5 + 1, 0));
    EXPECT_EQ(part.at(5, 3), image.at(3 * 5 + 3, 3));
    for (const CropBox& box : {CropBox{-1, 0, 2, 2}, CropBox{0, 0, 6, 2}, CropBox{2, 2, 2, 3}, CropBox{0, 3, 2, 5}})
        EXPECT_THROW(static_cast<void>(crop(image, box)), Error);
}

TEST(Flip, GreyAgainstBlackByHand) {
    // A constant reference is shown at 85 %: L* = 116 cbrt(.85) - 16 against 0, no chroma, no features. The largest
    // colour distance (green against blue) is 41.2761 [Andersson2020].
    const double distance = std::pow(116.0 * std::cbrt(0.85) - 16.0, 0.7), knee = 0.4 * 41.2761;
    const double expected = 0.95 + 0.05 * (distance - knee) / (41.2761 - knee);
    EXPECT_NEAR(compareImages(colour(32, 32), colour(32, 32, Rgb(0.0F))).flip, expected, 1e-4);
}

TEST(Flip, AgreesWithTwoDimensionalFilters) {
    const Image map = hdrFlipMap(paint(24, 18, wave), paint(24, 18, disturbedWave));
    double sum = 0.0;
    for (const float v : map.data()) sum += static_cast<double>(v);
    // Figures of a direct evaluation in double precision with the filters of the papers as 19 x 19 and 21 x 21 tables.
    EXPECT_NEAR(sum / static_cast<double>(map.pixels()), 0.152532, 2e-5);
    EXPECT_NEAR(static_cast<double>(map.at(0, 0)), 0.112792, 5e-5);
    EXPECT_NEAR(static_cast<double>(map.at(9 * 24 + 20, 0)), 0.436602, 5e-5);
}

TEST(Flip, TinyImages) {
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 7}, std::pair{3, 2}}) {
        const Image r = colour(width, height), i = colour(width, height, Rgb(1.3F));
        const double flip = compareImages(r, i).flip;
        EXPECT_GT(flip, 0.0);
        EXPECT_LT(flip, 1.0);
        EXPECT_EQ(compareImages(r, r).flip, 0.0);
    }
}

TEST(Flip, HalfBlackAndHugeValues) {
    const Image r = paint(16, 16, [](double x, double) { return Rgb(x < 10 ? 0.0F : 1e30F); });
    const Image i = paint(16, 16, [](double x, double) { return Rgb(x < 10 ? 0.0F : 2e30F); });
    const double flip = compareImages(r, i).flip;
    EXPECT_GT(flip, 0.0);
    EXPECT_LE(flip, 1.0);
}

}  // namespace
}  // namespace pellucid

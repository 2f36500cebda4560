// Fresnel reflectance against closed forms and at its edges.

#include <pellucid/surface/fresnel.h>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace pellucid {
namespace {

TEST(Fresnel, NormalIncidence) {
    for (const float eta : {1.1F, 1.33F, 1.5F, 2.4F, 4.0F, 0.67F, 0.5F})
        EXPECT_NEAR(fresnelDielectric(1.0F, eta), fresnelNormal(eta), 1e-7F) << eta;
    EXPECT_FLOAT_EQ(fresnelDielectric(1.0F, 1.5F), 0.04F);
    EXPECT_FLOAT_EQ(fresnelDielectric(-1.0F, 1.5F), 0.04F);
}

TEST(Fresnel, BrewsterLeavesHalfOfThePerpendicularPart) {
    // At tan = n the parallel part vanishes and the perpendicular reflectance is ((n^2-1)/(n^2+1))^2.
    const double n = 1.5, c = 1.0 / std::sqrt(1.0 + n * n), r = (n * n - 1.0) / (n * n + 1.0);
    EXPECT_NEAR(fresnelDielectric(static_cast<float>(c), static_cast<float>(n)), 0.5 * r * r, 1e-7);
}

TEST(Fresnel, SameFromBothSidesOfARefraction) {
    for (const float eta : {1.000001F, 1.01F, 1.5F, 4.0F})
        for (int i = 1; i <= 100; ++i) {
            const double c = i / 100.0, n = static_cast<double>(eta);
            const double t = std::sqrt(1.0 - (1.0 - c * c) / (n * n));
            const float there = fresnelDielectric(static_cast<float>(c), eta);
            const float back = fresnelDielectric(static_cast<float>(t), 1.0F / eta);
            EXPECT_NEAR(there, back, 3e-5F + 1e-3F * there) << eta << ' ' << c;
        }
}

TEST(Fresnel, TotalReflectionIsExactlyOne) {
    const float eta = 1.0F / 1.5F, critical = std::sqrt(1.0F - eta * eta);
    EXPECT_EQ(fresnelDielectric(critical - 1e-4F, eta), 1.0F);
    EXPECT_EQ(fresnelDielectric(0.0F, eta), 1.0F);
    EXPECT_LT(fresnelDielectric(critical + 1e-3F, eta), 1.0F);
    EXPECT_EQ(fresnelDielectric(0.0F, 1.5F), 1.0F);
    for (const float c : {0.0F, 0.3F, 1.0F}) EXPECT_EQ(fresnelDielectric(c, 0.0F), 1.0F);
}

TEST(Fresnel, NoInterfaceNoReflection) {
    for (const float c : {0.0F, 1e-6F, 0.5F, 1.0F}) EXPECT_EQ(fresnelDielectric(c, 1.0F), 0.0F);
}

TEST(Fresnel, KeepsDigitsNearOne) {
    for (const float eta : {1.001F, 1.00001F, 1.000001F}) {
        const double root = (static_cast<double>(eta) - 1.0) / (static_cast<double>(eta) + 1.0);
        EXPECT_NEAR(fresnelDielectric(1.0F, eta) / (root * root), 1.0, 1e-5) << eta;
    }
}

TEST(Fresnel, FiniteAndBoundedEverywhere) {
    for (float eta = 0.1F; eta < 6.0F; eta *= 1.07F)
        for (int i = 0; i <= 1000; ++i) {
            const float f = fresnelDielectric(static_cast<float>(i) * 1e-3F, eta);
            ASSERT_TRUE(f >= 0.0F && f <= 1.0F) << eta << ' ' << i;
        }
    EXPECT_LE(fresnelDielectric(1.0F + 1e-6F, 1.5F), 1.0F);
}

TEST(Fresnel, SchlickEnds) {
    const Rgb f0{0.9F, 0.5F, 0.1F};
    EXPECT_EQ(fresnelSchlick(1.0F, f0), f0);
    EXPECT_EQ(fresnelSchlick(0.0F, f0), Rgb{1.0F});
}

TEST(Fresnel, CurveRunsFromZeroToOne) {
    for (const float eta : {1.0001F, 1.5F, 4.0F}) {
        EXPECT_NEAR(fresnelCurve(1.0F, eta), 0.0F, 1e-6F);
        EXPECT_NEAR(fresnelCurve(0.0F, eta), 1.0F, 1e-6F);
    }
    EXPECT_EQ(fresnelCurve(0.3F, 1.0F), 0.0F);
    EXPECT_FLOAT_EQ(fresnelCurve(0.5F, 0.0F), 1.0F / 32.0F);
}

TEST(Fresnel, SlabSumsItsInternalBounces) {
    for (const double r : {0.0, 0.04, 0.5, 0.99}) {
        double sum = r;  // r + t^2 r + t^2 r^3 + ...
        for (double bounce = r, t2 = (1.0 - r) * (1.0 - r); bounce > 1e-12; bounce *= r * r) sum += t2 * bounce;
        EXPECT_NEAR(slabReflectance(static_cast<float>(r)), sum, 1e-5);
    }
    EXPECT_EQ(slabReflectance(1.0F), 1.0F);
    // Transmittance of a slab of 1.5 at normal incidence is 2n/(n^2+1).
    EXPECT_NEAR(1.0F - slabReflectance(fresnelDielectric(1.0F, 1.5F)), 3.0F / 3.25F, 1e-6F);
}

TEST(Fresnel, RefractedCosine) {
    EXPECT_FLOAT_EQ(refractedCosine(0.0, 1.5F), 1.0F);
    EXPECT_NEAR(refractedCosine(0.25, 1.5F), std::sqrt(1.0 - 0.25 / 2.25), 1e-7);
    EXPECT_EQ(refractedCosine(0.99, 0.5F), 0.0F);
}

}  // namespace
}  // namespace pellucid

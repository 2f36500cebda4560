// Materials to lobes: what each factor and texture does at a point.

#include <pellucid/surface/bsdf.h>

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/math/constants.h>

namespace pellucid {
namespace {

TextureRef texel(glm::u8vec4 value) {
    auto image = std::make_shared<TextureImage>();
    image->width = image->height = 1;
    image->texels8 = {value};
    TextureRef texture;
    texture.image = image;
    return texture;
}

Material plain() {
    Material m;
    m.metallic = 0.0F;
    m.specular = 0.0F;
    return m;
}

Bsdf bsdfOf(const Material& material, const glm::vec3& wo, const SurfacePoint& point = {}) {
    const std::vector<Material> list{material};
    return SurfaceModel(list, {}).bsdf(point, wo);
}

const glm::vec3 kUp{0.0F, 0.0F, 1.0F};
const glm::vec3 kAslant = glm::normalize(glm::vec3{0.6F, 0.0F, 0.8F});

TEST(SurfaceModel, SpecularZeroIsExactLambert) {
    Material m = plain();
    m.baseColor = {0.5F, 0.25F, 1.0F, 1.0F};
    SurfacePoint point;
    point.color = {1.0F, 0.5F, 0.5F, 1.0F};
    const Bsdf bsdf = bsdfOf(m, kAslant, point);
    EXPECT_EQ(bsdf.kinds(), kDiffuse);
    EXPECT_EQ(bsdf.diffuse().a, 1.0F);
    EXPECT_EQ(bsdf.diffuse().b, 0.0F);
    EXPECT_EQ(bsdf.diffuse().reflectance, (Rgb{0.5F, 0.125F, 0.5F}));
    const Rgb value = bsdf.eval(kAslant, kUp, kAllLobes, TransportMode::Radiance);
    EXPECT_FLOAT_EQ(value.r, 0.5F * kInvPi);
    EXPECT_FLOAT_EQ(bsdf.pdf(kAslant, kUp, kAllLobes), kInvPi);
}

TEST(SurfaceModel, SmoothMetalReflectsBaseColour) {
    Material m;
    m.roughness = 0.0F;
    m.baseColor = {0.9F, 0.5F, 0.1F, 1.0F};
    const auto s = bsdfOf(m, kUp).sample(kUp, 0.5F, {0.3F, 0.3F}, kAllLobes, TransportMode::Radiance);
    ASSERT_TRUE(s);
    EXPECT_TRUE(s->delta);
    EXPECT_EQ(s->wi, kUp);
    EXPECT_EQ(s->weight, (Rgb{0.9F, 0.5F, 0.1F}));
    EXPECT_EQ(bsdfOf(m, kUp).eval(kUp, kUp, kAllLobes, TransportMode::Radiance), Rgb{0.0F});
}

TEST(SurfaceModel, BothFacesOfOpaqueSurfacesShadeAlike) {
    Material m;
    m.metallic = 0.4F;
    m.roughness = 0.5F;
    const glm::vec3 wi = glm::normalize(glm::vec3{-0.2F, 0.5F, 0.6F}), flip{1.0F, 1.0F, -1.0F};
    const Bsdf front = bsdfOf(m, kAslant), back = bsdfOf(m, kAslant * flip);
    EXPECT_FALSE(front.backSide());
    EXPECT_TRUE(back.backSide());
    const Rgb a = front.eval(kAslant, wi, kAllLobes, TransportMode::Radiance);
    const Rgb b = back.eval(kAslant * flip, wi * flip, kAllLobes, TransportMode::Radiance);
    EXPECT_NEAR(a.r, b.r, 1e-5F * a.r);
    EXPECT_EQ(front.eval(kAslant, wi * flip, kAllLobes, TransportMode::Radiance), Rgb{0.0F});
}

TEST(SurfaceModel, BodyRefractsBySnellFromBothSides) {
    Material m = plain();
    m.transmission = m.thickness = m.specular = 1.0F;
    m.roughness = 0.0F;
    for (const float side : {1.0F, -1.0F}) {
        const glm::vec3 wo = glm::normalize(glm::vec3{0.3F, 0.0F, side * 0.9F});
        const float eta = side > 0.0F ? 1.5F : 1.0F / 1.5F;
        const auto s = bsdfOf(m, wo).sample(wo, 0.9999F, {0.5F, 0.5F}, kAllLobes, TransportMode::Flux);
        ASSERT_TRUE(s && s->transmitted);
        EXPECT_NEAR(s->wi.x, -wo.x / eta, 1e-6F);
        EXPECT_LT(s->wi.z * side, 0.0F);
        EXPECT_NEAR(s->weight.r, 1.0F, 1e-5F);  // chosen by its share
    }
    const glm::vec3 grazing = glm::normalize(glm::vec3{0.9F, 0.0F, -0.3F});
    for (const float choose : {0.0F, 0.5F, 0.999999F}) {
        const auto s = bsdfOf(m, grazing).sample(grazing, choose, {0.5F, 0.5F}, kAllLobes, TransportMode::Radiance);
        ASSERT_TRUE(s);
        EXPECT_FALSE(s->transmitted);
        EXPECT_EQ(s->weight, Rgb{1.0F});
    }
}

TEST(SurfaceModel, ThinWallGoesStraightOn) {
    Material m = plain();
    m.transmission = m.specular = 1.0F;
    m.roughness = 0.0F;
    m.baseColor = {0.5F, 1.0F, 1.0F, 1.0F};
    const Bsdf bsdf = bsdfOf(m, kUp);
    EXPECT_FALSE(bsdf.bordersVolume());
    Rgb through{0.0F}, back{0.0F};
    for (int i = 0; i < 10000; ++i) {
        const auto s =
            bsdf.sample(kUp, (static_cast<float>(i) + 0.5F) * 1e-4F, {0.5F, 0.5F}, kAllLobes, TransportMode::Radiance);
        ASSERT_TRUE(s);
        EXPECT_EQ(s->wi, s->transmitted ? -kUp : kUp);
        (s->transmitted ? through : back) += s->weight * 1e-4F;
    }
    EXPECT_NEAR(through.g, 3.0F / 3.25F, 2e-4F);  // 2n / (n^2 + 1)
    EXPECT_NEAR(through.r, 1.5F / 3.25F, 2e-4F);
    EXPECT_NEAR(back.g, 0.25F / 3.25F, 2e-4F);
}

TEST(SurfaceModel, IndexOneVanishesAndIndexZeroReflectsAll) {
    Material m = plain();
    m.transmission = m.thickness = m.specular = 1.0F;
    m.roughness = 0.5F;
    m.ior = 1.0F;
    const auto through = bsdfOf(m, kAslant).sample(kAslant, 0.01F, {0.2F, 0.7F}, kAllLobes, TransportMode::Radiance);
    ASSERT_TRUE(through);
    EXPECT_TRUE(through->delta && through->transmitted);
    EXPECT_NEAR(glm::distance(through->wi, -kAslant), 0.0F, 1e-6F);
    EXPECT_NEAR(through->weight.r, 1.0F, 1e-6F);
    EXPECT_EQ(through->etaScale, 1.0F);
    m.ior = 0.0F;
    m.roughness = 0.0F;
    const auto back = bsdfOf(m, kAslant).sample(kAslant, 0.99F, {0.2F, 0.7F}, kAllLobes, TransportMode::Radiance);
    ASSERT_TRUE(back);
    EXPECT_FALSE(back->transmitted);
    EXPECT_EQ(back->weight, Rgb{1.0F});
}

TEST(SurfaceModel, TexturesMultiplyFactors) {
    Material m;
    m.metallic = 1.0F;
    m.roughness = 1.0F;
    m.metallicRoughnessTexture = texel({0, 128, 0, 255});  // roughness 0.5, metallic 0
    m.specularTexture = texel({255, 255, 255, 0});         // specular 0
    m.baseColorTexture = texel({255, 0, 255, 255});
    const Bsdf bsdf = bsdfOf(m, kAslant);
    EXPECT_EQ(bsdf.kinds(), kDiffuse);
    EXPECT_EQ(bsdf.diffuse().reflectance, (Rgb{1.0F, 0.0F, 1.0F}));
    m.transmissionTexture = texel({255, 0, 0, 255});
    m.transmission = 1.0F;
    EXPECT_EQ(bsdfOf(m, kAslant).kinds(), kGlossy);  // all of it thin rough glass
}

TEST(SurfaceModel, NormalMapTiltsInTheTangentFrame) {
    Material m = plain();
    m.normalTexture = texel({255, 128, 128, 255});  // towards +tangent
    m.normalScale = 0.5F;
    SurfacePoint point;
    point.tangent = {0.0F, 1.0F, 0.0F};
    const glm::vec3 n = bsdfOf(m, kUp, point).shadingNormal();
    EXPECT_NEAR(n.x, 0.0F, 0.01F);
    EXPECT_GT(n.y, 0.5F);
    EXPECT_NEAR(glm::length(n), 1.0F, 1e-6F);
    // On the back the whole normal turns round.
    EXPECT_NEAR(glm::distance(bsdfOf(m, -kUp, point).shadingNormal(), -n), 0.0F, 1e-6F);
    // A viewer behind the mapped normal sees the interpolated one.
    EXPECT_EQ(bsdfOf(m, glm::normalize(glm::vec3{0.0F, -1.0F, 0.05F}), point).shadingNormal(), kUp);
    point.tangent = glm::vec3{0.0F};
    EXPECT_EQ(bsdfOf(m, kUp, point).shadingNormal(), kUp);
}

TEST(SurfaceModel, ShadingNormalFallsBackToTheGeometricOne) {
    SurfacePoint point;
    point.shadingNormal = glm::normalize(glm::vec3{1.0F, 0.0F, 0.2F});
    EXPECT_EQ(bsdfOf(plain(), glm::normalize(glm::vec3{-1.0F, 0.0F, 0.1F}), point).shadingNormal(), kUp);
}

TEST(SurfaceModel, EmissionLeavesTheFrontUnlessDoubleSided) {
    std::vector<Material> list{plain()};
    list[0].emission = {3.0F, 2.0F, 1.0F};
    EXPECT_EQ(SurfaceModel(list, {}).emittedRadiance({}, kAslant), (Rgb{3.0F, 2.0F, 1.0F}));
    EXPECT_EQ(SurfaceModel(list, {}).emittedRadiance({}, -kAslant), Rgb{0.0F});
    list[0].doubleSided = true;
    EXPECT_EQ(SurfaceModel(list, {}).emittedRadiance({}, -kAslant), (Rgb{3.0F, 2.0F, 1.0F}));
    list[0].emissiveTexture = texel({255, 0, 255, 255});
    EXPECT_EQ(SurfaceModel(list, {}).emittedRadiance({}, kAslant), (Rgb{3.0F, 0.0F, 1.0F}));
}

TEST(SurfaceModel, Coverage) {
    std::vector<Material> list{plain()};
    list[0].baseColor.a = 0.4F;
    const auto coverage = [&] { return SurfaceModel(list, {}).coverage({}); };
    EXPECT_EQ(coverage(), 1.0F);
    list[0].alphaMode = AlphaMode::Blend;
    EXPECT_FLOAT_EQ(coverage(), 0.4F);
    list[0].alphaMode = AlphaMode::Mask;
    EXPECT_EQ(coverage(), 0.0F);
    list[0].alphaCutoff = 0.4F;
    EXPECT_EQ(coverage(), 1.0F);
}

TEST(SurfaceModel, PossibleKinds) {
    std::vector<Material> list{plain()};
    const auto kinds = [&] { return SurfaceModel(list, {}).possibleKinds(0); };
    EXPECT_EQ(kinds(), kDiffuse);
    list[0].specular = 1.0F;
    EXPECT_EQ(kinds(), kDiffuse | kGlossy);
    list[0].roughness = 0.2F;
    EXPECT_EQ(kinds(), kDiffuse | kSpecular);
    list[0].roughness = 0.8F;
    list[0].metallicRoughnessTexture = texel({0, 255, 255, 255});
    EXPECT_EQ(kinds(), kAllLobes);
    list[0] = plain();
    list[0].transmission = 1.0F;
    EXPECT_EQ(kinds(), kGlossy);
    list[0].thickness = 1.0F;
    list[0].ior = 1.0F;
    EXPECT_EQ(kinds(), kSpecular);
    list[0].metallic = 1.0F;
    EXPECT_EQ(kinds(), kGlossy);
}

}  // namespace
}  // namespace pellucid

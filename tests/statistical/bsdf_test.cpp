// The lobes as SurfaceModel mixes them: sampling against density, weights, energy, reciprocity and extremes.

#include <pellucid/surface/bsdf.h>

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "chi_square.h"

namespace pellucid {
namespace {

using testing::SphereGrid;
using testing::uniform;
using testing::uniform2;

constexpr TransportMode kModes[] = {TransportMode::Radiance, TransportMode::Flux};

Material dielectric(const std::string& name, float roughness, float ior = 1.5F) {
    Material m;
    m.name = name + " roughness " + std::to_string(roughness) + " ior " + std::to_string(ior);
    m.metallic = 0.0F;
    m.roughness = roughness;
    m.ior = ior;
    return m;
}

Material lambert() {
    Material m = dielectric("lambert", 0.5F);
    m.specular = 0.0F;
    return m;
}

Material metal(float roughness) {
    Material m = dielectric("metal", roughness);
    m.metallic = 1.0F;
    m.baseColor = {0.9F, 0.6F, 0.3F, 1.0F};
    return m;
}

Material body(float roughness, float ior = 1.5F) {
    Material m = dielectric("body", roughness, ior);
    m.transmission = 1.0F;
    m.thickness = 1.0F;
    return m;
}

Material thin(float roughness, float ior = 1.5F) {
    Material m = dielectric("thin", roughness, ior);
    m.transmission = 1.0F;
    m.baseColor = {1.0F, 0.8F, 0.6F, 1.0F};
    return m;
}

Material everything(float roughness, float thickness) {
    Material m = dielectric("mix", roughness);
    m.name += thickness > 0.0F ? " body" : " thin";
    m.metallic = 0.3F;
    m.transmission = 0.5F;
    m.thickness = thickness;
    m.specular = 0.7F;
    m.specularColor = {2.0F, 1.0F, 0.2F};
    m.baseColor = {0.9F, 0.5F, 0.7F, 1.0F};
    return m;
}

/// Rough and smooth, every lobe alone and mixed.
std::vector<Material> materials() {
    std::vector<Material> list{lambert()};
    for (const float r : {0.0F, 0.1F, 0.3F, 0.6F, 1.0F}) {
        list.push_back(dielectric("coat", r));
        list.push_back(metal(r));
        list.push_back(body(r));
        list.push_back(thin(r));
        list.push_back(everything(r, 0.0F));
        list.push_back(everything(r, 1.0F));
    }
    for (const float ior : {0.0F, 0.67F, 1.0F, 1.000001F, 1.01F, 4.0F}) {
        list.push_back(dielectric("coat", 0.5F, ior));
        list.push_back(body(0.5F, ior));
        list.push_back(thin(0.5F, ior));
    }
    return list;
}

/// The scene's z = 0 plane, or one whose interpolated normal leans by `lean` radians.
SurfacePoint pointOf(std::uint32_t material, float lean = 0.0F) {
    SurfacePoint point;
    point.material = material;
    point.shadingNormal = {std::sin(lean), 0.0F, std::cos(lean)};
    return point;
}

glm::vec3 direction(float cosine, float phi = 0.4F) {
    const float sine = std::sqrt(std::max(0.0F, 1.0F - cosine * cosine));
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

glm::vec3 randomDirection(std::mt19937_64& random) {
    const float z = 2.0F * uniform(random) - 1.0F;
    return direction(z, kTwoPi * uniform(random));
}

constexpr int kSamples = 100000;

testing::ChiSquareResult chiSquareOf(const Bsdf& bsdf, const glm::vec3& wo, LobeKinds kinds, const SphereGrid& grid,
                                     std::uint64_t seed) {
    return testing::chiSquareTest(
        [&](std::mt19937_64& random) -> std::optional<glm::vec3> {
            const float choose = uniform(random);
            const auto s = bsdf.sample(wo, choose, uniform2(random), kinds, TransportMode::Radiance);
            if (!s || s->delta) return std::nullopt;
            return s->wi;
        },
        [&](const glm::vec3& wi) { return static_cast<double>(bsdf.pdf(wo, wi, kinds)); }, grid, kSamples, seed);
}

void expectSamplesFollowPdf(const std::vector<Material>& list, const std::vector<float>& cosines, float lean,
                            const SphereGrid* narrow) {
    const SurfaceModel model(list, {});
    const int tests = static_cast<int>(list.size() * cosines.size());
    std::uint64_t seed = 100;
    for (std::uint32_t m = 0; m < list.size(); ++m)
        for (const float cosine : cosines) {
            const glm::vec3 wo = direction(cosine);
            const Bsdf bsdf = model.bsdf(pointOf(m, lean), wo);
            SphereGrid grid = narrow != nullptr ? *narrow : SphereGrid{};
            if (narrow != nullptr) grid.axis = {-wo.x, -wo.y, wo.z};
            const auto result = chiSquareOf(bsdf, wo, kAllLobes, grid, ++seed);
            EXPECT_GT(result.pValue, testing::sidakLevel(tests))
                << list[m].name << " cos " << cosine << " mass " << result.mass << " lost " << result.lost;
            EXPECT_LT(result.mass, 1.0 + 1e-3) << list[m].name << ' ' << cosine;
            EXPECT_NEAR(result.mass, 1.0 - result.lost, 0.01) << list[m].name << ' ' << cosine;
        }
}

TEST(BsdfChiSquare, WideLobesFromBothSides) {
    std::vector<Material> list{lambert(), dielectric("coat", 0.0F)};
    for (const float r : {0.3F, 0.6F, 1.0F})
        for (const Material& m :
             {dielectric("coat", r), metal(r), body(r), thin(r), everything(r, 0.0F), everything(r, 1.0F)})
            list.push_back(m);
    for (const float ior : {0.67F, 1.01F, 4.0F}) list.push_back(body(0.6F, ior));
    expectSamplesFollowPdf(list, {1.0F, 0.7F, 0.1F, -0.02F, -0.6F, -1.0F}, 0.0F, nullptr);
}

TEST(BsdfChiSquare, LeaningShadingNormal) {
    expectSamplesFollowPdf({lambert(), dielectric("coat", 0.4F), metal(0.4F), body(0.4F), thin(0.4F)},
                           {0.8F, 0.2F, -0.5F}, 0.3F, nullptr);
}

TEST(BsdfChiSquare, NarrowReflections) {
    const SphereGrid narrow{{}, 3.0, 32, 16};
    expectSamplesFollowPdf({metal(0.032F), metal(0.1F), dielectric("coat", 0.1F)}, {1.0F, 0.6F, 0.05F, -0.3F}, 0.0F,
                           &narrow);
}

TEST(BsdfChiSquare, NarrowRefraction) {
    const std::vector<Material> list{body(0.1F)};
    const SurfaceModel model(list, {});
    for (const float cosine : {0.9F, 0.4F, -0.95F}) {
        const glm::vec3 wo = direction(cosine);
        const float eta = cosine > 0.0F ? 1.5F : 1.0F / 1.5F;
        const float cosT = std::sqrt(1.0F - (1.0F - cosine * cosine) / (eta * eta));
        SphereGrid grid{{-wo.x / eta, -wo.y / eta, std::copysign(cosT, -cosine)}, 3.0, 32, 16};
        const auto result = chiSquareOf(model.bsdf(pointOf(0), wo), wo, kAllLobes, grid, 7);
        EXPECT_GT(result.pValue, testing::sidakLevel(3)) << cosine << ' ' << result.mass;
    }
}

TEST(BsdfChiSquare, RejectsAWrongAlpha) {
    const std::vector<Material> list{metal(0.6F), metal(0.62F)};
    const SurfaceModel model(list, {});
    const glm::vec3 wo = direction(0.7F);
    const Bsdf right = model.bsdf(pointOf(0), wo), wrong = model.bsdf(pointOf(1), wo);
    const auto result = testing::chiSquareTest(
        [&](std::mt19937_64& random) -> std::optional<glm::vec3> {
            const auto s = right.sample(wo, 0.0F, uniform2(random), kAllLobes, TransportMode::Radiance);
            return s ? std::optional(s->wi) : std::nullopt;
        },
        [&](const glm::vec3& wi) { return static_cast<double>(wrong.pdf(wo, wi, kAllLobes)); }, {}, kSamples, 3);
    EXPECT_LT(result.pValue, 1e-6);
}

TEST(Bsdf, WeightIsValueOverPdf) {
    const std::vector<Material> list = materials();
    const SurfaceModel model(list, {});
    std::mt19937_64 random(11);
    for (std::uint32_t m = 0; m < list.size(); ++m)
        for (int i = 0; i < 2000; ++i) {
            const glm::vec3 wo = randomDirection(random);
            const Bsdf bsdf = model.bsdf(pointOf(m, 0.2F), wo);
            const TransportMode mode = kModes[i % 2];
            const float choose = uniform(random);
            const auto s = bsdf.sample(wo, choose, uniform2(random), kAllLobes, mode);
            if (!s) continue;
            ASSERT_NEAR(glm::length(s->wi), 1.0F, 1e-5F);
            ASSERT_EQ(s->transmitted, glm::dot(s->wi, bsdf.geometricNormal()) < 0.0F);
            ASSERT_NE(s->kind & bsdf.kinds(), kNoLobe);
            ASSERT_NE(s->kind & model.possibleKinds(m), kNoLobe) << list[m].name;
            if (s->delta) {
                EXPECT_EQ(s->pdfSolidAngle, 0.0F);
                continue;
            }
            const BsdfValue value = bsdf.evaluate(wo, s->wi, kAllLobes, mode);
            EXPECT_EQ(value.value, bsdf.eval(wo, s->wi, kAllLobes, mode));
            EXPECT_NEAR(s->pdfSolidAngle / bsdf.pdf(wo, s->wi, kAllLobes), 1.0F, 1e-4F) << list[m].name;
            const Rgb ratio = value.value / value.pdfSolidAngle;
            EXPECT_LE(maxComponent(glm::abs(ratio - s->weight)), 1e-4F * (1.0F + maxComponent(ratio))) << list[m].name;
        }
}

/// Integral of eval over the sphere plus what the delta lobes return, in the first `channels`' most reflecting one.
double furnace(const Bsdf& bsdf, const glm::vec3& wo, TransportMode mode, int channels = 3) {
    const SphereGrid grid{{-wo.x, -wo.y, wo.z}, 2.0, 16, 16};
    const Frame frame(grid.axis);
    glm::dvec3 sum{0.0};
    for (int channel = 0; channel < channels; ++channel)
        for (int i = 0; i < grid.thetas; ++i)
            for (int j = 0; j < grid.phis; ++j) {
                const testing::detail::Cell cell{i / 16.0, (i + 1) / 16.0, j * kPiD / 8.0, (j + 1) * kPiD / 8.0};
                const auto value = [&](const glm::vec3& wi) {
                    return static_cast<double>(bsdf.eval(wo, wi, kAllLobes, mode)[channel]);
                };
                sum[channel] += testing::detail::integrate(grid, frame, value, cell,
                                                           testing::detail::gauss4x4(grid, frame, value, cell), 0);
            }
    constexpr int kSteps = 20000;  // of the choice of a lobe
    for (int i = 0; i < kSteps; ++i) {
        const auto s = bsdf.sample(wo, (static_cast<float>(i) + 0.5F) / kSteps, {0.5F, 0.5F}, kAllLobes, mode);
        if (s && s->delta) sum += glm::dvec3{s->weight} / static_cast<double>(kSteps);
    }
    return std::max(sum.r, std::max(sum.g, sum.b));
}

TEST(BsdfFurnace, NothingGainsEnergy) {
    const std::vector<Material> list = materials();
    const SurfaceModel model(list, {});
    for (std::uint32_t m = 0; m < list.size(); ++m)
        for (const float cosine : {1.0F, 0.5F, 0.15F, 0.03F, -0.3F, -0.8F}) {
            const glm::vec3 wo = direction(cosine);
            const double energy = furnace(model.bsdf(pointOf(m), wo), wo, TransportMode::Flux);
            EXPECT_LE(energy, 1.0 + 1e-4) << list[m].name << ' ' << cosine;
            EXPECT_GE(energy, 0.0);
        }
}

/// White Lambertian with its cosine left out, and glass whose radiance is scaled by eta^2 where flux is meant.
TEST(BsdfFurnace, SeesPlantedBugs) {
    Material white = lambert();
    white.baseColor = glm::vec4(1.0F);
    const std::vector<Material> list{white, body(0.0F)};
    const SurfaceModel model(list, {});
    const glm::vec3 wo = direction(0.5F), inside = direction(-0.9F);
    const Bsdf diffuse = model.bsdf(pointOf(0), wo), glass = model.bsdf(pointOf(1), inside);
    EXPECT_NEAR(furnace(diffuse, wo, TransportMode::Flux), 1.0, 1e-4);
    EXPECT_LE(furnace(glass, inside, TransportMode::Flux), 1.0 + 1e-4);
    EXPECT_GT(furnace(glass, inside, TransportMode::Radiance) - 1.0, 0.3);
    // int f over the hemisphere is 2 where int f cos is 1.
    const Frame frame(glm::vec3(0.0F, 0.0F, 1.0F));
    const SphereGrid grid{{0.0F, 0.0F, 1.0F}, 1.0, 16, 16};
    double sum = 0.0;
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 16; ++j) {
            const testing::detail::Cell cell{i / 16.0, (i + 1) / 16.0, j * kPiD / 8.0, (j + 1) * kPiD / 8.0};
            const auto value = [&](const glm::vec3& wi) {
                return static_cast<double>(diffuse.eval(wo, wi, kAllLobes, TransportMode::Flux).g) /
                       std::max(1e-6, static_cast<double>(wi.z));
            };
            sum += testing::detail::integrate(grid, frame, value, cell,
                                              testing::detail::gauss4x4(grid, frame, value, cell), 0);
        }
    EXPECT_GT(sum, 1.9);
}

TEST(BsdfFurnace, CoatOverWhiteLosesLittle) {
    const std::vector<Material> list{lambert(), dielectric("smooth", 0.0F), dielectric("rough", 0.4F),
                                     dielectric("rougher", 0.8F)};
    const SurfaceModel model(list, {});
    const double leastMean[] = {0.9999, 0.97, 0.96, 0.96};
    for (std::uint32_t m = 0; m < list.size(); ++m) {
        double mean = 0.0;
        for (int i = 0; i < 16; ++i) {
            const float cosine = std::sqrt((static_cast<float>(i) + 0.5F) / 16.0F);
            const glm::vec3 wo = direction(cosine);
            const double energy = furnace(model.bsdf(pointOf(m), wo), wo, TransportMode::Radiance, 1);
            EXPECT_LE(energy, 1.0 + 1e-4) << list[m].name << ' ' << cosine;
            mean += energy / 16.0;
        }
        EXPECT_GE(mean, leastMean[m]) << list[m].name;
        RecordProperty("meanFurnace" + std::to_string(m), std::to_string(mean));
    }
}

TEST(BsdfFurnace, CoatOverAnythingOverRoughnessAndColour) {
    std::vector<Material> list;
    for (const float ior : {1.2F, 1.5F, 2.0F, 4.0F})
        for (int i = 0; i < 23; ++i) {
            list.push_back(dielectric("coat", 0.033F + 0.042F * static_cast<float>(i), ior));
            list.back().specularColor = Rgb{i % 3 == 0 ? 0.0F : (i % 3 == 1 ? 1.0F : 8.0F)};
        }
    const SurfaceModel model(list, {});
    for (std::uint32_t m = 0; m < list.size(); ++m)
        for (const float cosine : {0.95F, 0.35F, 0.08F}) {
            const glm::vec3 wo = direction(cosine);
            const Bsdf bsdf = model.bsdf(pointOf(m), wo);
            EXPECT_LE(furnace(bsdf, wo, TransportMode::Radiance, 1), 1.0 + 1e-4) << list[m].name << ' ' << cosine;
            for (int i = 0; i <= 20; ++i) EXPECT_GE(bsdf.diffuse().transmittance(static_cast<float>(i) / 20.0F), 0.0F);
        }
}

TEST(BsdfFurnace, SmoothGlassKeepsAllEnergyAndScalesRadiance) {
    const std::vector<Material> list{body(0.0F), body(0.0F, 1.0F), body(0.5F, 1.0F), body(0.3F, 1.000001F)};
    const SurfaceModel model(list, {});
    for (std::uint32_t m = 0; m < list.size(); ++m)
        for (const float cosine : {1.0F, 0.3F, -0.2F, -0.9F}) {
            const glm::vec3 wo = direction(cosine);
            const Bsdf bsdf = model.bsdf(pointOf(m), wo);
            EXPECT_TRUE(bsdf.bordersVolume());
            EXPECT_NEAR(furnace(bsdf, wo, TransportMode::Flux), 1.0, 2e-4);
            for (int i = 0; i < 100; ++i) {
                const float choose = (static_cast<float>(i) + 0.5F) / 100.0F;
                const auto radiance = bsdf.sample(wo, choose, {0.5F, 0.5F}, kAllLobes, TransportMode::Radiance);
                const auto flux = bsdf.sample(wo, choose, {0.5F, 0.5F}, kAllLobes, TransportMode::Flux);
                ASSERT_TRUE(radiance && flux);
                EXPECT_EQ(flux->etaScale, 1.0F);
                EXPECT_NEAR(radiance->weight.r * radiance->etaScale, flux->weight.r, 1e-5F);
                const float eta = cosine > 0.0F ? list[m].ior : 1.0F / list[m].ior;
                EXPECT_NEAR(radiance->etaScale, radiance->transmitted ? eta * eta : 1.0F, 1e-5F);
            }
        }
}

/// Both ways of an interface, each with its whole weight, are the mean of the ways chosen by chance.
TEST(Bsdf, DeltaBranchesAreTheMeanOfSamples) {
    Material thin = body(0.0F);
    thin.thickness = 0.0F;
    const std::vector<Material> list{body(0.0F), thin, body(0.0F, 1.0F)};
    const SurfaceModel model(list, {});
    for (std::uint32_t m = 0; m < list.size(); ++m)
        for (const float cosine : {1.0F, 0.3F, 0.02F, -0.2F, -0.9F}) {
            const glm::vec3 wo = direction(cosine);
            const Bsdf bsdf = model.bsdf(pointOf(m), wo);
            const DeltaBranches branches = bsdf.deltaBranches(wo, TransportMode::Radiance);
            float reflected = 0.0F, transmitted = 0.0F, sampledReflected = 0.0F, sampledTransmitted = 0.0F;
            for (int i = 0; i < branches.count; ++i) {
                const BsdfSample& b = branches.branch[static_cast<std::size_t>(i)];
                (b.transmitted ? transmitted : reflected) += b.weight.g;
            }
            constexpr int kDraws = 20000;
            for (int i = 0; i < kDraws; ++i) {
                const auto s = bsdf.sample(wo, (static_cast<float>(i) + 0.5F) / kDraws, {0.5F, 0.5F}, kAllLobes,
                                           TransportMode::Radiance);
                ASSERT_TRUE(s && s->delta);
                (s->transmitted ? sampledTransmitted : sampledReflected) += s->weight.g / kDraws;
            }
            EXPECT_NEAR(reflected, sampledReflected, 2e-3F) << m << ' ' << cosine;
            EXPECT_NEAR(transmitted, sampledTransmitted, 5e-3F) << m << ' ' << cosine;
        }
}

/// Largest relative difference between f(a, b) / etaA^2 and f(b, a) / etaB^2; `squared` false: with eta^2 left out.
double irreciprocity(const SurfaceModel& model, std::uint32_t m, const Material& material, bool squared) {
    const bool volume = material.thickness > 0.0F && material.ior > 0.0F && squared;
    std::mt19937_64 random(5);
    double worst = 0.0;
    for (int i = 0; i < 1000; ++i) {
        const glm::vec3 a = randomDirection(random), b = randomDirection(random);
        const float etaA = volume && a.z < 0.0F ? material.ior : 1.0F,
                    etaB = volume && b.z < 0.0F ? material.ior : 1.0F;
        const Rgb ab =
            model.bsdf(pointOf(m), a).eval(a, b, kAllLobes, TransportMode::Radiance) / (std::fabs(b.z) * etaA * etaA);
        const Rgb ba =
            model.bsdf(pointOf(m), b).eval(b, a, kAllLobes, TransportMode::Radiance) / (std::fabs(a.z) * etaB * etaB);
        worst = std::max(worst, static_cast<double>(maxComponent(glm::abs(ab - ba)) / (maxComponent(ab) + 1e-3F)));
    }
    return worst;
}

TEST(Bsdf, ReciprocitySeesEtaSquaredLeftOut) {
    const std::vector<Material> list{body(0.4F)};
    const SurfaceModel model(list, {});
    EXPECT_LE(irreciprocity(model, 0, list[0], true), 5e-3);
    EXPECT_GT(irreciprocity(model, 0, list[0], false), 0.3);
}

TEST(Bsdf, Reciprocity) {
    std::vector<Material> list;
    for (const Material& m : materials())
        if (m.roughness > 0.05F) list.push_back(m);
    const SurfaceModel model(list, {});
    std::mt19937_64 random(5);
    for (std::uint32_t m = 0; m < list.size(); ++m) {
        const bool volume = list[m].thickness > 0.0F && list[m].ior > 0.0F;
        int compared = 0;
        for (int i = 0; i < 4000; ++i) {
            const glm::vec3 a = randomDirection(random), b = randomDirection(random);
            const Bsdf bsdfA = model.bsdf(pointOf(m), a), bsdfB = model.bsdf(pointOf(m), b);
            const float etaA = volume && a.z < 0.0F ? list[m].ior : 1.0F,
                        etaB = volume && b.z < 0.0F ? list[m].ior : 1.0F;
            const Rgb ab = bsdfA.eval(a, b, kAllLobes, TransportMode::Radiance) / (std::fabs(b.z) * etaA * etaA);
            const Rgb ba = bsdfB.eval(b, a, kAllLobes, TransportMode::Radiance) / (std::fabs(a.z) * etaB * etaB);
            // Close to a critical angle the two sides round Fresnel's steep end differently.
            EXPECT_LE(maxComponent(glm::abs(ab - ba)), 5e-3F * (maxComponent(ab) + 1e-3F))
                << list[m].name << ' ' << a.z << ' ' << b.z;
            compared += isBlack(ab) ? 0 : 1;
        }
        if (list[m].name == lambert().name) {
            EXPECT_GT(compared, 1500);
        }
    }
}

TEST(Bsdf, NothingIsEverNotFinite) {
    std::vector<Material> list = materials();
    for (const float r : {0.0316228F, 0.0317F, 0.04F})
        for (const Material& m :
             {dielectric("coat", r), metal(r), body(r), body(r, 1.001F), thin(r), everything(r, 1.0F)})
            list.push_back(m);
    const SurfaceModel model(list, {});
    std::mt19937_64 random(17);
    const std::vector<glm::vec3> special{{0, 0, 1},         {0, 0, -1},        {1, 0, 0},         {-1, 0, 0},
                                         {0, -1, 0},        direction(1e-4F),  direction(-1e-4F), direction(1e-7F),
                                         direction(1e-20F), direction(-1e-38F)};
    const auto pick = [&] { return random() % 3 == 0 ? special[random() % special.size()] : randomDirection(random); };
    for (std::uint32_t m = 0; m < list.size(); ++m)
        for (int i = 0; i < 5000; ++i) {
            const glm::vec3 wo = pick();
            glm::vec3 wi = pick();
            if (i % 17 == 0) wi = -wo;
            if (i % 19 == 0) wi = {-wo.x, -wo.y, wo.z};
            const Bsdf bsdf = model.bsdf(pointOf(m, i % 2 == 0 ? 0.0F : 0.3F), wo);
            const TransportMode mode = kModes[i % 2];
            const BsdfValue value = bsdf.evaluate(wo, wi, kAllLobes, mode);
            ASSERT_TRUE(isFinite(value.value) && std::isfinite(value.pdfSolidAngle))
                << list[m].name << ' ' << wo.z << ' ' << wi.z;
            ASSERT_TRUE(value.pdfSolidAngle >= 0.0F && glm::all(glm::greaterThanEqual(value.value, Rgb{0.0F})))
                << list[m].name;
            const glm::vec2 u = i % 5 == 0 ? glm::vec2{kOneMinusEpsilon * static_cast<float>(i % 2), kOneMinusEpsilon}
                                           : uniform2(random);
            const auto s = bsdf.sample(wo, i % 7 == 0 ? kOneMinusEpsilon : uniform(random), u, kAllLobes, mode);
            if (!s) continue;
            ASSERT_TRUE(isFinite(s->weight) && isFinite(s->wi) && std::isfinite(s->pdfSolidAngle))
                << list[m].name << ' ' << wo.z;
            ASSERT_TRUE(glm::all(glm::greaterThanEqual(s->weight, Rgb{0.0F}))) << list[m].name;
            ASSERT_LT(maxComponent(s->weight) * s->etaScale, 30.0F) << list[m].name << ' ' << wo.z;
        }
}

}  // namespace
}  // namespace pellucid

/// Sampling towards lights against closed forms, densities against what is sampled, and the choice among lights.
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/math/constants.h>
#include <pellucid/scene/lights.h>

#include "chi_square.h"

namespace pellucid {
namespace {

using testing::uniform;
using testing::uniform2;

const glm::vec3 kNoNormal(0.0F);

EmissiveTriangle triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const Rgb& radiance,
                          bool twoSided = false) {
    EmissiveTriangle t;
    t.corner[0] = a, t.corner[1] = b, t.corner[2] = c;
    t.normal = glm::normalize(glm::cross(b - a, c - a));
    t.meanRadiance = radiance;
    t.twoSided = twoSided;
    return t;
}

/// A unit square at height 1 that shines downwards, of two triangles.
Lights::Parts quadLamp() {
    const glm::vec3 a(-0.5F, 1.0F, -0.5F), b(0.5F, 1.0F, -0.5F), c(0.5F, 1.0F, 0.5F), d(-0.5F, 1.0F, 0.5F);
    Lights::Parts parts;
    parts.triangles = {triangle(a, b, c, Rgb(2.0F)), triangle(a, c, d, Rgb(2.0F))};
    parts.triangles[0].geometry = parts.triangles[1].geometry = 3;
    parts.triangles[1].primitive = 7;
    return parts;
}

/// Irradiance from a polygon of radiance 1 wholly above the horizon: (1/2) sum gamma_i n . Gamma_i. [Lambert1760;
/// Arvo1995]
double polygonIrradiance(const EmissiveTriangle& t, const glm::vec3& point, const glm::vec3& normal) {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 u = glm::normalize(glm::dvec3(t.corner[i]) - glm::dvec3(point));
        const glm::dvec3 v = glm::normalize(glm::dvec3(t.corner[(i + 1) % 3]) - glm::dvec3(point));
        const glm::dvec3 across = glm::cross(u, v);
        const double length = glm::length(across);
        if (length > 0.0)
            sum += 0.5 * std::atan2(length, glm::dot(u, v)) * glm::dot(glm::dvec3(normal), across) / length;
    }
    return std::fabs(sum);
}

struct Estimate {
    double mean = 0.0, deviation = 0.0, error = 0.0;
};

/// Mean of cos * radiance / pdf: the irradiance. Every sample is checked: finite, and its pdf the one that pdf...()
/// tells.
Estimate irradiance(const Lights& lights, const Lights::Parts& parts, const glm::vec3& point, const glm::vec3& normal,
                    int samples, unsigned seed) {
    std::mt19937_64 random(seed);
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < samples; ++i) {
        const float choose = uniform(random);
        const auto s = lights.sample(point, normal, choose, uniform2(random));
        if (!s) continue;
        const double cosine = normal == kNoNormal ? 1.0 : static_cast<double>(glm::dot(normal, s->wi));
        EXPECT_GT(cosine, 0.0);
        const double value = cosine * static_cast<double>(average(s->radiance)) / static_cast<double>(s->pdfSolidAngle);
        EXPECT_TRUE(std::isfinite(value));
        if (i % 16 == 0) {
            float told = lights.choicePmf(s->light, point, normal);
            const LightKind kind = lights.kind(s->light);
            if (kind == LightKind::Triangle) {
                const auto& t = parts.triangles[s->light - parts.points.size() - parts.spots.size()];
                told = lights.pdfTriangle(point, normal, t.geometry, t.primitive, s->wi, s->distance);
            } else if (kind == LightKind::Environment) {
                told = lights.pdfEnvironment(point, normal, s->wi);
            }
            EXPECT_NEAR(told / s->pdfSolidAngle, 1.0F, 2e-4F) << "light " << s->light;
        }
        sum += value;
        squares += value * value;
    }
    const double mean = sum / samples, deviation = std::sqrt(std::max(0.0, squares / samples - mean * mean));
    return {mean, deviation, deviation / std::sqrt(samples)};
}

TEST(Lights, QuadLampGivesThePolygonFormula) {
    const Lights::Parts parts = quadLamp();
    const Lights lights(parts, nullptr, nullptr);
    ASSERT_EQ(lights.count(), 2U);
    struct Place {
        glm::vec3 point, normal;
        double deviation;  // allowed, relative
    };
    const std::vector<Place> places{
        {{0.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, 0.4},      // below
        {{0.1F, 0.95F, 0.2F}, {0.0F, 1.0F, 0.0F}, 1.0},     // very near
        {{0.1F, 0.9999F, 0.2F}, {0.0F, 1.0F, 0.0F}, 1.4},   // almost touching
        {{2.0F, 0.0F, 0.5F}, {0.0F, 1.0F, 0.0F}, 0.6},      // off to the side
        {{2.0F, 0.9F, 0.5F}, {-1.0F, 0.0F, 0.0F}, 0.8},     // grazing the lamp's plane
        {{0.6F, 0.99F, 0.0F}, {-1.0F, 0.0F, 0.0F}, 1.5},    // a wall beside it, near
        {{0.0F, -300.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, 0.01},  // far
    };
    unsigned seed = 1;
    for (const Place& place : places) {
        double expected = 0.0;
        for (const EmissiveTriangle& t : parts.triangles)
            expected += 2.0 * polygonIrradiance(t, place.point, place.normal);
        const Estimate e = irradiance(lights, parts, place.point, place.normal, 40000, seed++);
        EXPECT_NEAR(e.mean, expected, 4.5 * e.error + 1e-5 * expected) << "place " << seed;
        EXPECT_LT(e.deviation, place.deviation * expected) << "place " << seed;
    }
    EXPECT_FALSE(lights.sample({0.0F, 2.0F, 0.0F}, {0.0F, -1.0F, 0.0F}, 0.5F, {0.5F, 0.5F}));  // behind it
    EXPECT_FALSE(lights.sample({0.0F, 0.0F, 0.0F}, {0.0F, -1.0F, 0.0F}, 0.5F, {0.5F, 0.5F}));  // facing away
}

TEST(Lights, HorizonThroughALampIsCutExactly) {
    Lights::Parts parts;
    parts.triangles = {triangle({1.0F, -1.0F, 0.0F}, {1.0F, 1.0F, -1.0F}, {1.0F, 1.0F, 1.0F}, Rgb(1.0F), true)};
    const Lights lights(parts, nullptr, nullptr);
    // What is left above y = 0: a quadrilateral, as two triangles.
    const glm::vec3 p(1.0F, 0.0F, -0.5F), q(1.0F, 0.0F, 0.5F), r(1.0F, 1.0F, 1.0F), s(1.0F, 1.0F, -1.0F);
    const glm::vec3 up(0.0F, 1.0F, 0.0F);
    const double expected = polygonIrradiance(triangle(p, q, r, Rgb(1.0F)), glm::vec3(0.0F), up) +
                            polygonIrradiance(triangle(p, r, s, Rgb(1.0F)), glm::vec3(0.0F), up);
    const Estimate e = irradiance(lights, parts, glm::vec3(0.0F), up, 100000, 5);
    EXPECT_NEAR(e.mean, expected, 4.5 * e.error);
}

/// Solid angle of a triangle. [VanOosteromStrackee1983]
double solidAngle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 u = glm::normalize(a), v = glm::normalize(b), w = glm::normalize(c);
    return 2.0 *
           std::atan2(std::fabs(glm::dot(u, glm::cross(v, w))), 1.0 + glm::dot(u, v) + glm::dot(v, w) + glm::dot(w, u));
}

/// Directions to one triangle, counted in the 64 parts that halving its edges three times makes, against the solid
/// angle or the area of each part.
TEST(Lights, DirectionsToATriangleFollowTheDensity) {
    constexpr int kCut = 8, kSamples = 100000;
    const EmissiveTriangle t = triangle({-1.0F, 0.0F, 0.3F}, {1.5F, 0.2F, 0.0F}, {0.1F, 0.0F, 1.8F}, Rgb(1.0F), true);
    Lights::Parts parts;
    parts.triangles = {t};
    const Lights lights(parts, nullptr, nullptr);
    const std::vector<glm::vec3> points{
        {0.1F, 0.3F, 0.4F}, {0.1F, 0.15F, 0.6F}, {1.6F, 0.1F, 0.1F}, {-3.0F, 1.0F, 0.0F}, {4.0F, 9.0F, 9.0F}};
    for (std::size_t which = 0; which < points.size(); ++which) {
        const glm::vec3 point = points[which];
        const bool byArea = which == 4;
        const auto at = [&](int i, int j) {
            const glm::dvec3 a(t.corner[0]), b(t.corner[1]), c(t.corner[2]);
            return a + (b - a) * (static_cast<double>(i) / kCut) + (c - a) * (static_cast<double>(j) / kCut) -
                   glm::dvec3(point);
        };
        std::vector<double> expected(2 * kCut * kCut, 0.0), observed(2 * kCut * kCut, 0.0);
        double whole = 0.0;
        for (int i = 0; i < kCut; ++i)
            for (int j = 0; i + j < kCut; ++j)
                for (int half = 0; half < (i + j + 1 < kCut ? 2 : 1); ++half) {
                    const double part = byArea      ? 1.0
                                        : half == 0 ? solidAngle(at(i, j), at(i + 1, j), at(i, j + 1))
                                                    : solidAngle(at(i + 1, j + 1), at(i + 1, j), at(i, j + 1));
                    expected[static_cast<std::size_t>((i * kCut + j) * 2 + half)] = part;
                    whole += part;
                }
        for (double& e : expected) e *= kSamples / whole;
        std::mt19937_64 random(40 + which);
        double meanInverse = 0.0;
        for (int k = 0; k < kSamples; ++k) {
            const auto s = lights.sample(point, kNoNormal, 0.5F, uniform2(random));
            ASSERT_TRUE(s);
            meanInverse += 1.0 / static_cast<double>(s->pdfSolidAngle) / kSamples;
            // Back to barycentrics by least squares on the two edges.
            const glm::dvec3 e1 = glm::dvec3(t.corner[1]) - glm::dvec3(t.corner[0]),
                             e2 = glm::dvec3(t.corner[2]) - glm::dvec3(t.corner[0]);
            const glm::dvec3 d =
                glm::dvec3(point) + glm::dvec3(s->wi) * static_cast<double>(s->distance) - glm::dvec3(t.corner[0]);
            const glm::dvec3 normal = glm::cross(e1, e2);
            ASSERT_LT(std::fabs(glm::dot(normal, d)), 1e-4);
            const double norm = glm::dot(normal, normal);
            const double b1 = std::clamp(glm::dot(glm::cross(d, e2), normal) / norm, 0.0, 1.0 - 1e-6);
            const double b2 = std::clamp(glm::dot(glm::cross(e1, d), normal) / norm, 0.0, 1.0 - 1e-6 - b1);
            const int i = static_cast<int>(b1 * kCut), j = std::min(static_cast<int>(b2 * kCut), kCut - 1 - i);
            const bool upper = b1 * kCut - i + b2 * kCut - j > 1.0 && i + j + 1 < kCut;
            observed[static_cast<std::size_t>((i * kCut + j) * 2 + (upper ? 1 : 0))] += 1.0;
        }
        EXPECT_GT(testing::compareCounts(expected, observed).pValue, testing::sidakLevel(5)) << "point " << which;
        const double exact = solidAngle(at(0, 0), at(kCut, 0), at(0, kCut));
        EXPECT_NEAR(meanInverse / exact, 1.0, byArea ? 5e-3 : 1e-5) << "point " << which;
    }
}

TEST(Lights, PunctualLightsGiveTheirClosedForms) {
    Lights::Parts parts;
    parts.points = {{{0.0F, 2.0F, 0.0F}, Rgb(8.0F)}, {{1.0F, 1.0F, 0.0F}, Rgb(0.5F)}};
    parts.spots = {{{0.0F, 1.0F, 1.0F}, glm::normalize(glm::vec3(0.0F, -1.0F, -0.6F)), Rgb(3.0F), 0.99F, 0.8F}};
    parts.directionals = {{glm::normalize(glm::vec3(0.3F, -1.0F, 0.0F)), Rgb(1.2F)}};
    const Lights lights(parts, nullptr, nullptr);
    const glm::vec3 up(0.0F, 1.0F, 0.0F);
    const glm::dvec3 axis = glm::normalize(glm::dvec3(0.0, -1.0, -0.6)),
                     toLight = glm::normalize(glm::dvec3(0.0, 1.0, 1.0));
    const double t = (-glm::dot(axis, toLight) - 0.8) / 0.19;
    const double expected =
        8.0 / 4.0 + 0.5 / 2.0 / std::sqrt(2.0) + 3.0 * t * t / 2.0 / std::sqrt(2.0) + 1.2 / std::sqrt(1.09);
    const Estimate e = irradiance(lights, parts, glm::vec3(0.0F), up, 100000, 3);
    EXPECT_NEAR(e.mean, expected, 4.5 * e.error);
    EXPECT_LT(e.deviation, 0.2 * expected);
    Lights::Parts one;
    one.points = {parts.points[0]};
    const auto point = Lights(one, nullptr, nullptr).sample(glm::vec3(0.0F), up, 0.1F, {0.1F, 0.2F});
    ASSERT_TRUE(point && point->delta);
    EXPECT_FLOAT_EQ(point->radiance.r, 2.0F);
    EXPECT_FLOAT_EQ(point->pdfSolidAngle, 1.0F);
    EXPECT_FLOAT_EQ(point->distance, 2.0F);
}

Environment skyWithLamp() {
    EnvironmentDescription description;
    description.map = Image(32, 16, {"R", "G", "B"});
    for (std::size_t i = 0; i < description.map.pixels(); ++i) description.map.setRgb(i, Rgb(i < 256 ? 1.0F : 0.1F));
    description.map.setRgb(32 * 4 + 11, Rgb(60.0F));
    return Environment(std::move(description));
}

/// A few of every kind, in random places around the origin.
Lights::Parts mixed(int each, const Environment* environment, unsigned seed) {
    std::mt19937_64 random(seed);
    const auto place = [&] { return 4.0F * glm::vec3(uniform2(random), uniform(random)) - 2.0F; };
    Lights::Parts parts;
    parts.environment = environment;
    for (int i = 0; i < each; ++i) {
        parts.points.push_back({place(), Rgb(0.1F + uniform(random))});
        parts.spots.push_back({place(), glm::normalize(place()), Rgb(4.0F * uniform(random)), 0.9F, 0.5F});
        const glm::vec3 corner = place();
        parts.triangles.push_back(triangle(corner, corner + 0.2F * place(), corner + 0.2F * place(),
                                           Rgb(20.0F * uniform(random)), i % 2 == 0));
        parts.triangles.back().geometry = static_cast<std::uint32_t>(i % 5);
        parts.triangles.back().primitive = static_cast<std::uint32_t>(i);
    }
    parts.directionals = {{glm::normalize(place()), Rgb(0.7F)}};
    return parts;
}

/// The probabilities sum to one (over the tree to less) and are those with which lights are chosen, in the flat list
/// and in the tree.
TEST(Lights, ChoiceProbabilitiesSumToOneAndHold) {
    const Environment environment = skyWithLamp();
    for (const int each : {2, 40}) {
        const Lights lights(mixed(each, &environment, 17), nullptr, nullptr);
        std::mt19937_64 random(3);
        for (int k = 0; k < 40; ++k) {
            const glm::vec3 point = 6.0F * glm::vec3(uniform2(random), uniform(random)) - 3.0F;
            const glm::vec3 normal =
                k % 4 == 0 ? kNoNormal : glm::normalize(glm::vec3(uniform2(random), uniform(random)) - 0.5F);
            std::vector<double> expected(lights.count()), observed(lights.count(), 0.0);
            double sum = 0.0;
            for (std::uint32_t i = 0; i < lights.count(); ++i)
                sum += expected[i] = static_cast<double>(lights.choicePmf(i, point, normal));
            if (each == 2) {
                EXPECT_NEAR(sum, 1.0, 1e-5);
            }
            EXPECT_LT(sum, 1.0 + 1e-5);  // the tree may end in nothing; that share counts as nothing below
            if (k >= 4) continue;
            // Without a horizon nothing that is chosen is lost but spots and one-sided triangles seen from outside;
            // count the rest.
            constexpr int kSamples = 50000;
            double kept = 0.0;
            for (std::uint32_t i = 0; i < lights.count(); ++i) {
                const LightKind kind = lights.kind(i);
                if (kind == LightKind::Spot || kind == LightKind::Triangle || kind == LightKind::Environment)
                    expected[i] = 0.0;
                if (kind == LightKind::Directional && lights.choicePmf(i, point, normal) == 0.0F) expected[i] = 0.0;
                kept += expected[i];
                expected[i] *= kSamples;
            }
            expected.push_back(kSamples * (1.0 - kept));
            observed.push_back(0.0);
            for (int n = 0; n < kSamples; ++n) {
                const auto s = lights.sample(point, normal, uniform(random), uniform2(random));
                const bool counted =
                    s && (lights.kind(s->light) == LightKind::Point || lights.kind(s->light) == LightKind::Directional);
                observed[counted ? s->light : lights.count()] += 1.0;
            }
            EXPECT_GT(testing::compareCounts(expected, observed).pValue, testing::sidakLevel(8)) << each << ", " << k;
        }
    }
}

TEST(Lights, EnvironmentAndLampsTogetherAreUnbiased) {
    const Environment environment = skyWithLamp();
    Lights::Parts parts = quadLamp();
    parts.environment = &environment;
    const Lights lights(parts, nullptr, nullptr);
    const glm::vec3 point(0.4F, 0.0F, 0.1F), normal = glm::normalize(glm::vec3(0.2F, 1.0F, -0.3F));
    double expected = 0.0;
    for (const EmissiveTriangle& t : parts.triangles) expected += 2.0 * polygonIrradiance(t, point, normal);
    constexpr int kRows = 1000;
    for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < 2 * kRows; ++i) {
            const double theta = kPiD * (j + 0.5) / kRows, phi = kPiD * (i + 0.5) / kRows;
            const glm::vec3 d(
                glm::dvec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)));
            const double weight = std::sin(theta) * (kPiD / kRows) * (kPiD / kRows);
            expected += static_cast<double>(std::max(0.0F, glm::dot(d, normal)) * environment.radiance(d).g) * weight;
        }
    const Estimate e = irradiance(lights, parts, point, normal, 200000, 9);
    EXPECT_NEAR(e.mean, expected, 4.5 * e.error);
    EXPECT_LT(e.deviation, 1.2 * expected);
}

/// Ten thousand lights: the tree's estimate against the sum over all, and its variance against choosing by power.
TEST(Lights, TreeOverManyLightsIsUnbiasedAndBeatsPower) {
    Lights::Parts parts = mixed(3334, nullptr, 23);
    parts.directionals.clear();
    const Lights lights(parts, nullptr, nullptr);
    std::mt19937_64 random(5);
    for (int k = 0; k < 5; ++k) {
        const glm::vec3 point = 5.0F * glm::vec3(uniform2(random), uniform(random)) - 2.5F;
        const glm::vec3 normal = glm::normalize(glm::vec3(uniform2(random), uniform(random)) - 0.5F);
        // Sum and second moment by power, light by light with a few samples of each lamp alone.
        double expected = 0.0, powerSquares = 0.0;
        for (std::uint32_t i = 0; i < lights.count(); ++i) {
            Lights::Parts one;
            const std::size_t points = parts.points.size(), spots = parts.spots.size();
            if (i < points)
                one.points = {parts.points[i]};
            else if (i < points + spots)
                one.spots = {parts.spots[i - points]};
            else
                one.triangles = {parts.triangles[i - points - spots]};
            const Estimate e =
                irradiance(Lights(one, nullptr, nullptr), one, point, normal, i < points + spots ? 1 : 200, i);
            expected += e.mean;
            powerSquares += e.mean * e.mean / (lights.power(i) / lights.totalPower());
        }
        const Estimate e = irradiance(lights, parts, point, normal, 200000, 31 + static_cast<unsigned>(k));
        const double byPower = std::sqrt(powerSquares - expected * expected);
        EXPECT_NEAR(e.mean, expected, 4.5 * e.error + 0.003 * expected) << "point " << k;
        EXPECT_LT(e.deviation, 0.5 * byPower) << "point " << k;
        RecordProperty("deviation" + std::to_string(k), std::to_string(e.deviation / expected) + " tree, " +
                                                            std::to_string(byPower / expected) + " power");
    }
}

/// Bounds alone give the dark half of a glowing ball as much as its bright half, and a deviation of the mean's own size.
TEST(Lights, TreeOverAGlowingBallKnowsItsBrightSide) {
    constexpr int kRings = 32, kSegments = 64;
    constexpr float kRadius = 0.1F;
    const auto at = [](int ring, int segment) {
        const float theta = kPi * static_cast<float>(ring) / kRings,
                    phi = 2.0F * kPi * static_cast<float>(segment) / kSegments;
        return kRadius * glm::vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    };
    Lights::Parts parts;
    for (int r = 0; r < kRings; ++r)
        for (int s = 0; s < kSegments; ++s) {
            if (r > 0) parts.triangles.push_back(triangle(at(r, s), at(r + 1, s), at(r, s + 1), Rgb(1.0F)));
            if (r + 1 < kRings)
                parts.triangles.push_back(triangle(at(r + 1, s), at(r + 1, s + 1), at(r, s + 1), Rgb(1.0F)));
        }
    for (std::uint32_t i = 0; i < parts.triangles.size(); ++i) parts.triangles[i].primitive = i;
    const Lights lights(parts, nullptr, nullptr);
    const glm::vec3 normal(0.0F, 0.0F, 1.0F);
    for (const glm::vec3& point :
         {glm::vec3(0.3F, 0.1F, -1.0F), glm::vec3(0.0F, 0.6F, -0.5F), glm::vec3(0.05F, 0.0F, -0.2F)}) {
        const Estimate e = irradiance(lights, parts, point, normal, 100000, 3);
        const double distance = static_cast<double>(glm::length(point));
        const double expected =
            kPiD * std::pow(static_cast<double>(kRadius) / distance, 2.0) * static_cast<double>(-point.z) / distance;
        EXPECT_NEAR(e.mean, expected, 4.5 * e.error + 0.005 * expected);  // of the triangles, which lie within the ball
        EXPECT_LT(e.deviation, (distance > 5.0 * static_cast<double>(kRadius) ? 0.35 : 0.6) * expected)
            << e.deviation / expected;
        RecordProperty("deviation at " + std::to_string(distance), std::to_string(e.deviation / expected));
    }
}

TEST(Lights, ManyLightsBesideInfinityAreUnbiased) {
    EnvironmentDescription description;
    description.constant = Rgb(0.8F);
    const Environment environment(description);
    Lights::Parts parts = mixed(30, &environment, 29);
    parts.triangles.clear(), parts.spots.clear();
    const Lights lights(parts, nullptr, nullptr);
    const glm::vec3 point(0.1F, 0.2F, -0.4F),
        normal = glm::normalize(-parts.directionals[0].direction + glm::vec3(0.3F, 0.2F, 0.0F));
    double expected = kPiD * 0.8 + 0.7 * static_cast<double>(-glm::dot(normal, parts.directionals[0].direction));
    for (const PointEmitter& l : parts.points) {
        const glm::dvec3 to = glm::dvec3(l.position) - glm::dvec3(point);
        expected += static_cast<double>(l.intensity.r) * std::max(0.0, glm::dot(glm::dvec3(normal), to)) /
                    std::pow(glm::length(to), 3.0);
    }
    const Estimate e = irradiance(lights, parts, point, normal, 400000, 2);
    EXPECT_NEAR(e.mean, expected, 4.5 * e.error);
}

/// Radiance that falls from 2 at the first corner to 0 at the third, seen from the front only.
Rgb gradient(const void*, std::uint32_t, std::uint32_t, const glm::vec2& b, const glm::vec3&) {
    return Rgb(2.0F * (1.0F - b.y));
}

TEST(Lights, TexturedEmissionIsAskedAtTheSampledPoint) {
    Lights::Parts parts;
    parts.triangles = {triangle({0.0F, 1.0F, 0.0F}, {0.3F, 1.0F, 0.0F}, {0.0F, 1.0F, 0.3F}, Rgb(1.3F), true)};
    for (const float height : {-500.0F, 0.7F}) {
        const glm::vec3 point(0.1F, height, 0.1F), up(0.0F, 1.0F, 0.0F);
        double expected = 0.0;  // by quadrature over barycentrics
        constexpr int kSteps = 400;
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps - i; ++j) {
                const double shift = i + j == kSteps - 1 ? 1.0 / 3.0 : 0.5, weight = i + j == kSteps - 1 ? 0.5 : 1.0;
                const double b1 = (i + shift) / kSteps, b2 = (j + shift) / kSteps;
                const glm::dvec3 to = glm::dvec3(0.3 * b1, 1.0, 0.3 * b2) - glm::dvec3(point);
                const double d2 = glm::dot(to, to);
                expected += weight * 0.09 / kSteps / kSteps * 2.0 * (1.0 - b2) * to.y * to.y / (d2 * d2);
            }
        const Lights lights(parts, gradient, nullptr);
        const Estimate e = irradiance(lights, parts, point, up, 100000, 4);
        EXPECT_NEAR(e.mean, expected, 4.5 * e.error + 1e-4 * expected);
    }
}

TEST(Lights, BadLightsAreDroppedAndHardPlacesStayFinite) {
    const float nan = std::nanf("");
    Lights::Parts parts = quadLamp();
    parts.triangles.push_back(triangle(glm::vec3(1.0F), glm::vec3(1.0F), glm::vec3(2.0F), Rgb(1.0F)));
    parts.triangles.push_back(triangle({0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {2.0F, 0.0F, 0.0F}, Rgb(1.0F)));
    parts.triangles.push_back(triangle({0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, Rgb(0.0F)));
    parts.points = {{{0.0F, 0.5F, 0.0F}, Rgb(1.0F)}, {{0.0F, 0.5F, 0.0F}, Rgb(0.0F)}, {{nan, 0.5F, 0.0F}, Rgb(1.0F)}};
    parts.spots = {{{0.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, Rgb(1.0F), 1.0F, 1.0F}};
    for (const std::size_t extra : {std::size_t{0}, std::size_t{40}}) {
        for (std::size_t i = 0; i < extra; ++i)
            parts.points.push_back({{0.0F, 0.5F, 0.0F}, Rgb(1.0F)});  // all in one place
        const Lights lights(parts, nullptr, nullptr);
        ASSERT_EQ(lights.count(), 3U + extra);
        std::mt19937_64 random(1);
        for (const glm::vec3& point :
             {glm::vec3(0.0F, 0.5F, 0.0F), glm::vec3(-0.5F, 1.0F, -0.5F), glm::vec3(0.1F, 1.0F, 0.0F),
              glm::vec3(3.0F, 1.0F, 0.0F), glm::vec3(0.0F, 1.0F - 1e-7F, 0.0F), glm::vec3(0.5F, 1.0F - 1e-6F, 0.0F)})
            for (const glm::vec3& normal : {kNoNormal, glm::vec3(0.0F, 1.0F, 0.0F), glm::vec3(1.0F, 0.0F, 0.0F)})
                for (int i = 0; i < 300; ++i) {
                    const auto s = lights.sample(point, normal, uniform(random), uniform2(random));
                    const float pdf =
                        lights.pdfTriangle(point, normal, 3, i % 2 == 0 ? 0U : 7U, {0.0F, 1.0F, 0.0F}, 1e-3F);
                    EXPECT_TRUE(std::isfinite(pdf) && pdf >= 0.0F);
                    if (!s) continue;
                    EXPECT_TRUE(isFinite(s->wi) && isFinite(s->radiance) && std::isfinite(s->pdfSolidAngle) &&
                                s->pdfSolidAngle > 0.0F);
                }
        EXPECT_EQ(lights.pdfTriangle(glm::vec3(0.0F), kNoNormal, 3, 5, {0.0F, 1.0F, 0.0F}, 1.0F), 0.0F);
        EXPECT_EQ(lights.pdfTriangle(glm::vec3(0.0F), kNoNormal, 9, 0, {0.0F, 1.0F, 0.0F}, 1.0F), 0.0F);
    }
    const Lights none(Lights::Parts{}, nullptr, nullptr);
    EXPECT_FALSE(none.sample(glm::vec3(0.0F), kNoNormal, 0.5F, {0.5F, 0.5F}));
    EXPECT_FALSE(none.sampleEmission({}));
}

}  // namespace
}  // namespace pellucid

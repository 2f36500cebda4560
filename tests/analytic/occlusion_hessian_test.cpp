/// Derivatives of the irradiance that decide how far a cache record speaks, against finite differences of closed forms: the
/// edges of a polygon (Lambert's formula, form 8), a corner (form 10), a distant environment (form 12).
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/math/constants.h>
#include <pellucid/math/hash.h>

#include "../../src/transport/gather_gradients.h"
#include "../../src/transport/occlusion_hessian.h"
#include "../../src/transport/record_radius.h"

namespace pellucid {
namespace {

using Polygon = std::vector<glm::dvec3>;

/// F = 1/(2 pi) sum gamma_i n.Gamma_i. [Lambert1760]
[[nodiscard]] double formFactor(const Polygon& polygon, const glm::dvec3& at, const glm::dvec3& normal) {
    double sum = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 a = polygon[i] - at, b = polygon[(i + 1) % polygon.size()] - at, c = glm::cross(a, b);
        sum += std::atan2(glm::length(c), glm::dot(a, b)) * glm::dot(normal, c) / glm::length(c);
    }
    return sum / (2.0 * kPiD);
}

[[nodiscard]] glm::dvec3 axis(glm::length_t i) {
    glm::dvec3 v(0.0);
    v[i] = 1.0;
    return v;
}

TEST(OcclusionHessian, EdgesAreTheDerivativesOfLambertsFormula) {
    std::uint64_t counter = 0;
    const auto next = [&counter] {
        return static_cast<double>(hashCombine(7, counter++) >> 40U) * 0x1p-24 * 2.0 - 1.0;
    };
    const double h = 1e-4;
    for (int round = 0; round < 50; ++round) {
        Polygon polygon;
        const int corners = 3 + round % 3;
        for (int i = 0; i < corners; ++i) {
            const double phi = 2.0 * kPiD * (i + 0.3 * next()) / corners;
            polygon.emplace_back(0.3 * next() + 1.2 * std::cos(phi), 0.8 * std::sin(phi), 1.5 + 0.5 * next());
        }
        const glm::dvec3 normal = glm::normalize(glm::dvec3(0.2 * next(), 0.2 * next(), 1.0));
        const auto factor = [&](const glm::dvec3& at) { return formFactor(polygon, at, normal); };
        EdgeDerivatives sum;
        for (int i = 0; i < corners; ++i) {
            const EdgeDerivatives edge = edgeDerivatives(polygon[static_cast<std::size_t>(i)],
                                                         polygon[static_cast<std::size_t>((i + 1) % corners)], normal);
            sum.gradient += edge.gradient;
            sum.hessian += edge.hessian;
        }
        for (glm::length_t a = 0; a < 3; ++a) {
            EXPECT_NEAR(sum.gradient[a], (factor(h * axis(a)) - factor(-h * axis(a))) / (2.0 * h), 1e-6) << round;
            for (glm::length_t b = 0; b < 3; ++b) {
                const glm::dvec3 u = h * axis(a), v = h * axis(b);
                const double expected =
                    (factor(u + v) - factor(u - v) - factor(v - u) + factor(-u - v)) / (4.0 * h * h);
                EXPECT_NEAR(sum.hessian[a][b], expected, 1e-5) << round << ": " << a << b;
            }
        }
    }
}

TEST(OcclusionHessian, EdgesThatHaveNoDerivativesAreZero) {
    const glm::dvec3 n(0, 0, 1);
    for (const auto& [from, to] :
         {std::pair(glm::dvec3(1, 0, 1), glm::dvec3(1, 0, 1)), std::pair(glm::dvec3(1, 0, 1), glm::dvec3(2, 0, 2))}) {
        const EdgeDerivatives d = edgeDerivatives(from, to, n);
        EXPECT_EQ(glm::length(d.gradient), 0.0);
        EXPECT_EQ(d.hessian[0][0] + d.hessian[1][1] + d.hessian[2][2], 0.0);
    }
}

struct Seen {
    double radiance = 0.0, distance = std::numeric_limits<double>::infinity();
};

/// A gather of about `rays` rays at the origin, z up, of what `look` says.
[[nodiscard]] GatherGrid gatherOf(int rays, const std::function<Seen(const glm::dvec3&)>& look) {
    GatherGrid g(rays);
    std::uint64_t counter = 0;
    const auto next = [&counter] { return static_cast<double>(hashCombine(3, counter++) >> 40U) * 0x1p-24; };
    for (int j = 0; j < g.elevations; ++j)
        for (int k = 0; k < g.azimuths; ++k) {
            const double sine = std::sqrt((j + next()) / g.elevations), phi = 2.0 * kPiD * (k + next()) / g.azimuths;
            const glm::dvec3 d(sine * std::cos(phi), sine * std::sin(phi), std::sqrt(1.0 - sine * sine));
            const Seen seen = look(d);
            GatherCell& cell = g.at(j, k);
            cell.direction = glm::vec3(d);
            cell.radiance = Rgb(static_cast<float>(seen.radiance));
            cell.distance = static_cast<float>(seen.distance);
        }
    return g;
}

const Frame kFrame(glm::vec3(0, 0, 1));

/// A wall of height h at distance x in front of a receiver on the floor; over it the sky.
[[nodiscard]] Seen wallAt(double x, double h, double ofWall, double ofSky, const glm::dvec3& d) {
    if (d.x > 0.0 && d.z / d.x * x < h) return {ofWall, x / d.x};
    return {ofSky};
}

TEST(OcclusionHessian, OfAWallThatShinesOrHides) {
    // E = pi (1 - x / sqrt(x^2 + h^2)) / 2, form 10: its second derivative is 3 pi x h^2 / (2 (x^2 + h^2)^2.5).
    // The edge is seen up to a stratum away from where it is: an error of 9 to 10 over M where it is steepest.
    for (const double x : {0.3, 0.8, 2.0})
        for (const auto& [rays, shines] :
             {std::pair(3'000, true), {12'000, true}, {12'000, false}, {200'000, true}, {200'000, false}}) {
            const GatherGrid g = gatherOf(rays, [&, light = shines](const glm::dvec3& d) {
                return wallAt(x, 1.0, light ? 1 : 0, light ? 0 : 1, d);
            });
            const TangentCurvature t = tangentCurvature(occlusionHessian(g, kFrame, 1e-4F, 100.0F), kFrame);
            const double expected = (shines ? 1.5 : -1.5) * kPiD * x / std::pow(x * x + 1.0, 2.5);
            const double tolerance = 11.0 / g.elevations * std::fabs(expected);
            EXPECT_NEAR(t.first, expected, tolerance) << x << (shines ? " shines " : " hides ") << rays;
            EXPECT_NEAR(t.second, 0.0, tolerance) << x << " " << rays;
            EXPECT_GT(std::fabs(t.axis.x), 0.98F) << "the light changes across the wall, not along it";
        }
}

TEST(OcclusionHessian, OfALampOverTheFloorAtTheRaysOfARecord) {
    const Polygon lamp{{0.3, -0.5, 1.0}, {1.3, -0.5, 1.0}, {1.3, 0.5, 1.0}, {0.3, 0.5, 1.0}};
    const auto look = [](const glm::dvec3& d) -> Seen {
        const glm::dvec3 p = d / d.z;
        const bool inside = p.x > 0.3 && p.x < 1.3 && std::fabs(p.y) < 0.5;
        return inside ? Seen{1.0, 1.0 / d.z} : Seen{0.0, 20.0};
    };
    const auto irradiance = [&](double x, double y) { return kPiD * formFactor(lamp, {x, y, 0}, {0, 0, 1}); };
    const double h = 1e-3, e = irradiance(0, 0);
    const double xx = (irradiance(h, 0) + irradiance(-h, 0) - 2.0 * e) / (h * h),
                 yy = (irradiance(0, h) + irradiance(0, -h) - 2.0 * e) / (h * h);
    for (const auto& [rays, tolerance] : {std::pair(400, 0.35), std::pair(20'000, 0.06)}) {
        const glm::dmat3 hessian = occlusionHessian(gatherOf(rays, look), kFrame, 1e-4F, 100.0F);
        const glm::dvec3 u(kFrame.tangent), v(kFrame.bitangent);
        const double size = std::max(std::fabs(xx), std::fabs(yy));
        EXPECT_NEAR(glm::dot(u, hessian * u), u.x * u.x * xx + u.y * u.y * yy, tolerance * size) << rays;
        EXPECT_NEAR(glm::dot(v, hessian * v), v.x * v.x * xx + v.y * v.y * yy, tolerance * size) << rays;
    }
}

TEST(OcclusionHessian, OfADistantEnvironmentIsNothing) {
    // L = 1 + a.w: E = pi + (2 pi / 3) a.n, form 12. It turns with the normal and does not change with the place.
    const glm::dvec3 a(0.3, -0.4, 0.2);
    const GatherGrid g = gatherOf(20'000, [&](const glm::dvec3& d) { return Seen{1.0 + glm::dot(a, d)}; });
    IrradianceRecord record;
    record.normal = kFrame.normal;
    addRotation(g, kFrame, record);
    addTranslation(g, kFrame, 0.0F, record);
    const glm::dvec3 expected = 2.0 * kPiD / 3.0 * glm::cross(glm::dvec3(0, 0, 1), a);
    EXPECT_NEAR(glm::length(glm::dvec3(record.rotation[1]) - expected), 0.0, 0.02 * glm::length(expected));
    EXPECT_EQ(glm::length(record.translation[1]), 0.0F);
    const TangentCurvature t = tangentCurvature(occlusionHessian(g, kFrame, 1e-4F, 100.0F), kFrame);
    EXPECT_LT(std::fabs(t.first), 1e-3 * kPiD);
}

TEST(OcclusionHessian, RecordsAreLongAlongAWallAndShortTowardsIt) {
    const auto radiusOf = [](const GatherGrid& g) {
        IrradianceRecord record;
        record.normal = kFrame.normal;
        record.irradiance = Rgb(1.0F);
        GatherOptions options;
        options.metric = CacheMetric::Hessian;
        options.minRadius = 1e-3F;
        options.maxRadius = 10.0F;
        setRadius(g, kFrame, options, record);
        return record;
    };
    const IrradianceRecord near =
        radiusOf(gatherOf(2000, [](const glm::dvec3& d) { return wallAt(0.1, 1.0, 0.2, 1.0, d); }));
    const IrradianceRecord far =
        radiusOf(gatherOf(2000, [](const glm::dvec3& d) { return wallAt(1.0, 1.0, 0.2, 1.0, d); }));
    EXPECT_GT(near.radius, 0.0F);
    EXPECT_LT(near.radius, far.radius * 1.5F);
    EXPECT_GT(glm::length(far.squeeze), 0.5F);
    EXPECT_GT(std::fabs(glm::normalize(far.squeeze).x), 0.95F) << "narrow across the wall's direction";
}

TEST(BlockedAzimuths, AreThoseWhereSomethingStandsNear) {
    const auto blocked = [](double x, double reach) {
        const GatherGrid g = gatherOf(128, [&](const glm::dvec3& d) { return wallAt(x, 1.0, 1.0, 0.0, d); });
        IrradianceRecord record;
        setBlocked(g, kFrame, static_cast<float>(reach), record);
        return record.blocked;
    };
    const auto has = [](std::uint32_t mask, double phi) {
        const auto sector = static_cast<unsigned>(phi / (2.0 * kPiD) * kBlockedSectors);
        return (mask >> sector & 1U) != 0;
    };
    // Frame(z) has x as its tangent: the wall stands around azimuth 0.
    EXPECT_TRUE(has(blocked(0.1, 0.3), 0.1) && has(blocked(0.1, 0.3), 2.0 * kPiD - 0.1));
    EXPECT_FALSE(has(blocked(0.1, 0.3), kPiD)) << "nothing stands behind";
    EXPECT_EQ(blocked(0.5, 0.3), 0U) << "out of reach";
}

}  // namespace
}  // namespace pellucid

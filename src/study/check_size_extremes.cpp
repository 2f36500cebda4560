// Extremes of number and size: a million instances, an environment of 134 million texels.
#include <cmath>

#include <pellucid/math/constants.h>

#include "check_cases.h"
#include "check_formulas.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

constexpr double kRho = 0.5, kPatch = 0.4;
const glm::dvec3 kUp(0, 0, 1);

/// A floor of 1000 x 1000 tiles of one mesh, each five strips wide, under a point light: form 9.
std::vector<Finding> millionInstances(const CheckContext& context) {
    constexpr int kSide = 1000, kStrips = 5;
    constexpr double kTile = 2.0 / kSide;
    SceneBuilder b;
    Mesh tile;
    for (int i = 0; i <= kStrips; ++i)
        for (const float y : {0.0F, 1.0F}) tile.positions.emplace_back(static_cast<float>(i) / kStrips, y, 0.0F);
    for (std::uint32_t i = 0; i < kStrips; ++i) {
        tile.triangles.emplace_back(2 * i, 2 * i + 2, 2 * i + 3);
        tile.triangles.emplace_back(2 * i, 2 * i + 3, 2 * i + 1);
    }
    b.mesh(tile, lambert(static_cast<float>(kRho)));
    auto& geometries = b.description().geometries;
    const Geometry first = geometries.front();
    geometries.clear();
    geometries.reserve(static_cast<std::size_t>(kSide) * kSide);
    for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i) {
            Geometry g = first;
            g.toWorld = glm::dmat4(0.0);
            g.toWorld[0][0] = g.toWorld[1][1] = kTile;
            g.toWorld[2][2] = g.toWorld[3][3] = 1.0;
            g.toWorld[3] = glm::dvec4(-1.0 + kTile * i, -1.0 + kTile * j, 0.0, 1.0);
            geometries.push_back(g);
        }
    const glm::dvec3 light(0.4, -0.3, 0.8);
    b.point(light, 2.0);
    b.view(glm::dvec3(0.0), kUp, kPatch, 0.3);
    const double expected = meanOverSquare([&](double u, double v) {
        return pointIrradiance({kPatch * (u - 0.5), kPatch * (v - 0.5), 0.0}, kUp, light, 2.0);
    });
    return measure(context, {std::move(b.description()),
                             {},
                             expected,
                             kPiD / kRho,
                             "irradiance",
                             {{Method::Path, 2, 0.0}, {Method::Photon, 2, 0.005}},
                             16,
                             smallSettings()});
}

/// 1 + a.w at 16384 x 8192: form 12.
std::vector<Finding> hugeEnvironment(const CheckContext& context) {
    const glm::dvec3 a(0.3, 0.5, -0.2);
    EnvironmentDescription sky;
    sky.map = Image(16384, 8192, {"R", "G", "B"});
    context.workers.forEach(8192, 16, [&](std::size_t y) {
        const double theta = kPiD * (static_cast<double>(y) + 0.5) / 8192.0, s = std::sin(theta), c = std::cos(theta);
        for (std::size_t x = 0; x < 16384; ++x) {
            const double phi = 2.0 * kPiD * ((static_cast<double>(x) + 0.5) / 16384.0 - 0.5);
            const double value = 1.0 + a.x * s * std::cos(phi) + a.y * c + a.z * s * std::sin(phi);
            sky.map.setRgb(y * 16384 + x, Rgb(static_cast<float>(value)));
        }
    });
    const glm::dvec3 n(0, 1, 0);
    SceneBuilder b;
    b.square(glm::dvec3(0.0), n, 0.5, lambert(static_cast<float>(kRho)));
    b.view(glm::dvec3(0.0), n, 0.5, 1.0);
    return measure(context, {b.description(),
                             std::move(sky),
                             kPiD + 2.0 * kPiD / 3.0 * a.y,
                             kPiD / kRho,
                             "irradiance",
                             {{Method::Path, 8, 0.0, 0.02}, {Method::Photon, 16, 0.005, 0.03}},
                             16,
                             smallSettings()});
}

}  // namespace

void addSizeExtremes(Cases& cases) {
    cases.push_back({"extreme-million-instances", CheckGroup::Extreme,
                     "I cos / d^2 on a floor of 1e6 instances, 1e7 triangles", "inverse square law", false,
                     millionInstances});
    cases.push_back({"extreme-huge-environment", CheckGroup::Extreme, "L = 1 + a.w from a map of 16384 x 8192 texels",
                     "spherical harmonics, [RamamoorthiHanrahan2001]", false, hugeEnvironment});
}

}  // namespace pellucid::check

#include <array>
#include <cmath>

#include "materials.h"
#include "scenes.h"

namespace scenes {

/// A room open towards the camera, 2.4 x 2 x 2.4 m, with a mirror ball on a plinth and a glass ball in front of it.
GlbWriter glassAndMirror() {
    GlbWriter scene("glass-and-mirror");
    const auto pale = scene.addMaterial(lambert("pale", {0.74, 0.72, 0.68}));
    const auto orange = scene.addMaterial(lambert("orange", {0.68, 0.26, 0.07}));
    const auto teal = scene.addMaterial(lambert("teal", {0.08, 0.36, 0.42}));
    const auto mirror = scene.addMaterial(metal("mirror", {1.0, 1.0, 1.0}, 0.0));
    const auto glass = scene.addMaterial(dielectric("glass", 1.5));
    const auto light = scene.addMaterial(lamp("lamp", {230.0, 205.0, 160.0}));

    scene.add("floor", withoutUvs(floorQuad({0.0, 0.0, 0.0}, 2.4, 2.4)), pale);
    scene.add("ceiling", withoutUvs(ceilingQuad({0.0, 2.0, 0.0}, 2.4, 2.4)), pale);
    scene.add("back", withoutUvs(quad({-1.2, 0.0, -1.2}, {2.4, 0.0, 0.0}, {0.0, 2.0, 0.0})), pale);
    scene.add("left", withoutUvs(quad({-1.2, 0.0, 1.2}, {0.0, 0.0, -2.4}, {0.0, 2.0, 0.0})), orange);
    scene.add("right", withoutUvs(quad({1.2, 0.0, -1.2}, {0.0, 0.0, 2.4}, {0.0, 2.0, 0.0})), teal);
    scene.add("plinth", withoutUvs(turned(box({-0.34, 0.0, -0.34}, {0.34, 0.34, 0.34}), {0.0, 1.0, 0.0}, 18.0)), pale,
              {{-0.5, 0.0, -0.5}});
    scene.add("mirror-ball", sphere(0.38, 80, 40), mirror, {{-0.5, 0.721, -0.5}});
    scene.add("glass-ball", sphere(0.36, 96, 48), glass, {{0.48, 0.361, 0.35}});
    scene.add("lamp", withoutUvs(ceilingQuad({0.1, 1.985, 0.0}, 0.16, 0.16)), light);
    scene.addCamera("camera", {{0.0, 1.0, 5.0}, {0.0, 0.95, 0.0}, 30.0, 1.0});
    return scene;
}

namespace {

constexpr int kGobletSegments = 64;
constexpr glm::dvec2 kBowlCentre{0.0, 0.145}, kBowlAxes{0.036, 0.050};
constexpr double kBowlThickness = 0.0018, kBowlTopDegrees = 38.0;

/// Foot, stem and bowl in one closed body: up the outside, over the round rim, down the inside.
Profile gobletProfile() {
    const Profile outer = ellipseArc(kBowlCentre, kBowlAxes, -72.0, kBowlTopDegrees, 20, kBowlThickness);
    const Profile inner = reversed(ellipseArc(kBowlCentre, kBowlAxes, -90.0, kBowlTopDegrees, 22));
    const glm::dvec2 rimNormal = outer.back().normal;
    const double rimDegrees = glm::degrees(std::atan2(rimNormal.y, rimNormal.x));
    const glm::dvec2 rimCentre = 0.5 * (outer.back().position + inner.front().position);
    const Profile wholeRim = arc(rimCentre, 0.5 * kBowlThickness, rimDegrees, rimDegrees + 180.0, 6);
    const Profile rim(wholeRim.begin() + 1, wholeRim.end() - 1);
    const Profile stem = spline({{0.050, 0.0010},
                                 {0.034, 0.0022},
                                 {0.020, 0.0042},
                                 {0.009, 0.0100},
                                 {0.0043, 0.0240},
                                 {0.0038, 0.0500},
                                 {0.0042, 0.0740},
                                 {0.0052, 0.0875},
                                 {0.0078, 0.0933},
                                 outer[0].position,
                                 outer[1].position},
                                4);
    return line({0.0, 0.0}, {0.034, 0.0}) + arc({0.034, 0.0011}, 0.0011, -90.0, 90.0, 6) +
           Profile(stem.begin() + 1, stem.end() - 1) + outer + rim + inner;
}

/// The wine stays `gap` away from the glass, so that no two surfaces coincide and each body stands in air.
Profile wineProfile() {
    constexpr double kGap = 0.0002, kFillDegrees = 4.0;
    const Profile wall = ellipseArc(kBowlCentre, kBowlAxes, -90.0, kFillDegrees, 24, -kGap);
    return wall + line(wall.back().position, {0.0, wall.back().position.y});
}

}  // namespace

/// A wine glass on a table, lit from behind by a small lamp, so that its caustic falls towards the camera.
GlbWriter goblet() {
    GlbWriter scene("goblet");
    const auto table = scene.addMaterial(lambert("table", {0.66, 0.62, 0.56}));
    const auto wall = scene.addMaterial(lambert("wall", {0.42, 0.48, 0.52}));
    const auto glass = scene.addMaterial(dielectric("glass", 1.52));
    const auto wine = scene.addMaterial(absorbing(dielectric("wine", 1.34), {0.72, 0.07, 0.11}, 0.02));
    const auto light = scene.addMaterial(lamp("lamp", {420.0, 390.0, 330.0}));

    scene.add("table", withoutUvs(floorQuad({0.0, 0.0, 0.05}, 1.6, 1.1)), table);
    scene.add("wall", withoutUvs(quad({-0.8, 0.0, -0.5}, {1.6, 0.0, 0.0}, {0.0, 1.0, 0.0})), wall);
    scene.add("goblet", lathe(gobletProfile(), kGobletSegments), glass, {{0.0, 0.0002, 0.0}});
    scene.add("wine", lathe(wineProfile(), kGobletSegments), wine, {{0.0, 0.0002, 0.0}});
    const glm::dvec3 lampAt(-0.32, 0.5, -0.3);
    scene.add("lamp", withoutUvs(facingQuad(lampAt, {0.0, 0.05, 0.05}, 0.05)), light);
    scene.addCamera("camera", {{0.12, 0.26, 0.58}, {0.03, 0.085, 0.0}, 30.0, 4.0 / 3.0});
    return scene;
}

namespace {

/// A few sine waves of unequal length and heading: height and slopes.
glm::dvec3 waterAt(double x, double z) {
    struct Wave {
        double amplitude, kx, kz, phase;
    };
    constexpr std::array<Wave, 6> kWaves{{{0.0110, 2.9, 1.3, 0.4},
                                          {0.0080, -1.7, 4.1, 1.9},
                                          {0.0052, 5.3, -3.7, 3.1},
                                          {0.0036, 3.1, 7.3, 5.0},
                                          {0.0024, -8.3, 3.9, 0.9},
                                          {0.0016, 7.7, 8.9, 2.3}}};
    glm::dvec3 value(-0.14, 0.0, 0.0);
    for (const Wave& wave : kWaves) {
        const double angle = wave.kx * x + wave.kz * z + wave.phase;
        value += wave.amplitude * glm::dvec3(std::sin(angle), wave.kx * std::cos(angle), wave.kz * std::cos(angle));
    }
    return value;
}

/// Blue tiles in four shades, with every eighth column dark as a lane mark.
glm::u8vec4 tileColor(int column, int row) {
    constexpr std::array<glm::u8vec3, 4> kShades{{{120, 185, 200}, {105, 170, 195}, {135, 195, 205}, {90, 155, 190}}};
    if (column % 8 == 4) {
        return {30, 60, 105, 255};
    }
    const auto mixed = static_cast<unsigned>(column * 73 + row * 151 + column * row * 7);
    return {kShades[(mixed >> 1) % kShades.size()], 255};
}

}  // namespace

/// A tiled pool, 4 x 3 x 1.2 m, under the sun. The water is an open surface that reaches 1 cm into the walls.
GlbWriter pool() {
    GlbWriter scene("pool");
    const auto tile = scene.addMaterial(lambert("tile", {1.0, 1.0, 1.0}));
    const auto stone = scene.addMaterial(lambert("stone", {0.62, 0.57, 0.50}));
    const auto red = scene.addMaterial(lambert("red", {0.70, 0.10, 0.07}));
    const auto water = scene.addMaterial(dielectric("water", 1.333));

    constexpr double kX = 2.0, kZ = 1.5, kDepth = 1.2, kBorder = 1.0;
    scene.add("bottom", tiles({-kX, -kDepth, kZ}, {2 * kX, 0, 0}, {0, 0, -2 * kZ}, 16, 12, tileColor), tile);
    scene.add("north", tiles({-kX, -kDepth, -kZ}, {2 * kX, 0, 0}, {0, kDepth, 0}, 16, 5, tileColor), tile);
    scene.add("south", tiles({kX, -kDepth, kZ}, {-2 * kX, 0, 0}, {0, kDepth, 0}, 16, 5, tileColor), tile);
    scene.add("west", tiles({-kX, -kDepth, kZ}, {0, 0, -2 * kZ}, {0, kDepth, 0}, 12, 5, tileColor), tile);
    scene.add("east", tiles({kX, -kDepth, -kZ}, {0, 0, 2 * kZ}, {0, kDepth, 0}, 12, 5, tileColor), tile);
    scene.add("terrace",
              withoutUvs(merged({floorQuad({0, 0, -kZ - kBorder / 2}, 2 * (kX + kBorder), kBorder),
                                 floorQuad({0, 0, kZ + kBorder / 2}, 2 * (kX + kBorder), kBorder),
                                 floorQuad({-kX - kBorder / 2, 0, 0}, kBorder, 2 * kZ),
                                 floorQuad({kX + kBorder / 2, 0, 0}, kBorder, 2 * kZ)})),
              stone);
    scene.add("diving-ball", sphere(0.22, 40, 20), red, {{0.75, -kDepth + 0.221, 0.1}});
    scene.add("water", heightfield({-kX - 0.01, -kZ - 0.01}, {kX + 0.01, kZ + 0.01}, 96, 72, waterAt), water);
    scene.addLight({{"name", "sun"}, {"type", "directional"}, {"color", {1.0, 0.95, 0.86}}, {"intensity", 3.2}},
                   {0.0, 5.0, 0.0}, {0.35, -1.0, -0.2});
    scene.addCamera("camera", {{-0.6, 2.9, 4.4}, {0.0, -0.5, -0.1}, 40.0, 4.0 / 3.0});
    return scene;
}

}  // namespace scenes

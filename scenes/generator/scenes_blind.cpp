#include <cmath>

#include "materials.h"
#include "scenes.h"

namespace scenes {

namespace {

constexpr double kPrismTurn = 45.0;

/// Plan points (x, -z) turned counter-clockwise about the origin, seen from above.
std::vector<glm::dvec2> turnedLeft(std::vector<glm::dvec2> points, double degrees) {
    const double c = std::cos(glm::radians(degrees)), s = std::sin(glm::radians(degrees));
    for (glm::dvec2& point : points) {
        point = {c * point.x - s * point.y, s * point.x + c * point.y};
    }
    return points;
}

}  // namespace

/// A narrow spot light through a standing glass prism onto a screen: the caustic is E D S+ L from a point, so a path
/// tracer never finds it. A weak lamp fills the room. The beam meets the prism near its least deviation, 37 degrees.
GlbWriter prismSpot() {
    GlbWriter scene("prism-spot");
    const auto table = scene.addMaterial(lambert("table", {0.45, 0.42, 0.40}));
    const auto screen = scene.addMaterial(lambert("screen", {0.78, 0.78, 0.76}));
    const auto glass = scene.addMaterial(dielectric("glass", 1.5));
    const auto block = scene.addMaterial(lambert("block", {0.15, 0.30, 0.55}));
    const auto fill = scene.addMaterial(lamp("fill", {8.0, 8.6, 9.8}));

    scene.add("table", withoutUvs(floorQuad({0.0, 0.0, 0.0}, 1.6, 1.2)), table);
    scene.add("screen", withoutUvs(quad({-0.8, 0.0, -0.6}, {1.6, 0.0, 0.0}, {0.0, 0.9, 0.0})), screen);
    scene.add("side", withoutUvs(quad({0.8, 0.0, -0.6}, {0.0, 0.0, 1.2}, {0.0, 0.9, 0.0})), screen);
    scene.add("block", withoutUvs(turned(box({-0.07, 0.0, -0.07}, {0.07, 0.14, 0.07}), {0.0, 1.0, 0.0}, 25.0)), block,
              {{-0.35, 0.0, -0.15}});

    // An equilateral triangle of edge 0.16 m, 1 mm above the table. Its base looks towards the screen and the right.
    const double apex = 0.16 / std::sqrt(3.0);
    scene.add("prism",
              extrusion(turnedLeft({{0.0, -apex}, {0.08, 0.5 * apex}, {-0.08, 0.5 * apex}}, kPrismTurn), 0.001, 0.22),
              glass);

    // Before the turn the beam heads 18.6 degrees to the right of +x, meets the left face at 48.6 degrees, runs along
    // +x inside and leaves 18.6 degrees to the left.
    const glm::dvec2 beam =
        turnedLeft({{std::cos(glm::radians(18.6)), -std::sin(glm::radians(18.6))}}, kPrismTurn).front();
    const glm::dvec2 entry = turnedLeft({{-0.04, -0.25 * apex}}, kPrismTurn).front();
    const glm::dvec3 direction(beam.x, 0.0, -beam.y);
    scene.addLight({{"name", "spot"},
                    {"type", "spot"},
                    {"color", {1.0, 0.93, 0.8}},
                    {"intensity", 6.0},
                    {"spot", {{"innerConeAngle", 0.045}, {"outerConeAngle", 0.06}}}},
                   glm::dvec3(entry.x, 0.12, -entry.y) - 0.6 * direction, direction);
    scene.add("fill", withoutUvs(ceilingQuad({0.0, 1.1, 0.3}, 0.4, 0.4)), fill);
    scene.addCamera("camera", {{0.0, 0.70, 1.05}, {0.1, 0.14, -0.2}, 42.0, 4.0 / 3.0});
    return scene;
}

/// Heavy flint behind a slit: a thread of sunlight along +x falls apart into its colours on the screen, near its least
/// deviation of 58.6 degrees. The sun is far and the slit narrow: hardly a photon would find it without guide.
GlbWriter rainbow() {
    GlbWriter scene("rainbow");
    const auto table = scene.addMaterial(lambert("table", {0.42, 0.40, 0.38}));
    const auto screen = scene.addMaterial(lambert("screen", {0.80, 0.80, 0.78}));
    const auto flint = scene.addMaterial(dispersing(dielectric("flint", 1.72), 28.0));
    const auto plate = scene.addMaterial(lambert("plate", {0.10, 0.11, 0.13}));
    const auto fill = scene.addMaterial(lamp("fill", {3.4, 3.7, 4.2}));
    scene.add("table", withoutUvs(floorQuad({0.0, 0.0, 0.0}, 1.6, 1.2)), table);
    scene.add("screen", withoutUvs(quad({-0.8, 0.0, -0.6}, {1.6, 0.0, 0.0}, {0.0, 0.6, 0.0})), screen);
    scene.add("side", withoutUvs(quad({0.8, 0.0, -0.6}, {0.0, 0.0, 1.2}, {0.0, 0.6, 0.0})), screen);

    // Before the turn the beam heads 29.3 degrees to the right of +x and meets the left face at 59.3 degrees.
    const double apex = 0.16 / std::sqrt(3.0), turn = 29.3;
    scene.add("prism",
              extrusion(turnedLeft({{0.0, -apex}, {0.08, 0.5 * apex}, {-0.08, 0.5 * apex}}, turn), 0.001, 0.22), flint);
    const double slit = -turnedLeft({{-0.04, -0.25 * apex}}, turn).front().y, half = 0.004, x = -0.3;
    scene.add("plate", withoutUvs(box({x - 0.01, 0.0, -0.6}, {x, 0.6, slit - half})), plate);
    scene.add("plate", withoutUvs(box({x - 0.01, 0.0, slit + half}, {x, 0.6, 1.2})), plate);
    scene.add("sill", withoutUvs(box({x - 0.01, 0.0, slit - half}, {x, 0.05, slit + half})), plate);
    scene.add("lintel", withoutUvs(box({x - 0.01, 0.18, slit - half}, {x, 0.6, slit + half})), plate);
    scene.addLight({{"name", "sun"}, {"type", "directional"}, {"intensity", 60.0}}, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0});
    scene.add("fill", withoutUvs(ceilingQuad({0.0, 1.1, 0.3}, 0.4, 0.4)), fill);
    scene.addCamera("camera", {{0.12, 0.42, 0.75}, {0.17, 0.10, -0.3}, 40.0, 4.0 / 3.0});
    return scene;
}

namespace {

constexpr double kLensAperture = 0.04, kLensRadius = 0.062, kLensEdge = 0.002;

/// Plano-convex, flat side down; paraxial focal length kLensRadius / (1.5 - 1) = 0.124 m.
Shape planoConvexLens() {
    const double sphereCentre = kLensEdge - std::sqrt(kLensRadius * kLensRadius - kLensAperture * kLensAperture);
    const double edgeDegrees = glm::degrees(std::acos(kLensAperture / kLensRadius));
    Profile cap = arc({0.0, sphereCentre}, kLensRadius, edgeDegrees, 90.0, 26);
    cap.front().position = {kLensAperture, kLensEdge};
    return lathe(line({0.0, 0.0}, {kLensAperture, 0.0}) + line({kLensAperture, 0.0}, {kLensAperture, kLensEdge}) + cap,
                 80);
}

}  // namespace

/// A lens on three posts and a glass ball under one point light.
GlbWriter lensPoint() {
    GlbWriter scene("lens-point");
    const auto table = scene.addMaterial(lambert("table", {0.62, 0.60, 0.56}));
    const auto wall = scene.addMaterial(lambert("wall", {0.30, 0.38, 0.34}));
    const auto post = scene.addMaterial(lambert("post", {0.55, 0.20, 0.10}));
    const auto glass = scene.addMaterial(dielectric("glass", 1.5));

    constexpr double kLensHeight = 0.085;
    scene.add("table", withoutUvs(floorQuad({0.0, 0.0, 0.0}, 0.8, 0.6)), table);
    scene.add("wall", withoutUvs(quad({-0.4, 0.0, -0.25}, {0.8, 0.0, 0.0}, {0.0, 0.5, 0.0})), wall);
    scene.add("lens", planoConvexLens(), glass, {{-0.06, kLensHeight, 0.0}});
    const std::size_t postMesh = scene.addMesh("post", cylinder(0.003, 0.0, kLensHeight - 0.0005, 24), post);
    for (const double degrees : {30.0, 150.0, 270.0}) {
        const glm::dvec3 around(std::cos(glm::radians(degrees)), 0.0, std::sin(glm::radians(degrees)));
        scene.place("post", postMesh, {glm::dvec3(-0.06, 0.0, 0.0) + 0.036 * around});
    }
    scene.add("glass-ball", sphere(0.035, 64, 32), glass, {{0.09, 0.0355, 0.06}});
    scene.addLight({{"name", "bulb"}, {"type", "point"}, {"color", {1.0, 0.95, 0.85}}, {"intensity", 0.55}},
                   {-0.03, 0.62, -0.02});
    scene.addCamera("camera", {{0.06, 0.30, 0.58}, {0.0, 0.055, 0.0}, 32.0, 4.0 / 3.0});
    return scene;
}

}  // namespace scenes

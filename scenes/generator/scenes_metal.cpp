#include <cmath>

#include "materials.h"
#include "scenes.h"

namespace scenes {

/// A polished gold ring, 10 cm across, on a table. A lamp 25 degrees above the table draws the ring's caustic, with its
/// cusp halfway between centre and wall.
GlbWriter ring() {
    GlbWriter scene("ring");
    const auto table = scene.addMaterial(lambert("table", {0.58, 0.52, 0.46}));
    const auto gold = scene.addMaterial(metal("gold", {1.0, 0.77, 0.34}, 0.0));
    const auto light = scene.addMaterial(lamp("lamp", {3000.0, 2850.0, 2500.0}));

    scene.add("table", withoutUvs(floorQuad({0.0, 0.0, 0.0}, 0.8, 0.8)), table);
    scene.add("ring", lathe(roundedRectangle({0.050, 0.0}, {0.054, 0.030}, 0.0015, 5), 144), gold,
              {{0.0, 0.0002, 0.0}});
    const double height = glm::radians(25.0);
    const glm::dvec3 lampAt = 0.4 * glm::dvec3(-0.8 * std::cos(height), std::sin(height), 0.6 * std::cos(height));
    scene.add("lamp", withoutUvs(facingQuad(lampAt, {0.0, 0.0, 0.0}, 0.012)), light);
    scene.addCamera("camera", {{0.02, 0.20, 0.19}, {0.01, 0.0, 0.002}, 34.0, 4.0 / 3.0});
    return scene;
}

/// Glossy casters, roughness 0.12 to 0.5: caustics between a delta and a diffuse reflection.
GlbWriter roughMetal() {
    GlbWriter scene("rough-metal");
    const auto table = scene.addMaterial(lambert("table", {0.64, 0.62, 0.60}));
    const auto wall = scene.addMaterial(lambert("wall", {0.32, 0.36, 0.46}));
    const auto brass = scene.addMaterial(metal("brass", {0.91, 0.78, 0.42}, 0.12));
    const auto copper = scene.addMaterial(metal("copper", {0.95, 0.64, 0.54}, 0.3));
    const auto iron = scene.addMaterial(metal("iron", {0.56, 0.57, 0.58}, 0.5));
    const auto frosted = scene.addMaterial(dielectric("frosted-glass", 1.5, 0.2));
    const auto light = scene.addMaterial(lamp("lamp", {260.0, 245.0, 215.0}));

    scene.add("table", withoutUvs(floorQuad({0.0, 0.0, 0.0}, 1.6, 1.2)), table);
    scene.add("wall", withoutUvs(quad({-0.8, 0.0, -0.55}, {1.6, 0.0, 0.0}, {0.0, 0.9, 0.0})), wall);
    scene.add("brass-ring", lathe(roundedRectangle({0.115, 0.0}, {0.125, 0.08}, 0.004, 4), 80), brass,
              {{-0.22, 0.0005, 0.12}});
    scene.add("copper-ball", sphere(0.10, 56, 28), copper, {{-0.16, 0.1005, -0.25}});
    scene.add("iron-torus", torus(0.10, 0.035, 64, 24), iron, {{0.20, 0.0355, -0.22}});
    scene.add("frosted-ball", sphere(0.085, 56, 28), frosted, {{0.17, 0.0855, 0.15}});
    const glm::dvec3 lampAt(-0.55, 0.65, 0.35);
    scene.add("lamp", withoutUvs(facingQuad(lampAt, {0.0, 0.0, 0.0}, 0.07)), light);
    scene.addCamera("camera", {{0.1, 0.62, 0.98}, {0.0, 0.04, -0.04}, 34.0, 4.0 / 3.0});
    return scene;
}

}  // namespace scenes

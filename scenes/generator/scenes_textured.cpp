#include <glm/gtc/quaternion.hpp>

#include "materials.h"
#include "patterns.h"
#include "scenes.h"

namespace scenes {

/// Diffuse bodies before two low walls in the open, to be lit by --env; a small lamp gives light without one.
GlbWriter cornerOpen() {
    GlbWriter scene("corner-open");
    const auto ground = scene.addMaterial(lambert("ground", {0.45, 0.43, 0.38}));
    const auto wall = scene.addMaterial(lambert("wall", {0.74, 0.72, 0.68}));
    const auto red = scene.addMaterial(lambert("red", {0.62, 0.14, 0.10}));
    const auto sand = scene.addMaterial(lambert("sand", {0.72, 0.58, 0.36}));
    const auto light = scene.addMaterial(lamp("lamp", {95.0, 86.0, 70.0}));

    scene.add("ground", lathe(line({3.0, 0.0}, {0.0, 0.0}), 64), ground);
    scene.add("back", withoutUvs(box({-1.0, 0.0, -0.9}, {1.0, 0.8, -0.8})), wall);
    scene.add("side", withoutUvs(box({-1.0, 0.0, -0.801}, {-0.9, 0.8, 0.5})), wall);
    scene.add("plinth", withoutUvs(turned(box({-0.28, 0.0, -0.28}, {0.28, 0.3, 0.28}), {0, 1, 0}, 22.0)), sand,
              {{-0.2, 0.0, -0.2}});
    scene.add("torus", turned(torus(0.16, 0.06, 64, 28), {1, 0, 0.25}, 62.0), red, {{-0.2, 0.505, -0.2}});
    scene.add("ball", sphere(0.2, 56, 28), wall, {{0.45, 0.201, 0.1}});
    scene.add(
        "pin",
        lathe(line({0.0, 0.0}, {0.1, 0.0}) + line({0.1, 0.0}, {0.02, 0.42}) + arc({0.0, 0.45}, 0.036, -56.0, 90.0, 12),
              40),
        sand, {{0.1, 0.0, 0.35}});
    scene.add("lamp", withoutUvs(facingQuad({0.9, 1.5, 0.9}, {0.0, 0.2, 0.0}, 0.25)), light);
    scene.addCamera("camera", {{1.15, 1.0, 1.9}, {-0.05, 0.27, -0.1}, 38.0, 4.0 / 3.0});
    return scene;
}

namespace {

Json textureInfo(std::size_t texture, const Json& transform = {}) {
    Json info = {{"index", texture}};
    if (!transform.is_null()) {
        info["extensions"]["KHR_texture_transform"] = transform;
    }
    return info;
}

Json withBaseColorTexture(Json material, const Json& info) {
    material["pbrMetallicRoughness"]["baseColorTexture"] = info;
    return material;
}

/// Three quads about a common axis, from both sides, 2 mm above the pot's earth.
Shape plant() {
    std::vector<Shape> leaves;
    for (int i = 0; i < 6; ++i) {
        const Shape leaf =
            turned(quad({-0.09, 0.0, 0.02}, {0.18, 0, 0}, {0, 0.42, 0}), {1, 0, 0}, 14.0 + 9.0 * (i % 3));
        leaves.push_back(turned(leaf, {0, 1, 0}, 60.0 * i));
    }
    return merged(leaves);
}

}  // namespace

/// Every texture slot the renderer reads: base colour with a transform, normal map, alpha mask, roughness.
GlbWriter textured() {
    GlbWriter scene("textured");
    const auto checks =
        scene.addTexture("checker", encodePng(checker(16, 2, {225, 215, 195}, {95, 60, 45})), Filter::Nearest);
    const auto leafPicture = scene.addTexture("leaf", encodePng(leaf(64)), Filter::Linear);
    const auto bumps = scene.addTexture("studs", encodePng(studs(64, 2)), Filter::Linear);
    const auto bands = scene.addTexture("roughness-bands", encodePng(roughnessBands(32, 4)), Filter::Nearest);

    const Json turnedChecks = {{"scale", {5.0, 5.0}}, {"rotation", 0.35}, {"offset", {0.1, 0.2}}};
    Json floorMaterial = withBaseColorTexture(lambert("floor", {1.0, 1.0, 1.0}), textureInfo(checks, turnedChecks));
    floorMaterial["normalTexture"] = textureInfo(bumps, {{"scale", {10.0, 10.0}}});
    Json leafMaterial = withBaseColorTexture(lambert("leaf", {1.0, 1.0, 1.0}), textureInfo(leafPicture));
    leafMaterial.update({{"alphaMode", "MASK"}, {"alphaCutoff", 0.5}, {"doubleSided", true}});
    Json bandMaterial = metal("banded-metal", {0.93, 0.88, 0.80}, 1.0);
    bandMaterial["pbrMetallicRoughness"]["metallicRoughnessTexture"] = textureInfo(bands);
    Json studded = lambert("studded-wall", {0.40, 0.52, 0.58});
    studded["normalTexture"] = textureInfo(bumps, {{"scale", {8.0, 4.0}}});

    const auto crate = scene.addMaterial(
        withBaseColorTexture(lambert("crate", {1.0, 0.85, 0.6}), textureInfo(checks, {{"scale", {2.0, 2.0}}})));
    const auto clay = scene.addMaterial(lambert("clay", {0.62, 0.32, 0.20}));
    const auto light = scene.addMaterial(lamp("lamp", {130.0, 120.0, 100.0}));

    const auto withNormal = [](Shape shape, const glm::dvec3& normal) {
        shape.normals.assign(shape.positions.size(), normal);
        return shape;
    };
    scene.add("floor", withNormal(floorQuad({0, 0, 0}, 2.4, 2.4), {0, 1, 0}), scene.addMaterial(floorMaterial));
    scene.add("wall", withNormal(quad({-1.2, 0.0, -0.8}, {2.4, 0, 0}, {0, 1.2, 0}), {0, 0, 1}),
              scene.addMaterial(studded));
    scene.add("crate", turned(box({-0.2, 0.001, -0.2}, {0.2, 0.401, 0.2}), {0, 1, 0}, 28.0), crate, {{0.5, 0.0, -0.2}});
    scene.add("banded-plate", quad({-0.25, 0.0, 0.0}, {0.5, 0, 0}, {0, 0.5, 0}), scene.addMaterial(bandMaterial),
              {{-0.02, 0.05, -0.5}, glm::angleAxis(glm::radians(-18.0), glm::dvec3(1, 0, 0))});
    scene.add(
        "pot",
        lathe(line({0.0, 0.0}, {0.08, 0.0}) + line({0.08, 0.0}, {0.12, 0.18}) + line({0.12, 0.18}, {0.0, 0.18}), 40),
        clay, {{-0.5, 0.0, 0.05}});
    scene.add("plant", plant(), scene.addMaterial(leafMaterial), {{-0.5, 0.182, 0.05}});
    scene.add("lamp", withoutUvs(facingQuad({0.7, 1.5, 0.9}, {0.0, 0.1, -0.1}, 0.22)), light);
    scene.addCamera("camera", {{-0.15, 0.85, 1.75}, {-0.02, 0.28, -0.1}, 38.0, 4.0 / 3.0});
    return scene;
}

}  // namespace scenes

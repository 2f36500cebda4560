/// Small scenes that between them hold everything that transport has to get right, each resolvable by path tracing in a
/// second: for tests that hold one estimator against another.
#pragma once

#include <string>
#include <vector>

#include "../../src/study/check_scenes.h"

namespace pellucid::testing {

struct SmallScene {
    std::string name;
    SceneDescription scene;
    std::optional<EnvironmentDescription> environment = {};
    Settings settings = {};
};

namespace detail {

inline Material coloured(const Rgb& reflectance) {
    Material m = check::lambert(1.0F);
    m.baseColor = glm::vec4(reflectance, 1.0F);
    return m;
}

/// Plastic: a coat of this roughness over a diffuse base.
inline Material coated(float reflectance, float roughness) {
    Material m = check::lambert(reflectance);
    m.specular = 1.0F;
    m.roughness = roughness;
    return m;
}

inline Material tinted(Material m, const Rgb& absorption) {
    m.absorption = absorption;
    return m;
}

/// Floor and back wall of 2 x 2 m, seen from the front.
inline void addCorner(check::SceneBuilder& b, const Material& floor, const Material& wall) {
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, floor);
    b.quad({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, wall);
    b.perspective({0.3, 1.0, 3.4}, {0, 0.6, 0}, 0.62);
}

inline void addSpot(check::SceneBuilder& b, const glm::dvec3& from, const glm::dvec3& to, float intensity) {
    b.description().lights.push_back(
        {"spot", PunctualKind::Spot, from, glm::normalize(to - from), Rgb(intensity), 0.25, 0.45});
}

inline TextureRef bumps() {
    auto image = std::make_shared<TextureImage>();
    image->width = image->height = 8;
    for (int i = 0; i < 64; ++i)
        image->texels8.emplace_back(128 + 80 * ((i * 7) % 3 - 1), 128 + 60 * ((i * 5) % 3 - 1), 220, 255);
    TextureRef t;
    t.image = image;
    return t;
}

}  // namespace detail

/// Rough glass that absorbs, a rough metal box and coloured walls under a lamp.
inline SmallScene roughGlass() {
    using namespace detail;
    check::SceneBuilder b;
    addCorner(b, coloured({0.7F, 0.6F, 0.5F}), coloured({0.3F, 0.6F, 0.7F}));
    b.sphere({-0.4, 0.45, 0.1}, 0.45, 12, tinted(check::glass(1.5F, 0.0F, 0.5F), {0.3F, 0.8F, 1.5F}), true);
    b.box({0.3, 0.0, -0.4}, {0.7, 0.8, 0.1}, check::mirror(0.8F, 0.45F));
    b.square({0.2, 1.9, 0.3}, {0, -1, 0}, 0.35, check::lamp(9.0F));
    return {"rough glass", b.description()};
}

/// Point, spot and directional light on plastic and on rough metal: nothing that a path cannot connect.
inline SmallScene deltaLights() {
    using namespace detail;
    check::SceneBuilder b;
    addCorner(b, coated(0.6F, 0.4F), coloured({0.7F, 0.4F, 0.3F}));
    b.sphere({-0.3, 0.4, 0.2}, 0.4, 10, check::mirror(0.9F, 0.5F), true);
    b.point({0.6, 0.9, 0.5}, 0.8);
    b.sun({0.4, -1.0, -0.5}, 0.7);
    addSpot(b, {-0.8, 1.6, 0.6}, {-0.2, 0.3, 0.0}, 3.0F);
    return {"delta lights", b.description()};
}

/// A sky with a gradient over an open corner with a coarse, smooth-shaded plastic sphere.
inline SmallScene sky() {
    using namespace detail;
    check::SceneBuilder b;
    addCorner(b, coated(0.5F, 0.6F), coloured({0.6F, 0.6F, 0.2F}));
    b.sphere({0.2, 0.5, 0.3}, 0.5, 4, coated(0.4F, 0.35F), true);
    SmallScene s{"sky", b.description()};
    s.environment = check::environmentMap(
        32, 16, [](const glm::dvec3& d) { return 0.4 + 0.5 * d.y + 1.2 * std::max(0.0, d.x * d.z); });
    return s;
}

/// Blended and thin rough panes, and a body of rough glass inside of another.
inline SmallScene layersOfGlass() {
    using namespace detail;
    check::SceneBuilder b;
    addCorner(b, coloured({0.6F, 0.6F, 0.6F}), coloured({0.5F, 0.3F, 0.6F}));
    Material veil = coloured({0.2F, 0.7F, 0.3F});
    veil.alphaMode = AlphaMode::Blend;
    veil.baseColor.a = 0.5F;
    b.quad({-0.9, 0.1, 0.3}, {0.7, 0, 0}, {0, 0.9, 0}, veil);
    Material pane = check::glass(1.5F, 0.0F, 0.5F);
    pane.thickness = 0.0F;
    b.quad({-0.2, 1.2, 0.6}, {0.9, 0, 0}, {0, 0, -0.9}, pane);
    b.box({0.0, 0.05, -0.3}, {0.8, 0.85, 0.5}, tinted(check::glass(1.2F, 0.0F, 0.55F), {0.6F, 0.2F, 0.1F}));
    b.box({0.25, 0.25, -0.1}, {0.55, 0.6, 0.25}, tinted(check::glass(1.4F, 0.0F, 0.6F), {0.1F, 0.9F, 2.0F}));
    b.square({0.0, 1.9, 0.2}, {0, -1, 0}, 0.5, check::lamp(5.0F));
    return {"layers of glass", b.description()};
}

/// A lamp large enough that path tracing meets it through smooth glass and in a mirror; a two-sided lamp stands in view.
inline SmallScene smoothCasters() {
    using namespace detail;
    check::SceneBuilder b;
    addCorner(b, coloured({0.7F, 0.7F, 0.7F}), coated(0.6F, 0.0F));
    b.sphere({-0.4, 0.45, 0.1}, 0.4, 12, tinted(check::glass(1.5F), {0.2F, 0.4F, 0.8F}), true);
    b.quad({0.75, 0.0, 0.8}, {0, 0, -1.4}, {0, 1.2, 0}, check::mirror(0.9F));
    b.square({0.0, 2.2, 0.2}, {0, -1, 0}, 1.4, check::lamp(1.0F));
    b.square({0.1, 0.3, 0.6}, {1, 0, 1}, 0.12, check::lamp(2.0F, true));
    return {"smooth casters", b.description()};
}

/// A thin lens, out of focus nearly everywhere.
inline SmallScene thinLens() {
    SmallScene s = roughGlass();
    s.name = "thin lens";
    s.settings.aperture = 0.25;
    s.settings.focus = 2.2;
    return s;
}

/// Normal-mapped plastic, metal and glass.
inline SmallScene normalMaps() {
    using namespace detail;
    check::SceneBuilder b;
    Material floor = coated(0.6F, 0.5F), wall = check::mirror(0.7F, 0.5F);
    floor.normalTexture = wall.normalTexture = bumps();
    addCorner(b, floor, wall);
    for (Mesh& m : b.description().meshes) m.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    b.sphere({0.2, 0.5, 0.2}, 0.3, 6, coloured({0.5F, 0.3F, 0.2F}), true);
    b.square({0.3, 1.9, 0.6}, {0, -1, -0.3}, 0.5, check::lamp(4.0F));
    return {"normal maps", b.description()};
}

/// Two bodies of glass that spread white light far into its colours, one seen through the other, and a coloured one between.
inline SmallScene dispersion() {
    using namespace detail;
    check::SceneBuilder b;
    addCorner(b, coloured({0.7F, 0.7F, 0.7F}), coloured({0.6F, 0.7F, 0.5F}));
    Material flint = check::glass(1.6F), crown = tinted(check::glass(1.45F), {0.3F, 0.1F, 0.6F});
    flint.dispersion = 4.0F;
    crown.dispersion = 2.0F;
    b.sphere({-0.4, 0.45, 0.1}, 0.4, 12, flint, true);
    b.box({0.2, 0.1, 0.2}, {0.8, 0.7, 0.6}, crown);
    b.square({0.0, 1.6, 0.2}, {0, -1, 0}, 2.4, check::lamp(1.0F));
    return {"dispersion", b.description()};
}

/// A floor that lets more than half of the light pass to another one under it, below smooth glass and before a mirror.
inline SmallScene veils() {
    using namespace detail;
    check::SceneBuilder b;
    Material veil = coloured({0.7F, 0.6F, 0.5F});
    veil.alphaMode = AlphaMode::Blend;
    veil.baseColor.a = 0.4F;
    addCorner(b, veil, coloured({0.5F, 0.5F, 0.7F}));
    b.quad({-1, -0.3, 1}, {2, 0, 0}, {0, 0, -2}, coloured({0.3F, 0.7F, 0.3F}));
    b.sphere({-0.3, 0.5, 0.1}, 0.4, 12, check::glass(1.5F), true);
    b.quad({0.75, 0.0, 0.8}, {0, 0, -1.4}, {0, 1.2, 0}, check::mirror(0.9F));
    b.square({0.0, 2.2, 0.2}, {0, -1, 0}, 1.4, check::lamp(1.0F));
    return {"veils", b.description()};
}

/// A closed room whose lamp shines at the ceiling: all light but there is indirect.
inline SceneDescription roomLitByItsCeiling() {
    check::SceneBuilder b;
    b.box({-1, 0, -1}, {1, 2, 1}, check::lambert(0.7F));
    b.square({0, 1.0, 0}, {0, 1, 0}, 0.3, check::lamp(10.0F));
    b.perspective({0, 0.6, 0.9}, {0, 0.5, -1}, 0.9);
    return b.description();
}

inline std::vector<SmallScene> smallScenes() {
    return {roughGlass(), deltaLights(), sky(),        layersOfGlass(), smoothCasters(),
            thinLens(),   normalMaps(),  dispersion(), veils()};
}

}  // namespace pellucid::testing

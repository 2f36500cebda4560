/// Scenes that nobody thought of: shapes, materials, textures, lights and views drawn at random, so that estimators are held
/// against each other where no one looked. The same number gives the same scene, with the same
/// compiler: arguments are drawn in its order.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <random>
#include <string>

#include <glm/gtc/matrix_transform.hpp>

#include <pellucid/render/settings.h>

#include "small_scenes.h"

namespace pellucid::testing {

/// Draws a scene. What it took is told in SmallScene::name.
class SceneLottery {
public:
    explicit SceneLottery(std::uint64_t number) : numbers_(number) {}

    [[nodiscard]] SmallScene draw() {
        const bool room = chance(0.55);
        if (room && chance(0.3))
            addRoomWithWindow();
        else if (room)
            builder_.box({-1, 0, -1}, {1, 2, 1}, chance(0.1) ? cover(false) : dull(), true);
        else
            builder_.quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, chance(0.3) ? cover(false) : dull());
        told_ = room ? "room:" : "open:";
        const int bodies = 2 + static_cast<int>(3.0 * u());
        for (int i = 0; i < bodies; ++i) addBody(2.0 * std::numbers::pi * (i + 0.4 * u()) / bodies);
        if (chance(0.25)) addPane();
        if (chance(0.1)) addPool();
        const bool lit = room || chance(0.6);
        if (lit) addLamps(room);
        SmallScene s;
        if ((!room || window_) && (!lit || chance(0.6))) addSky(s);
        addCamera();
        spreadTextures();
        s.scene = builder_.description();
        // Nobody's unit is the metre.
        if (chance(0.3)) {
            const double scale = std::pow(10.0, between(-4.0, 4.0));
            s.scene = check::transformed(s.scene, scale, glm::dvec3(between(-50, 50), between(-50, 50), 0.0) * scale);
            tell("scaled");
        }
        s.name = told_;
        return s;
    }

    /// A furnace: whatever is in it, the radiance outside of glass is 1 everywhere. Surfaces emit what they do not reflect.
    [[nodiscard]] SmallScene drawFurnace() {
        const bool room = chance(0.5);
        if (room)
            builder_.box({-1, 0, -1}, {1, 2, 1}, ember(), true);
        else
            builder_.quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, ember());
        told_ = room ? "furnace room:" : "furnace under a sky:";
        const int bodies = 3 + static_cast<int>(3.0 * u());
        for (int i = 0; i < bodies; ++i) addFurnaceBody(2.0 * std::numbers::pi * (i + 0.3 * u()) / bodies);
        addCamera();
        SmallScene s{told_, builder_.description()};
        if (!room) {
            s.environment = EnvironmentDescription{};
            s.environment->constant = Rgb(1.0F);
        }
        return s;
    }

private:
    [[nodiscard]] double u() { return std::ldexp(static_cast<double>(numbers_() >> 11U), -53); }
    [[nodiscard]] double between(double a, double b) { return a + (b - a) * u(); }
    [[nodiscard]] bool chance(double p) { return u() < p; }
    [[nodiscard]] float pick(std::initializer_list<float> values) {
        const auto n = static_cast<double>(values.size());
        return *(values.begin() + static_cast<std::ptrdiff_t>(std::min(n - 1.0, n * u())));
    }
    void tell(const std::string& what) { told_ += " " + what; }

    [[nodiscard]] TextureRef texture(bool srgb, glm::u8vec4 low, glm::u8vec4 high) {
        auto image = std::make_shared<TextureImage>();
        image->width = image->height = 4;
        for (int i = 0; i < 16; ++i) {
            const glm::vec4 at(u(), u(), u(), u());
            image->texels8.emplace_back(glm::mix(glm::vec4(low), glm::vec4(high), at));
        }
        TextureRef t;
        t.image = image;
        t.srgb = srgb;
        t.linear = chance(0.5);
        t.scale = glm::vec2(pick({1.0F, 2.0F, 3.0F}));
        return t;
    }

    [[nodiscard]] Material dull() {
        Material m = detail::coloured(Rgb(between(0.2, 0.8), between(0.2, 0.8), between(0.2, 0.8)));
        if (chance(0.2)) m.baseColorTexture = texture(true, {60, 60, 60, 255}, {255, 255, 255, 255});
        return m;
    }

    /// What may be put on any surface, open ones too.
    [[nodiscard]] Material cover(bool closed) {
        Material m = dull();
        const double kind = u();
        if (kind < 0.2) {
            tell("dull");
        } else if (kind < 0.4) {
            m.metallic = m.specular = 1.0F;
            m.roughness = pick({0.0F, 0.05F, 0.1F, 0.2F, 0.4F, 0.8F});
            tell("metal");
        } else if (kind < 0.52) {
            m.specular = 1.0F;
            m.metallic = pick({0.0F, 0.0F, 0.5F});
            m.roughness = pick({0.0F, 0.1F, 0.3F, 0.7F});
            m.ior = pick({1.3F, 1.5F, 1.8F});
            tell("plastic");
        } else if (kind < 0.82 && closed) {
            m = someGlass();
        } else if (kind < 0.9) {
            m.specular = 1.0F;
            m.transmission = pick({0.5F, 1.0F});
            m.roughness = pick({0.0F, 0.0F, 0.2F});
            tell("thin");
        } else if (kind < 0.95) {
            m.alphaMode = AlphaMode::Blend;
            m.baseColor.a = 0.5F;
            tell("veil");
        } else {
            m.alphaMode = AlphaMode::Mask;
            m.baseColorTexture = texture(true, {60, 60, 60, 0}, {255, 255, 255, 255});
            tell("cut out");
        }
        if (kind > 0.2 && chance(0.15)) {
            m.normalTexture = detail::bumps();
            m.normalScale = pick({0.3F, 1.0F});
            tell("(bumps)");
        }
        if (m.roughness > 0.0F && kind > 0.2 && chance(0.2)) {
            m.metallicRoughnessTexture = texture(false, {255, 40, 128, 255}, {255, 255, 255, 255});
            tell("(roughness)");
        }
        return m;
    }

    [[nodiscard]] Material someGlass() {
        Material m = check::glass(pick({1.1F, 1.33F, 1.5F, 2.0F, 0.75F}), pick({0.0F, 0.0F, 2.0F}),
                                  pick({0.0F, 0.0F, 0.0F, 0.05F, 0.2F, 0.5F}));
        tell("glass");
        if (chance(0.3)) m.dispersion = static_cast<float>(between(0.0, 1.5));
        if (chance(0.3)) m.baseColor = glm::vec4(between(0.5, 1.0), between(0.5, 1.0), between(0.5, 1.0), 1.0);
        if (chance(0.15)) m.transmission = 0.6F;
        if (chance(0.1)) m.transmissionTexture = texture(false, {0, 0, 0, 255}, {255, 255, 255, 255});
        if (chance(0.1)) m.specularColor = Rgb(0.3F, 0.9F, 0.6F);
        return m;
    }

    void addRoomWithWindow() {
        builder_.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, dull());
        builder_.quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, dull());
        builder_.quad({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, chance(0.2) ? cover(false) : dull());
        builder_.quad({1, 0, -1}, {0, 0, 2}, {0, 2, 0}, dull());
        builder_.quad({1, 0, 1}, {-2, 0, 0}, {0, 2, 0}, dull());
        builder_.quad({-1, 0, 1}, {0, 0, -2}, {0, 0.8, 0}, dull());
        tell("window");
        window_ = true;
    }

    /// Water on the floor, in its plane or under it, its sides in the walls or short of them.
    void addPool() {
        const double half = chance(0.5) ? 1.0 : 0.8;
        const glm::dvec3 low{-half, chance(0.5) ? 0.0 : -0.01, -half}, high{half, between(0.1, 0.6), half};
        builder_.box(low, high, check::glass(1.33F, pick({0.0F, 0.5F})));
        tell("pool");
    }

    void addBody(double angle) {
        glm::dvec3 p(0.5 * std::cos(angle), between(0.25, 1.0), 0.5 * std::sin(angle));
        const double r = between(0.1, 0.22);
        const double stands = u();
        if (stands < 0.2) p.y = r;        // on the ground
        if (stands > 0.9) p.y = 0.5 * r;  // half in the ground
        const std::size_t before = builder_.description().geometries.size();
        Material m = cover(true);
        if (chance(0.08)) {
            m.emission = Rgb(pick({0.1F, 3.0F, 30.0F}));
            m.doubleSided = chance(0.3);
            tell("(glows)");
        }
        const double shape = u();
        if (shape < 0.45) {
            builder_.sphere(p, r, chance(0.5) ? 24 : 8, m, chance(0.7));
            if (m.thickness > 0.0F && chance(0.25)) {
                builder_.sphere(p, 0.6 * r, 16, cover(true), true);
                tell("inside");
            }
        } else if (shape < 0.7) {
            const glm::dvec3 half(0.9 * r, r, 0.7 * r);
            builder_.box(p - half, p + half, m);
            if (m.thickness > 0.0F && chance(0.4)) {
                builder_.box(p + glm::dvec3(-0.6 * half.x, half.y, -half.z), p + half * glm::dvec3(0.8, 1.7, 0.5),
                             chance(0.3) ? m : cover(true));
                tell("with another on it");
            }
        } else if (shape < 0.85) {
            Mesh prism = check::rightAngledPrism(0.5F);
            for (glm::vec3& x : prism.positions) x = x * static_cast<float>(r) + glm::vec3(p);
            builder_.mesh(prism, m);
        } else {
            // A lens: a ball made flat, and often turned over.
            builder_.sphere({0, 0, 0}, r, 16, m, true);
            glm::dmat4 place = glm::translate(glm::dmat4(1.0), p);
            place = glm::rotate(place, between(0.0, 6.28), glm::normalize(glm::dvec3(u(), u(), 0.1)));
            place = glm::scale(place, glm::dvec3(chance(0.5) ? -1.0 : 1.0, 1.0, between(0.2, 1.0)));
            for (std::size_t g = before; g < builder_.description().geometries.size(); ++g)
                builder_.description().geometries[g].toWorld = place;
            tell("lens");
        }
    }

    [[nodiscard]] Material ember() {
        Material m = dull();
        m.baseColorTexture = {};
        m.emission = Rgb(1.0F) - Rgb(m.baseColor);
        m.doubleSided = true;
        return m;
    }

    void addFurnaceBody(double angle) {
        const glm::dvec3 p{0.42 * std::cos(angle), between(0.35, 1.0), 0.42 * std::sin(angle)};
        const double r = between(0.1, 0.17), kind = u();
        Material m = ember();
        if (kind < 0.3) {
            tell("ember");
            if (chance(0.3)) {
                m.alphaMode = AlphaMode::Blend;
                m.baseColor.a = 0.4F;
                tell("(veil)");
            }
        } else if (kind < 0.45) {
            m = check::mirror(1.0F);
            tell("mirror");
        } else if (kind < 0.85) {
            m = check::glass(pick({1.1F, 1.33F, 1.5F, 2.0F, 0.75F}));
            if (chance(0.3)) m.dispersion = 1.0F;
            tell("glass");
        } else {
            m = check::glass(1.5F);
            m.thickness = 0.0F;
            tell("thin");
        }
        const double shape = u();
        if (shape < 0.4) {
            builder_.sphere(p, r, 12, m, false);
            if (m.thickness > 0.0F && chance(0.3)) {
                builder_.sphere(p, 0.6 * r, 8, chance(0.5) ? check::mirror(1.0F) : check::glass(1.2F), false);
                tell("inside");
            }
        } else if (shape < 0.7) {
            builder_.box(p - glm::dvec3(r, 0.8 * r, r), p + glm::dvec3(0.9 * r, r, r), m);
        } else if (shape < 0.85 || m.thickness > 0.0F) {
            Mesh prism = check::rightAngledPrism(0.5F);
            for (glm::vec3& x : prism.positions) x = x * static_cast<float>(r) + glm::vec3(p);
            builder_.mesh(prism, m);
        } else {
            const glm::dvec3 n = glm::normalize(glm::dvec3{u() - 0.5, u() - 0.5, u() - 0.5});
            builder_.square(p, n, r, m);
            tell("sheet");
        }
    }

    void addPane() {
        const glm::dvec3 corner(between(-0.6, 0.0), between(0.9, 1.4), between(-0.4, 0.2));
        tell("pane of");
        builder_.quad(corner, {between(0.3, 0.6), between(-0.2, 0.2), 0}, {0, between(-0.2, 0.2), -0.5}, cover(false));
    }

    void addLamps(bool room) {
        const double kind = u();
        const auto somewhere = [&] { return glm::dvec3(between(-0.5, 0.5), between(1.5, 1.8), between(-0.5, 0.5)); };
        if (kind < 0.3) {
            const double half = static_cast<double>(pick({0.03F, 0.1F, 0.3F}));
            Material m = check::lamp(static_cast<float>(1.0 / (half * half)), chance(0.3));
            if (chance(0.3)) m.baseColor = glm::vec4(0.5F, 0.5F, 0.5F, 1.0F);
            if (chance(0.2)) m.emissiveTexture = texture(true, {0, 0, 0, 255}, {255, 255, 255, 255});
            glm::dvec3 at = somewhere();
            const bool inCeiling = chance(0.3) && room;
            at.y = inCeiling ? 2.0 : 1.9;
            const double tilt = between(-0.1, 0.1);
            builder_.square(at, glm::normalize(glm::dvec3(inCeiling ? 0.0 : tilt, -1, 0)), half, m);
            tell("+ square lamp");
        } else if (kind < 0.5) {
            builder_.sphere(somewhere(), 0.06, 12, check::lamp(30.0F), true);
            tell("+ ball lamp");
        } else if (kind < 0.65) {
            builder_.point(somewhere(), 1.0);
            tell("+ point");
        } else if (kind < 0.75) {
            const glm::dvec3 from = somewhere();
            detail::addSpot(builder_, from, {0, 0.3, 0}, 5.0F);
            tell("+ spot");
        } else if (kind < 0.85) {
            builder_.square({0, 1.8, 0.2}, {0, -1, 0}, 0.08, check::lamp(60.0F));
            builder_.point(somewhere(), 0.3);
            tell("+ lamp and point");
        } else {
            for (int i = 0; i < 12; ++i)
                builder_.square(somewhere(), glm::normalize(glm::dvec3(u() - 0.5, -0.7, u() - 0.5)), 0.02,
                                check::lamp(static_cast<float>(std::pow(10.0, between(1.0, 3.0)))));
            tell("+ twelve lamps");
        }
    }

    void addSky(SmallScene& s) {
        const double kind = u();
        if (kind < 0.3) {
            s.environment = EnvironmentDescription{};
            s.environment->constant = Rgb(0.5F, 0.7F, 1.0F);
            tell("+ even sky");
        } else if (kind < 0.75) {
            const double sharp = static_cast<double>(pick({20.0F, 300.0F}));
            const glm::dvec3 sun = glm::normalize(glm::dvec3(between(-0.7, 0.7), 0.8, between(-0.3, 0.7)));
            s.environment = check::environmentMap(64, 32, [&](const glm::dvec3& d) {
                return 0.3 + 0.1 * sharp * std::exp(sharp * (glm::dot(d, sun) - 1.0));
            });
            tell("+ sunny sky");
        } else {
            builder_.sun(glm::normalize(glm::dvec3(between(-0.5, 0.5), -1, between(-0.5, 0.5))), 3.0);
            tell("+ sun");
        }
    }

    void addCamera() {
        const double kind = u();
        const glm::dvec3 eye(between(-0.2, 0.2), between(0.6, 1.3), 0.93);
        if (kind < 0.1) {
            builder_.view({0, 0.5, 0}, glm::normalize(glm::dvec3(0, 0.4, 1)), 1.0, 0.85);
            tell("| orthographic");
        } else {
            builder_.perspective(eye, {between(-0.1, 0.1), 0.5, 0}, between(0.8, 1.1));
        }
    }

    /// Seen from the front: sides along the view get no coordinates to speak of, which must do no harm.
    void spreadTextures() {
        for (Mesh& mesh : builder_.description().meshes)
            for (const glm::vec3& p : mesh.positions) mesh.uv0.emplace_back(2.0F * p.x, 2.0F * p.y + p.z);
    }

    std::mt19937_64 numbers_;
    bool window_ = false;
    check::SceneBuilder builder_;
    std::string told_;
};

}  // namespace pellucid::testing

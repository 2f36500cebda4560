// Extremes of materials: albedo, ior, roughness. Most are furnaces: in a constant sky whatever absorbs nothing vanishes.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <pellucid/math/constants.h>
#include <pellucid/study/record_json.h>

#include "check_cases.h"
#include "check_formulas.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

void append(std::vector<Finding>& to, std::vector<Finding> from) { to.insert(to.end(), from.begin(), from.end()); }

[[nodiscard]] EnvironmentDescription constantSky() {
    EnvironmentDescription sky;
    sky.constant = Rgb(1.0F);
    return sky;
}

[[nodiscard]] std::vector<Finding> ballInFurnace(const CheckContext& context, const Material& material,
                                                 const std::string& quantity, double expected, double allowance) {
    SceneBuilder b;
    b.sphere(glm::dvec3(0.0), 1.0, 48, material, true);
    b.view(glm::dvec3(0.0), {0.2, 0.3, 1.0}, 1.7, 2.0);
    return measure(context, {b.description(),
                             constantSky(),
                             expected,
                             1.0,
                             quantity,
                             {{Method::Path, 4, allowance, 0.03}, {Method::Photon, 8, allowance, 0.05}},
                             16,
                             smallSettings()});
}

std::vector<Finding> albedo(const CheckContext& context) {
    std::vector<Finding> all;
    for (const auto& [rho, samples] : {std::pair(0.0F, 8U), std::pair(0.9F, 64U), std::pair(0.99F, 24U)}) {
        SceneBuilder b;
        b.box(glm::dvec3(-1.0), glm::dvec3(1.0), lambert(rho, 1.0F), true);
        b.perspective({0.1, -0.2, 0.3}, {0.9, 0.5, -0.4}, 1.6);
        Settings settings = smallSettings();
        settings.globalPhotons = 5000;
        settings.gatherRays = 64;
        append(all, measure(context, {b.description(),
                                      {},
                                      1.0 / (1.0 - static_cast<double>(rho)),
                                      1.0,
                                      fmt::format("radiance at rho = {}", rho),
                                      {{Method::Path, samples, 0.0, 0.07}, {Method::Photon, 4, 0.015, 0.07}},
                                      8,
                                      settings}));
    }
    return all;
}

/// The tail of the series has 1e-3 of its light beyond 6900 bounces: no depth limit and no growing weights.
std::vector<Finding> albedo999(const CheckContext& context) {
    SceneBuilder b;
    b.box(glm::dvec3(-1.0), glm::dvec3(1.0), lambert(0.999F, 1.0F), true);
    b.perspective({0.1, -0.2, 0.3}, {0.9, 0.5, -0.4}, 1.6);
    const double rho = static_cast<double>(0.999F);
    Settings settings = smallSettings();
    settings.globalPhotons = 600;  // of a thousand bounces each
    settings.gatherRays = 16;
    return measure(context, {b.description(),
                             {},
                             1.0 / (1.0 - rho),
                             1.0,
                             "radiance at rho = 0.999",
                             {{Method::Path, 5, 0.0, 0.1}, {Method::Photon, 1, 0.02, 0.2}},
                             8,
                             settings});
}

/// No steady state exists: the render must end and stay finite all the same.
std::vector<Finding> albedo1(const CheckContext& context) {
    SceneBuilder b;
    b.box(glm::dvec3(-1.0), glm::dvec3(1.0), lambert(1.0F), true);
    b.point(glm::dvec3(0.0), 1.0);
    b.perspective({0.1, -0.2, 0.3}, {0.9, 0.5, -0.4}, 1.6);
    const Scene scene = makeScene(context, b.description());
    Settings settings = smallSettings();
    settings.globalPhotons = 100;
    settings.gatherRays = 9;
    std::vector<Finding> all;
    // (Bidirectional paths end, too, but join thousands of vertices with thousands: minutes.)
    for (const Method method : {Method::Path, Method::Photon, Method::Reference}) {
        const RenderResult r = renderOnce(context, scene, {method, 2}, settings, 4, context.seed);
        const bool told = std::ranges::any_of(r.record.blindSpots,
                                              [](const std::string& text) { return text.starts_with("endless"); });
        all.push_back(exact("says that there is no answer, " + methodName(method), 1.0, told ? 1.0 : 0.0, 0.0));
        const double mean = meanOf(r.image);
        all.push_back(exact("ends finite and lit, " + methodName(method), 1.0,
                            std::isfinite(mean) && mean > 0.0 && r.record.nonfinite.count == 0 ? 1.0 : 0.0, 0.0));
    }
    return all;
}

std::vector<Finding> indices(const CheckContext& context) {
    std::vector<Finding> all;
    for (const float ior : {0.67F, 1.0F, 1.0F + 1e-6F, 1.00001F, 1.5F, 4.0F})
        append(all, ballInFurnace(context, glass(ior), fmt::format("radiance at ior {:.7g}", ior), 1.0, 0.0));
    return all;
}

/// The single-scattering microfacet loses energy with roughness but never makes any; a mirror loses none.
std::vector<Finding> roughMetal(const CheckContext& context) {
    std::vector<Finding> all;
    for (const float roughness : {0.0F, 1e-5F, 1e-3F, 0.03F, 0.1F, 0.3F})
        append(all,
               ballInFurnace(context, mirror(1.0F, roughness), fmt::format("radiance at roughness {:g}", roughness),
                             1.0, roughness <= 0.1F ? 0.002 : 0.03));
    // Single scattering keeps from a third to all of the light.
    for (const float roughness : {0.6F, 1.0F})
        append(all, ballInFurnace(context, mirror(1.0F, roughness),
                                  fmt::format("radiance at roughness {:g}, 1/3 to 1", roughness), 2.0 / 3.0, 0.5));
    return all;
}

std::vector<Finding> roughGlass(const CheckContext& context) {
    std::vector<Finding> all;
    for (const float roughness : {0.0F, 1e-5F, 0.03F, 0.1F})
        append(all, ballInFurnace(context, glass(1.5F, 0.0F, roughness),
                                  fmt::format("radiance at roughness {:g}", roughness), 1.0,
                                  roughness == 0.0F ? 0.0 : 0.03));
    for (const float roughness : {0.4F, 1.0F})
        append(all, ballInFurnace(context, glass(1.5F, 0.0F, roughness),
                                  fmt::format("radiance at roughness {:g}, 1/3 to 1", roughness), 2.0 / 3.0, 0.5));
    return all;
}

/// From within a body of index n all of the sky is n^2 times as bright, whatever is reflected inside.
std::vector<Finding> cameraInGlass(const CheckContext& context) {
    SceneBuilder b;
    b.sphere(glm::dvec3(0.0), 1.0, 64, glass(1.5F), true);
    b.perspective(glm::dvec3(0.0), {0.3, 0.5, 1.0}, 1.0);
    return measure(context, {b.description(),
                             constantSky(),
                             2.25,
                             1.0,
                             "radiance n^2",
                             {{Method::Path, 8, 0.0}, {Method::Photon, 8, 0.0}},
                             16,
                             smallSettings()});
}

/// Facing mirrors of reflectance 1 with nothing between: black, and it ends.
std::vector<Finding> endlessMirrors(const CheckContext& context) {
    SceneBuilder b;
    b.square({0, 0, 0}, {0, 0, 1}, 1.0, mirror(1.0F));
    b.square({0, 0, 1}, {0, 0, -1}, 1.0, mirror(1.0F));
    b.point({0.3, 0.2, 0.5}, 1.0);
    b.view(glm::dvec3(0.0), {0, 0, 1}, 1.0, 0.5);
    return measure(context, {b.description(),
                             {},
                             0.0,
                             1.0,
                             "radiance",
                             {{Method::Path, 1}, {Method::Photon, 4}, {Method::Bdpt, 1}, {Method::Reference, 1}},
                             4,
                             smallSettings()});
}

/// Light at 0.05 degrees over a floor.
std::vector<Finding> grazing(const CheckContext& context) {
    const double angle = 0.05 * kPiD / 180.0, rho = 0.5;
    SceneBuilder b;
    b.square(glm::dvec3(0.0), {0, 0, 1}, 1.0, lambert(static_cast<float>(rho)));
    b.sun({std::cos(angle), 0, -std::sin(angle)}, 1000.0);
    b.view(glm::dvec3(0.0), {0, 0, 1}, 0.5, 0.5);
    return measure(context, {b.description(),
                             {},
                             1000.0 * std::sin(angle),
                             kPiD / rho,
                             "irradiance E0 sin(0.05 deg)",
                             {{Method::Path, 1, 1e-3}, {Method::Photon, 4, 1e-3}},
                             16,
                             smallSettings()});
}

}  // namespace

void addMaterialExtremes(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, const char* source, bool quick, auto run) {
        cases.push_back({name, CheckGroup::Extreme, guards, source, quick, run});
    };
    add("extreme-albedo", "closed rooms: Le / (1 - rho) up to 0.99", "Neumann series", false, albedo);
    add("extreme-albedo-0.999", "a closed room of 1000 bounces", "Neumann series", false, albedo999);
    add("extreme-albedo-1", "a closed room that absorbs nothing ends, and says that it has no answer", "termination",
        false, albedo1);
    add("extreme-ior", "clear glass in a constant sky is invisible at any ior", "white furnace", true, indices);
    add("extreme-rough-metal", "metal in a constant sky loses little, gains nothing", "white furnace, [Heitz2014]",
        false, roughMetal);
    add("extreme-rough-glass", "rough glass in a constant sky loses little, gains nothing",
        "white furnace, [Walter2007]", false, roughGlass);
    add("extreme-camera-in-glass", "radiance is n^2 times as great inside glass", "[Veach1997, sec. 5.2]", true,
        cameraInGlass);
    add("extreme-endless-mirrors", "facing perfect mirrors end", "termination", true, endlessMirrors);
    add("extreme-grazing-light", "E0 cos at grazing incidence", "Lambert's cosine law", true, grazing);
}

}  // namespace pellucid::check

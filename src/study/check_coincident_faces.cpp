// Extremes of geometry: faces in one place. Light must be lost to none of them, whichever a ray happens to hit.
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <pellucid/math/constants.h>

#include "check_cases.h"
#include "check_formulas.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

constexpr double kPatch = 0.4;
const glm::dvec3 kUp(0, 0, 1), kLight(0.4, -0.3, 0.8);

void append(std::vector<Finding>& to, std::vector<Finding> from) { to.insert(to.end(), from.begin(), from.end()); }

[[nodiscard]] double patchIrradiance() {
    return meanOverSquare([](double u, double v) {
        return pointIrradiance({kPatch * (u - 0.5), kPatch * (v - 0.5), 0.0}, kUp, kLight, 2.0);
    });
}

/// Two floors in one plane, of 0.2 and 0.6: which one is seen is left open, but it is one of them.
std::vector<Finding> coplanarFaces(const CheckContext& context) {
    SceneBuilder b;
    b.square(glm::dvec3(0.0), kUp, 1.0, lambert(0.2F));
    b.quad({-1.3, -1.1, 0}, {2.4, 0, 0}, {0, 2.1, 0}, lambert(0.6F));
    b.point(kLight, 2.0);
    b.view(glm::dvec3(0.0), kUp, kPatch, 0.3);
    return measure(context, {b.description(),
                             {},
                             0.4,
                             kPiD / patchIrradiance(),
                             "reflectance seen, 0.2 to 0.6",
                             {{Method::Path, 2, 0.5, 0.3}, {Method::Photon, 4, 0.5, 0.3}},
                             16,
                             smallSettings()});
}

/// A layer of a stack of plates.
struct Layer {
    double ior = 1.0, absorption = 0.0, thickness = 0.125;
};

/// Transmittance of plates that touch, with air around them, all reflections between their faces summed; the mean of both
/// polarisations at each face, as an unpolarised renderer has it.
[[nodiscard]] double stackTransmittance(const std::vector<Layer>& layers, double sine) {
    double above = 1.0, through = 1.0, back = 0.0;  // ior, transmittance so far, reflectance seen from below
    double inLayer = 1.0;                           // transmittance of the layer that was come through
    const auto cross = [&](double ior) {
        const double r = fresnel(std::sqrt(1.0 - sine * sine / (above * above)), ior / above), e = inLayer,
                     sum = 1.0 / (1.0 - back * r * e * e);
        through *= e * (1.0 - r) * sum;
        back = r + (1.0 - r) * (1.0 - r) * back * e * e * sum;
        above = ior;
    };
    for (const Layer& l : layers) {
        cross(l.ior);
        inLayer = std::exp(-l.absorption * l.thickness / std::sqrt(1.0 - sine * sine / (l.ior * l.ior)));
    }
    cross(1.0);
    return through;
}

/// A lamp of radiance 1 seen through plates that touch, each cut into other triangles than the next.
[[nodiscard]] std::vector<Finding> throughStack(const CheckContext& context, const std::string& what,
                                                const std::vector<Layer>& layers, double degrees) {
    const double angle = degrees * kPiD / 180.0;
    SceneBuilder b;
    double low = 0.0, half = 3.0;
    for (auto l = layers.rbegin(); l != layers.rend(); ++l) {
        b.box({-half, -3, low}, {half, 3, low + l->thickness},
              glass(static_cast<float>(l->ior), static_cast<float>(l->absorption)));
        low += l->thickness;
        half += 0.3;
    }
    b.square({0, 0, -0.5}, kUp, 3.0, lamp(1.0F));
    b.view(glm::dvec3(0.0), {std::sin(angle), 0, std::cos(angle)}, 0.5, 2.0);
    return measureByAll(context, {b.description(),
                                  {},
                                  stackTransmittance(layers, std::sin(angle)),
                                  1.0,
                                  fmt::format("transmittance of {} at {:.0f} deg", what, degrees),
                                  {{Method::Path, 24, 0.0}, {Method::Photon, 32, 0.0, 0.03}},
                                  16,
                                  smallSettings()});
}

/// Plates of one glass that touch are one plate.
std::vector<Finding> oneGlass(const CheckContext& context) {
    std::vector<Finding> all;
    for (const double degrees : {0.0, 40.0})
        append(all, throughStack(context, "two plates of one glass", {{1.5}, {1.5}}, degrees));
    return all;
}

/// Water in glass has one face with it, not two with air between.
std::vector<Finding> waterInGlass(const CheckContext& context) {
    std::vector<Finding> all;
    for (const double degrees : {0.0, 60.0})
        append(all, throughStack(context, "water between glass", {{1.5}, {1.33}, {1.5}}, degrees));
    append(all, throughStack(context, "oil on wine", {{1.47, 2.0}, {1.34, 8.0}}, 50.0));
    append(all, throughStack(context, "one ior, clear on dark", {{1.5}, {1.5, 6.0}}, 30.0));
    return all;
}

/// A plate that lies on a Lambertian floor under a sky of 1: R + (1 - R) / n^2 rho T / (1 - rho r), T the plate's
/// transmittance of a diffuse sky, r = 1 - T / n^2 its reflectance from below [Saunderson1942, eq. 1].
std::vector<Finding> glassOnTable(const CheckContext& context) {
    const double n = 1.5, rho = 0.7, r0 = fresnel(1.0, n);
    const double diffuse = integral(0.0, 1.0, [n](double c) { return 2.0 * c * (1.0 - fresnel(c, n)); });
    const double expected = r0 + (1.0 - r0) / (n * n) * rho * diffuse / (1.0 - rho * (1.0 - diffuse / (n * n)));
    EnvironmentDescription sky;
    sky.constant = Rgb(1.0F);
    std::vector<Finding> all;
    for (const double gap : {0.0, 1e-5, -1e-5}) {
        SceneBuilder b;
        b.quad({-2.2, -2.2, 0}, {2.3, 0, 0}, {0, 4.4, 0}, lambert(static_cast<float>(rho)));
        b.quad({0.1, -2.2, 0}, {2.1, 0, 0}, {0, 4.4, 0}, lambert(static_cast<float>(rho)));
        b.box({-2, -2, gap}, {2, 2, 0.04}, glass(static_cast<float>(n)));
        b.view(glm::dvec3(0.0), kUp, 1.0, 1.0);
        Rendered what{b.description(),
                      sky,
                      expected,
                      1.0,
                      fmt::format("radiance, {:+.0e} m above the table", gap),
                      {{Method::Path, 32, 0.0}},
                      16,
                      smallSettings()};
        if (gap == 0.0) {
            what.by.push_back({Method::Photon, 12, 0.01, 0.05});
            what.by.push_back({Method::Reference, 32, 0.0, 0.03});
            what.by.push_back({Method::Bdpt, 8, 0.0, 0.03});
        }
        append(all, measure(context, what));
    }
    return all;
}

/// A lamp in the plane of a black ceiling: what it gives to the floor, and how bright it looks.
std::vector<Finding> lampInCeiling(const CheckContext& context) {
    const std::array<glm::dvec3, 4> corners{glm::dvec3(-0.2, -0.3, 1), glm::dvec3(-0.2, 0.3, 1),
                                            glm::dvec3(0.4, 0.3, 1), glm::dvec3(0.4, -0.3, 1)};
    const auto room = [&] {
        SceneBuilder b;
        b.square(glm::dvec3(0.0), kUp, 1.0, lambert(0.5F));
        b.square({0, 0, 1.0}, -kUp, 1.0, lambert(0.0F));
        b.quad(corners[0], corners[1] - corners[0], corners[3] - corners[0], lamp(5.0F));
        return b;
    };
    const std::vector<By> by{{Method::Path, 16, 0.0}, {Method::Photon, 16, 0.005}};
    std::vector<Finding> all;
    SceneBuilder floor = room(), ceiling = room();
    floor.view(glm::dvec3(0.0), kUp, kPatch, 0.3);
    const double expected = 5.0 * meanOverSquare([&](double u, double v) {
                                return polygonIrradiance({kPatch * (u - 0.5), kPatch * (v - 0.5), 0.0}, kUp, corners);
                            });
    append(all, measureByAll(context,
                             {floor.description(), {}, expected, kPiD / 0.5, "irradiance", by, 16, smallSettings()}));
    ceiling.view({0.1, 0, 1}, -kUp, 0.3, 0.5);
    append(all, measureByAll(context,
                             {ceiling.description(), {}, 5.0, 1.0, "radiance of the lamp", by, 16, smallSettings()}));
    return all;
}

/// A veil that covers half lies in the plane of a floor: both are seen, and no light comes through both from below.
std::vector<Finding> veilOnFloor(const CheckContext& context) {
    Material veil = lambert(0.2F);
    veil.alphaMode = AlphaMode::Blend;
    veil.baseColor.a = 0.5F;
    SceneBuilder b;
    b.square(glm::dvec3(0.0), kUp, 1.0, lambert(0.6F));
    b.quad({-1.3, -1.1, 0}, {2.4, 0, 0}, {0, 2.1, 0}, veil);
    b.square({0, 0, 2}, -kUp, 1.0, lambert(0.0F));
    b.point(kLight, 2.0);
    b.point({0, 0, -0.5}, 20.0);
    b.view(glm::dvec3(0.0), kUp, kPatch, 0.3);
    return measureByAll(context, {b.description(),
                                  {},
                                  0.4,
                                  kPiD / patchIrradiance(),
                                  "reflectance seen",
                                  {{Method::Path, 8, 0.0}, {Method::Photon, 16, 0.005}},
                                  16,
                                  smallSettings()});
}

}  // namespace

void addCoincidentFaces(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, const char* source, bool quick, auto run) {
        cases.push_back({name, CheckGroup::Extreme, guards, source, quick, run});
    };
    add("extreme-coplanar-faces", "two floors in one plane show one of the two", "invariance", true, coplanarFaces);
    add("extreme-coincident-glass", "plates of one glass that touch are one plate", "[Hecht2002]", true, oneGlass);
    add("extreme-touching-glasses", "bodies of different glass that touch have one face between them", "[Hecht2002]",
        false, waterInGlass);
    add("extreme-glass-on-a-table", "a plate whose lower face is the table's", "[Saunderson1942]", false, glassOnTable);
    add("extreme-lamp-in-the-ceiling", "a lamp in the plane of a ceiling", "[Lambert1760]", true, lampInCeiling);
    add("extreme-veil-on-a-floor", "a half-transparent face in the plane of a floor", "invariance", true, veilOnFloor);
}

}  // namespace pellucid::check

// Closed forms 1 to 5: convex bodies and enclosures, where the whole of light transport is a geometric series.
#include <cmath>

#include <fmt/format.h>

#include <pellucid/math/constants.h>

#include "check_cases.h"
#include "check_formulas.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

/// Where every record sees much the same, fewer gather rays and photons are enough.
[[nodiscard]] Settings furnaceSettings() {
    Settings s = smallSettings();
    s.gatherRays = 100;
    s.globalPhotons = 8000;
    return s;
}

/// The unit box, all faces alike, seen from within.
[[nodiscard]] SceneBuilder closedBox(float reflectance, float emission) {
    SceneBuilder b;
    b.box(glm::dvec3(-1.0), glm::dvec3(1.0), lambert(reflectance, emission), true);
    b.perspective({0.1, -0.2, 0.3}, {0.9, 0.5, -0.4}, 1.6);
    return b;
}

std::vector<Finding> convexInSky(const CheckContext& context) {
    SceneBuilder b;
    b.sphere(glm::dvec3(0.0), 1.0, 24, lambert(0.7F), false);
    b.view(glm::dvec3(0.0), {0.3, 0.5, 1.0}, 1.2, 2.0);
    EnvironmentDescription sky;
    sky.constant = Rgb(2.0F);
    return measureByAll(context, {b.description(),
                                  sky,
                                  0.7 * 2.0,
                                  1.0,
                                  "radiance rho L",
                                  {{Method::Path, 16, 0.0}, {Method::Photon, 32, 0.005}},
                                  16,
                                  smallSettings()});
}

std::vector<Finding> furnace(const CheckContext& context) {
    std::vector<Finding> all;
    for (const float rho : {0.2F, 0.5F, 0.8F}) {
        SceneBuilder b = closedBox(rho, 1.0F);
        auto found = measureByAll(context, {b.description(),
                                            {},
                                            1.0 / (1.0 - static_cast<double>(rho)),
                                            1.0,
                                            fmt::format("radiance at rho = {:.1f}", rho),
                                            {{Method::Path, 16, 0.0}, {Method::Photon, 4, 0.01, 0.03}},
                                            16,
                                            furnaceSettings()});
        all.insert(all.end(), found.begin(), found.end());
    }
    return all;
}

std::vector<Finding> bounces(const CheckContext& context) {
    std::vector<Finding> all;
    const double rho = 0.8;
    for (const int n : {1, 2, 3, 5}) {
        SceneBuilder b = closedBox(0.8F, 1.0F);
        Settings settings = smallSettings();
        settings.maxDepth = n;
        auto found = measureByAll(context, {b.description(),
                                            {},
                                            (1.0 - std::pow(rho, n + 1)) / (1.0 - rho),
                                            1.0,
                                            fmt::format("radiance after {} bounces", n),
                                            {{Method::Path, 8, 0.0}},
                                            16,
                                            settings});
        all.insert(all.end(), found.begin(), found.end());
    }
    return all;
}

/// In every closed room of area A the mean irradiance is Phi / (A (1 - rho)); in a sphere it is so everywhere.
std::vector<Finding> integratingSphere(const CheckContext& context) {
    const double rho = 0.6, intensity = 3.0, flux = 4.0 * kPiD * intensity;
    SceneBuilder b;
    const double area = b.sphere(glm::dvec3(0.0), 1.0, 40, lambert(0.6F), false, true);
    b.point({0.4, 0.1, -0.2}, intensity);
    const glm::dvec3 wall = glm::normalize(glm::dvec3(0.3, 0.5, 0.8));
    b.view(wall, -wall, 0.4, 0.3);
    return measureByAll(context,
                        {b.description(),
                         {},
                         flux * rho / (area * (1.0 - rho)),
                         kPiD / rho,
                         "indirect irradiance",
                         {{Method::Path, 128, 0.0, 0.02, "indirect"}, {Method::Photon, 4, 0.02, 0.03, "indirect"}},
                         16,
                         smallSettings()});
}

/// Mirrors for side walls make the plates infinite.
std::vector<Finding> parallelPlates(const CheckContext& context) {
    const double rho1 = 0.5, rho2 = 0.8, e1 = 1.0, e2 = 0.2;
    Settings settings = furnaceSettings();
    settings.causticPhotons = 4000;
    std::vector<Finding> all;
    for (const bool lower : {true, false}) {
        SceneBuilder b;
        b.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, lambert(0.5F, 1.0F));
        b.quad({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, lambert(0.8F, 0.2F));
        const Material wall = mirror(1.0F);
        b.quad({-1, -1, 0}, {0, 2, 0}, {0, 0, 1}, wall);
        b.quad({1, -1, 0}, {0, 2, 0}, {0, 0, 1}, wall);
        b.quad({-1, -1, 0}, {2, 0, 0}, {0, 0, 1}, wall);
        b.quad({-1, 1, 0}, {2, 0, 0}, {0, 0, 1}, wall);
        b.view({0.1, 0.2, lower ? 0.0 : 1.0}, {0, 0, lower ? 1.0 : -1.0}, 1.0, 0.5);
        const double expected = lower ? (e1 + rho1 * e2) / (1.0 - rho1 * rho2) : (e2 + rho2 * e1) / (1.0 - rho1 * rho2);
        auto found = measureByAll(context, {b.description(),
                                            {},
                                            expected,
                                            1.0,
                                            lower ? "radiance of plate 1" : "radiance of plate 2",
                                            {{Method::Path, 16, 0.0, 0.03}, {Method::Photon, 4, 0.015, 0.03}},
                                            16,
                                            settings});
        all.insert(all.end(), found.begin(), found.end());
    }
    return all;
}

/// F12 = 1, F21 = A1/A2, F22 = 1 - F21; areas of the tessellated spheres, for which the first is exact too.
std::vector<Finding> concentricSpheres(const CheckContext& context) {
    const double rho1 = 0.5, rho2 = 0.7;
    std::vector<Finding> all;
    for (const bool inner : {true, false}) {
        SceneBuilder b;
        const double a1 = b.sphere(glm::dvec3(0.0), 0.5, 32, lambert(0.5F, 1.0F), false);
        const double a2 = b.sphere(glm::dvec3(0.0), 1.0, 32, lambert(0.7F), false, true);
        const glm::dvec3 n = glm::normalize(glm::dvec3(0.4, 0.3, 0.7));
        b.view(n * (inner ? 0.5 : 1.0), inner ? n : -n, 0.3, 0.25);
        const double f21 = a1 / a2;
        // L1 = 1 + rho1 L2, L2 = rho2 (F21 L1 + F22 L2)
        const double l2 = rho2 * f21 / (1.0 - rho2 * (1.0 - f21) - rho1 * rho2 * f21);
        auto found = measureByAll(context, {b.description(),
                                            {},
                                            inner ? 1.0 + rho1 * l2 : l2,
                                            1.0,
                                            inner ? "radiance of the inner" : "radiance of the outer",
                                            {{Method::Path, 32, 0.0}, {Method::Photon, 8, 0.015, 0.04}},
                                            16,
                                            furnaceSettings()});
        all.insert(all.end(), found.begin(), found.end());
    }
    return all;
}

}  // namespace

void addFurnaces(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, const char* source, bool quick, auto run) {
        cases.push_back({name, CheckGroup::ClosedForm, guards, source, quick, run});
    };
    add("closed-form-1-convex-in-sky", "a convex Lambertian in a constant sky: rho L", "energy conservation", true,
        convexInSky);
    add("closed-form-2-closed-box", "a closed room of uniform emission and reflectance: Le / (1 - rho)",
        "Neumann series", true, furnace);
    add("closed-form-2-bounces", "the same after n bounces: Le (1 - rho^(n+1)) / (1 - rho)", "Neumann series", true,
        bounces);
    add("closed-form-3-integrating-sphere", "E = Phi rho / (4 pi R^2 (1 - rho)), the source anywhere", "[Jacquez1955]",
        true, integratingSphere);
    add("closed-form-4-parallel-plates", "B1 = (E1 + rho1 E2) / (1 - rho1 rho2)", "[Howell2010, ch. 5]", false,
        parallelPlates);
    add("closed-form-5-concentric-spheres", "F12 = 1, F21 = (r1/r2)^2, F22 = 1 - F21", "[Howell2010, ch. 5]", false,
        concentricSpheres);
}

}  // namespace pellucid::check

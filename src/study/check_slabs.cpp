// Closed forms 15 to 17 and 24: plane glass.
#include <cmath>

#include <fmt/format.h>

#include <pellucid/math/constants.h>

#include "check_cases.h"
#include "check_formulas.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

constexpr double kRho = 0.5;
const glm::dvec3 kUp(0, 0, 1);

void append(std::vector<Finding>& to, std::vector<Finding> from) { to.insert(to.end(), from.begin(), from.end()); }

/// A lamp of radiance 1 under a slab, seen through it at an angle.
[[nodiscard]] std::vector<Finding> throughSlab(const CheckContext& context, double degrees, float ior,
                                               float absorption) {
    const double angle = degrees * kPiD / 180.0, thickness = 0.2;
    SceneBuilder b;
    b.box({-3, -3, 0}, {3, 3, thickness}, glass(ior, absorption));
    b.square({0, 0, -0.5}, kUp, 3.0, lamp(1.0F));
    b.view(glm::dvec3(0.0), {std::sin(angle), 0, std::cos(angle)}, 0.5, 2.0);
    const double expected =
        slabTransmittance(std::cos(angle), static_cast<double>(ior), static_cast<double>(absorption) * thickness);
    return measureByAll(context,
                        {b.description(),
                         {},
                         expected,
                         1.0,
                         fmt::format("transmittance, n = {}, {:.0f} deg, sigma = {}", ior, degrees, absorption),
                         {{Method::Path, 16, 0.0}, {Method::Photon, 32, 0.0, 0.03}},
                         16,
                         smallSettings()});
}

std::vector<Finding> slabSeenThrough(const CheckContext& context) {
    std::vector<Finding> all;
    append(all, throughSlab(context, 0.0, 1.5F, 0.0F));
    append(all, throughSlab(context, 60.0, 1.5F, 0.0F));
    append(all, throughSlab(context, 0.0, 2.4F, 0.0F));
    return all;
}

std::vector<Finding> absorbingSlab(const CheckContext& context) {
    std::vector<Finding> all;
    append(all, throughSlab(context, 0.0, 1.5F, 5.0F));
    append(all, throughSlab(context, 50.0, 1.5F, 5.0F));
    append(all, throughSlab(context, 0.0, 1.0F, 5.0F));
    return all;
}

/// The sun through the slab onto a floor: T E0.
std::vector<Finding> sunThroughSlab(const CheckContext& context) {
    SceneBuilder b;
    b.square(glm::dvec3(0.0), kUp, 1.0, lambert(static_cast<float>(kRho)));
    b.box({-1, -1, 0.5}, {1, 1, 0.7}, glass(1.5F));
    b.sun({0, 0, -1}, 3.0);
    b.view(glm::dvec3(0.0), kUp, 0.6, 0.3);
    return measureByAll(context,
                        {b.description(),
                         {},
                         3.0 * slabTransmittance(1.0, 1.5),
                         kPiD / kRho,
                         "irradiance",
                         {{Method::Photon, 3, 0.005, 0.02, "caustic"}, {Method::Light, 4, 0.0, 0.02, "caustic"}},
                         16,
                         smallSettings()});
}

/// The same caustic seen in a mirror that stands on the floor: no path from the eye can find the sun behind it, so that of
/// the unbiased methods only the texels of the reference see it.
std::vector<Finding> causticInMirror(const CheckContext& context) {
    SceneBuilder b;
    b.square(glm::dvec3(0.0), kUp, 1.0, lambert(static_cast<float>(kRho)));
    b.box({-1, -1, 0.5}, {1, 1, 0.7}, glass(1.5F));
    b.quad({0.8, -0.5, 0}, {0, 0, 0.45}, {0, 1, 0}, mirror(1.0F));  // edge on to the sun
    b.sun({0, 0, -1}, 3.0);
    const double angle = 20.0 * kPiD / 180.0;  // of the view; it meets the mirror halfway up, then the floor at x = 0.3
    b.view({0.8, 0, 0.18}, {-std::cos(angle), 0, std::sin(angle)}, 0.3, 0.3);
    return measure(context,
                   {b.description(),
                    {},
                    3.0 * slabTransmittance(1.0, 1.5),
                    kPiD / kRho,
                    "irradiance",
                    {{Method::Photon, 3, 0.005, 0.03, "caustic"}, {Method::Reference, 8, 0.005, 0.08, "caustic"}},
                    16,
                    smallSettings()});
}

/// E = sum over internal bounces m of I T_m sin / (x dx/dtheta), T_m with the mean of both polarisations at each interface,
/// as an unpolarised renderer has it.
std::vector<Finding> pointThroughSlab(const CheckContext& context) {
    const double n = 1.5, t = 0.4, h = 1.0, intensity = 2.0, patch = 0.2;
    const glm::dvec3 middle(0.35, 0.0, 0.0);
    const auto landing = [=](double theta, int m) {
        const double inner = std::asin(refractedSine(std::sin(theta), n));
        return (h - t) * std::tan(theta) + (2 * m + 1) * t * std::tan(inner);
    };
    const auto irradianceAt = [&](double x) {
        double sum = 0.0;
        for (int m = 0; m < 6; ++m) {
            const double theta = root(0.0, 1.5, [&](double a) { return landing(a, m) - x; }), step = 1e-5;
            const double slope = (landing(theta + step, m) - landing(theta - step, m)) / (2.0 * step);
            const double r = fresnel(std::cos(theta), n);
            sum += intensity * (1.0 - r) * (1.0 - r) * std::pow(r, 2.0 * m) * std::sin(theta) / (x * slope);
        }
        return sum;
    };
    SceneBuilder b;
    b.square(glm::dvec3(0.0), kUp, 1.5, lambert(static_cast<float>(kRho)));
    // Wide: total reflection at its sides would send light back.
    b.box({-15, -15, 0.3}, {15, 15, 0.3 + t}, glass(static_cast<float>(n)));
    b.point({0, 0, h}, intensity);
    b.view(middle, kUp, patch, 0.2);
    const double expected = meanOverSquare(
        [&](double u, double v) { return irradianceAt(std::hypot(middle.x + patch * (u - 0.5), patch * (v - 0.5))); });
    return measureByAll(context,
                        {b.description(),
                         {},
                         expected,
                         kPiD / kRho,
                         "irradiance",
                         {{Method::Photon, 4, 0.01, 0.02, "caustic"}, {Method::Light, 8, 0.001, 0.02, "caustic"}},
                         16,
                         smallSettings()});
}

/// A right-angled prism turns the view by total reflection: in and out squarely, so T = (1 - R) / (1 + R) as for a slab.
std::vector<Finding> totalReflectionPrism(const CheckContext& context) {
    // Enters through the leg z = 0 going up, turns at the hypotenuse, leaves through the leg x = 0 going to -x.
    const double expected = slabTransmittance(1.0, 1.5);
    SceneBuilder seen;
    seen.mesh(rightAngledPrism(1.0F), glass(1.5F));
    seen.square({-1.0, 0, 0.4}, {1, 0, 0}, 0.9, lamp(1.0F));
    seen.view({0.4, 0, 0}, {0, 0, -1}, 0.3, 0.5);
    std::vector<Finding> all = measureByAll(context, {seen.description(),
                                                      {},
                                                      expected,
                                                      1.0,
                                                      "transmittance",
                                                      {{Method::Path, 16, 0.0}, {Method::Photon, 32, 0.0, 0.03}},
                                                      16,
                                                      smallSettings()});
    SceneBuilder lit;
    lit.mesh(rightAngledPrism(1.0F), glass(1.5F));
    lit.square({-0.5, 0, 0.4}, {1, 0, 0}, 0.9, lambert(static_cast<float>(kRho)));
    lit.sun({0, 0, 1}, 3.0);
    lit.view({-0.5, 0, 0.4}, {1, 0, 0}, 0.3, 0.3);
    append(all, measureByAll(context,
                             {lit.description(),
                              {},
                              3.0 * expected,
                              kPiD / kRho,
                              "irradiance",
                              {{Method::Photon, 3, 0.005, 0.02, "caustic"}, {Method::Light, 4, 0.0, 0.02, "caustic"}},
                              16,
                              smallSettings()}));
    return all;
}

/// A square rod: whatever goes in squarely comes out, and light at an angle is kept in by total reflection.
std::vector<Finding> lightPipe(const CheckContext& context) {
    SceneBuilder b;
    b.box({-0.1, -0.1, 0}, {0.1, 0.1, 2}, glass(1.5F));
    b.square({0, 0, -0.05}, kUp, 1.0, lamp(1.0F));
    const double angle = 30.0 * kPiD / 180.0;
    b.view({0, 0, 2}, {std::sin(angle), 0, std::cos(angle)}, 0.15, 0.5);
    return measureByAll(context, {b.description(),
                                  {},
                                  slabTransmittance(std::cos(angle), 1.5),
                                  1.0,
                                  "transmittance at 30 deg",
                                  {{Method::Path, 16, 0.0}, {Method::Photon, 32, 0.0, 0.03}},
                                  16,
                                  smallSettings()});
}

}  // namespace

void addSlabs(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, const char* source, bool quick, auto run) {
        cases.push_back({name, CheckGroup::ClosedForm, guards, source, quick, run});
    };
    add("closed-form-15-slab-seen-through", "T = 2n / (n^2 + 1) squarely, (1 - R) / (1 + R) at an angle",
        "[Hecht2002, eqs. 4.34-4.40]", true, slabSeenThrough);
    add("closed-form-15-sun-through-slab", "E = 2n / (n^2 + 1) E0", "[Hecht2002, eqs. 4.34-4.40]", true,
        sunThroughSlab);
    add("closed-form-15-caustic-in-a-mirror", "the same floor seen in a mirror, by texel irradiance",
        "[Hecht2002, eqs. 4.34-4.40]", true, causticInMirror);
    add("closed-form-16-point-light-through-slab", "E = sum I T_m sin / (x dx/dtheta)", "flux through a ring, Snell",
        false, pointThroughSlab);
    add("closed-form-17-absorbing-slab", "Beer: exp(-sigma t / cos')", "[Hecht2002, sec. 4.8]", true, absorbingSlab);
    add("closed-form-24-total-reflection-prism", "flux out = T flux in", "[Hecht2002, sec. 4.7]", false,
        totalReflectionPrism);
    add("closed-form-24-light-pipe", "flux out = T flux in, total reflection at the sides", "[Hecht2002, sec. 5.6]",
        false, lightPipe);
}

}  // namespace pellucid::check

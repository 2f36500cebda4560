// Closed forms 18, 19 and 23: mirrors that focus.
#include <algorithm>
#include <cmath>

#include <pellucid/math/constants.h>

#include "check_cases.h"
#include "check_formulas.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

constexpr double kRho = 0.5;
const glm::dvec3 kUp(0, 0, 1);

/// z = r^2 / 4f with the light at its focus: a beam along z of irradiance I / (f^2 (1 + r^2/4f^2)^2).
std::vector<Finding> parabola(const CheckContext& context) {
    const double f = 0.5, rim = 0.9, intensity = 2.0, patch = 0.2;
    const glm::dvec3 middle(0.4, 0.1, 1.5);
    SceneBuilder b;
    const auto shape = [=](double u, double v) {
        const double phi = u >= 1.0 ? 0.0 : 2.0 * kPiD * u, r = rim * v, c = std::cos(phi), s = std::sin(phi);
        return SurfaceSpot{{r * c, r * s, r * r / (4.0 * f)},
                           glm::normalize(glm::dvec3(-r * c / (2.0 * f), -r * s / (2.0 * f), 1.0))};
    };
    b.surface(192, 96, shape, mirror(1.0F), true);
    b.square({0, 0, middle.z}, -kUp, 1.2, lambert(static_cast<float>(kRho)));
    b.point({0, 0, f}, intensity);
    b.view(middle, -kUp, patch, 0.3);
    const double expected = meanOverSquare([&](double u, double v) {
        const double x = middle.x + patch * (u - 0.5), y = middle.y + patch * (v - 0.5),
                     k = 1.0 + (x * x + y * y) / (4.0 * f * f);
        return intensity / (f * f * k * k);
    });
    return measureByAll(context,
                        {b.description(),
                         {},
                         expected,
                         kPiD / kRho,
                         "beam irradiance",
                         {{Method::Photon, 4, 0.01, 0.02, "caustic"}, {Method::Light, 8, 0.003, 0.02, "caustic"}},
                         16,
                         smallSettings()});
}

/// A closed ellipsoid of mirror, the light in one focus, a small ball around the other: all that misses the ball directly
/// meets it after one reflection, going towards its centre.
std::vector<Finding> ellipsoid(const CheckContext& context) {
    const double a = 1.0, c = 0.5, b = std::sqrt(a * a - c * c), ball = 0.1, intensity = 1.0;
    SceneBuilder scene;
    const auto shape = [=](double u, double v) {
        const double phi = u >= 1.0 ? 0.0 : 2.0 * kPiD * u, theta = kPiD * v,
                     s = v <= 0.0 || v >= 1.0 ? 0.0 : std::sin(theta);
        const glm::dvec3 p(b * s * std::cos(phi), b * s * std::sin(phi), a * std::cos(theta));
        return SurfaceSpot{p, -glm::normalize(glm::dvec3(p.x / (b * b), p.y / (b * b), p.z / (a * a)))};
    };
    scene.surface(256, 192, shape, mirror(1.0F), true);
    scene.sphere({0, 0, -c}, ball, 24, lambert(static_cast<float>(kRho)), false);
    scene.point({0, 0, c}, intensity);
    const Scene made = makeScene(context, scene.description());
    const double sine = ball / (2.0 * c), direct = 0.5 * (1.0 - std::sqrt(1.0 - sine * sine));
    std::vector<Finding> all;
    all.push_back(measureSeeds(context, "flux at the ball, photon pass", 4.0 * kPiD * intensity * (1.0 - direct), 0.001,
                               0.01, [&](std::uint64_t seed) {
                                   double flux = 0.0;
                                   for (const Photon& p : causticPhotons(context, made, 20'000, seed))
                                       flux += static_cast<double>(p.flux.g);
                                   return flux;
                               }));
    all.push_back(measureSeeds(
        context, "mean distance by which rays miss the focus, in ball radii", 0.0, 0.02, 0.02, [&](std::uint64_t seed) {
            double sum = 0.0, flux = 0.0;
            for (const Photon& p : causticPhotons(context, made, 20'000, seed)) {
                const glm::dvec3 to = glm::dvec3(p.position) - glm::dvec3(0, 0, -c);
                sum += static_cast<double>(p.flux.g) * glm::length(glm::cross(to, glm::dvec3(p.wi))) / ball;
                flux += static_cast<double>(p.flux.g);
            }
            return sum / flux;
        }));
    return all;
}

/// The concave half of a cylinder on a floor under a slanting sun. The wall point at angle phi and height z throws its
/// light s = z / tan(slant) far along the floor, where E = E0 sin(slant) / |1 - 2 s / (R cos phi)|: infinite on the
/// nephroid, with its cusp at R/2.
struct Cylinder {
    double radius = 1.0, slant = 0.7, irradiance = 3.0, height;
    explicit Cylinder(double reach, double atLeast = 0.0) : height(std::max(reach * std::tan(slant), atLeast)) {}

    [[nodiscard]] SceneBuilder mirrorAndFloor() const {
        SceneBuilder b;
        const auto wall = [this](double u, double v) {
            const double phi = kPiD * 0.8 * (u - 0.5);
            const glm::dvec3 n(std::cos(phi), std::sin(phi), 0);
            return SurfaceSpot{radius * n + glm::dvec3(0, 0, height * v), -n};
        };
        b.surface(1024, 1, wall, mirror(1.0F), true);
        b.square(glm::dvec3(0.0), kUp, 1.2, lambert(static_cast<float>(kRho)));
        return b;
    }
    [[nodiscard]] SceneBuilder scene() const {
        SceneBuilder b = mirrorAndFloor();
        b.sun({std::cos(slant), 0, -std::sin(slant)}, irradiance);
        return b;
    }
    [[nodiscard]] double at(double s) const { return irradiance * std::sin(slant) / std::fabs(1.0 - 2.0 * s / radius); }
};

std::vector<Finding> nephroidFlux(const CheckContext& context) {
    const Cylinder c(0.42);
    const double s = 0.25, patch = 0.06;
    SceneBuilder b = c.scene();
    b.view({c.radius - s, 0, 0}, kUp, patch, 0.1);
    const double expected = meanOverSquare([&](double u, double v) {
        // The ray of angle phi through (x, y): position R n + s d, d = direction (1,0) reflected at n.
        const double x = c.radius - s + patch * (u - 0.5), y = patch * (v - 0.5);
        const auto off = [&](double phi) {
            const glm::dvec2 n(std::cos(phi), std::sin(phi)), d = glm::dvec2(1, 0) - 2.0 * n.x * n,
                                                              to = glm::dvec2(x, y) - c.radius * n;
            return d.x * to.y - d.y * to.x;
        };
        const double phi = root(-0.4, 0.4, off);
        const double length = glm::length(glm::dvec2(x, y) - c.radius * glm::dvec2(std::cos(phi), std::sin(phi)));
        return c.irradiance * std::sin(c.slant) / std::fabs(1.0 - 2.0 * length / (c.radius * std::cos(phi)));
    });
    return measureByAll(context, {b.description(),
                                  {},
                                  expected,
                                  kPiD / kRho,
                                  "irradiance before the cusp",
                                  {{Method::Photon, 4, 0.01, 0.02, "caustic"},
                                   {Method::Light, 8, 0.005, 0.02, "caustic"},
                                   {Method::Bdpt, 512, 0.005, 0.2, "caustic"}},
                                  16,
                                  smallSettings()});
}

/// Photons along a strip on the axis: the densest place is the cusp, but for the strip's width, in which the two branches
/// behind the cusp, |y| ~ (s0 - s)^(3/2), are still one. From the wall, in its radii.
[[nodiscard]] double brightestOnAxis(const CheckContext& context, const Scene& scene, double radius,
                                     std::uint64_t seed) {
    constexpr int kBins = 80;
    double bins[kBins] = {};
    for (const Photon& p : causticPhotons(context, scene, 200'000, seed)) {
        if (std::fabs(p.position.y) > 0.002F) continue;
        const int bin = static_cast<int>((radius - static_cast<double>(p.position.x)) * kBins);
        if (bin >= 0 && bin < kBins) bins[bin] += static_cast<double>(p.flux.g);
    }
    int best = 0;
    for (int i = 1; i < kBins; ++i)
        if (bins[i] > bins[best]) best = i;
    return (best + 0.5) / kBins;
}

std::vector<Finding> nephroidCusp(const CheckContext& context) {
    const Cylinder c(0.8);
    const Scene scene = makeScene(context, c.scene().description());
    return {measureSeeds(context, "distance of the brightest place from the wall, photon pass", 0.5 * c.radius, 0.04,
                         0.04, [&](std::uint64_t seed) { return brightestOnAxis(context, scene, c.radius, seed); })};
}

/// A point light on the circle itself, 2R before the wall: 1/p + 1/q = 2/R puts the cusp of the cardioid at q = 2R/3.
std::vector<Finding> cardioidCusp(const CheckContext& context) {
    const Cylinder c(0.0, 0.25);
    SceneBuilder b = c.mirrorAndFloor();
    b.point({-c.radius, 0, 0.6}, 1.0);
    const Scene scene = makeScene(context, b.description());
    return {measureSeeds(context, "distance of the brightest place from the wall, photon pass", 2.0 / 3.0 * c.radius,
                         0.04, 0.04,
                         [&](std::uint64_t seed) { return brightestOnAxis(context, scene, c.radius, seed); })};
}

}  // namespace

void addCurvedMirrors(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, const char* source, bool quick, auto run) {
        cases.push_back({name, CheckGroup::ClosedForm, guards, source, quick, run});
    };
    add("closed-form-18-parabola", "beam of a focal light: I / (f^2 (1 + r^2/4f^2)^2)", "[Hecht2002, sec. 5.4]", false,
        parabola);
    add("closed-form-19-ellipsoid", "all flux reaches the other focus", "[Hecht2002, sec. 5.4]", true, ellipsoid);
    add("closed-form-23-nephroid-flux", "E = E0 / |1 - 2 s / (R cos phi)| inside a cylindrical mirror",
        "Jacobian of the reflected rays", false, nephroidFlux);
    add("closed-form-23-nephroid-cusp", "the cusp lies at R/2", "[Holditch1858]", false, nephroidCusp);
    add("closed-form-23-cardioid-cusp", "a light on the circle: the cusp lies at 2R/3, 1/p + 1/q = 2/R",
        "[Hecht2002, sec. 5.4]", false, cardioidCusp);
}

}  // namespace pellucid::check

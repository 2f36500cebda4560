// Closed forms 20 to 22 and a lamp inside glass: bodies that refract twice.
#include <cmath>

#include <pellucid/math/constants.h>
#include <pellucid/transport/caustic_map.h>

#include "check_cases.h"
#include "check_formulas.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

constexpr double kRho = 0.5;
const glm::dvec3 kUp(0, 0, 1);

/// A plano-convex lens on z = 0 whose other side is the hyperboloid n z + |F - p| = const: light along +z meets in F.
struct HyperbolicLens {
    double n = 1.5, f = 1.0, thickness = 0.3, aperture = 0.4;

    [[nodiscard]] double sag(double r) const {
        const double p = (n - 1.0) * f;
        return (p - std::sqrt(p * p + (n * n - 1.0) * r * r)) / (n * n - 1.0);
    }
    [[nodiscard]] glm::dvec2 slope(double r) const {  // normal: radial, axial
        return glm::normalize(glm::dvec2(r, (n - 1.0) * f - (n * n - 1.0) * sag(r)));
    }
    /// int (1 - R0)(1 - R(r)) 2 pi r dr for unit irradiance.
    [[nodiscard]] double transmittedArea() const {
        return integral(0.0, aperture, [this](double r) {
            return 2.0 * kPiD * r * (1.0 - fresnel(1.0, n)) * (1.0 - fresnel(slope(r).y, 1.0 / n));
        });
    }
    void addTo(SceneBuilder& b) const {
        const Material material = glass(static_cast<float>(n));
        const auto turn = [](double u, double r, double z, const glm::dvec2& normal) {
            const double phi = u >= 1.0 ? 0.0 : 2.0 * kPiD * u;
            return SurfaceSpot{{r * std::cos(phi), r * std::sin(phi), z},
                               {normal.x * std::cos(phi), normal.x * std::sin(phi), normal.y}};
        };
        b.surface(
            128, 128,
            [&](double u, double v) {
                return turn(u, aperture * v, thickness + sag(aperture * v), slope(aperture * v));
            },
            material, true);
        b.surface(
            128, 1,
            [&](double u, double v) {
                return turn(u, aperture * v, 0.0, {0, -1});
            },
            material, false);
        b.surface(
            128, 1,
            [&](double u, double v) {
                return turn(u, aperture, (thickness + sag(aperture)) * v, {1, 0});
            },
            material, true);
    }
};

std::vector<Finding> hyperbolicLens(const CheckContext& context) {
    const HyperbolicLens lens;
    const glm::dvec3 focus(0, 0, lens.thickness + lens.f);
    SceneBuilder b;
    lens.addTo(b);
    b.square(focus, -kUp, 0.4, lambert(static_cast<float>(kRho)));
    b.sun(kUp, 3.0);
    const Scene scene = makeScene(context, b.description());
    const double flux = 3.0 * lens.transmittedArea(), radius = 0.05;
    std::vector<Finding> all;
    all.push_back(measureSeeds(context, "flux within 0.01 f of the focus, photon pass", flux, 0.002, 0.02,
                               [&](std::uint64_t seed) {
                                   double sum = 0.0;
                                   for (const Photon& p : causticPhotons(context, scene, 40'000, seed))
                                       if (glm::length(glm::dvec3(p.position) - focus) < 0.01)
                                           sum += static_cast<double>(p.flux.g);
                                   return sum;
                               }));
    // All photons in one point: the Epanechnikov kernel gives 2 flux / (pi r^2).
    all.push_back(measureSeeds(context, "irradiance of the caustic map there", 2.0 * flux / (kPiD * radius * radius),
                               0.003, 0.02, [&](std::uint64_t seed) {
                                   const CausticMap map(causticPhotons(context, scene, 40'000, seed));
                                   return static_cast<double>(map.irradiance(glm::vec3(focus), -glm::vec3(kUp),
                                                                             -glm::vec3(kUp), {Rgb(0.5F)},
                                                                             static_cast<float>(radius))
                                                                  .g);
                               }));
    return all;
}

/// Beyond the focus each point of the screen is met by one ray: E = E0 T^2 b db / (x dx).
std::vector<Finding> ballLens(const CheckContext& context) {
    const double n = 1.5, radius = 0.5, distance = 3.0, patch = 0.4;
    const glm::dvec3 middle(0.5, 0.0, -distance);
    const auto deviation = [=](double b) { return 2.0 * (std::asin(b / radius) - std::asin(b / (n * radius))); };
    const auto landing = [=](double b) { return (distance * std::sin(deviation(b)) - b) / std::cos(deviation(b)); };
    const auto irradianceAt = [&](double x) {
        const double b = root(0.0, 0.9 * radius, [&](double t) { return landing(t) - x; }), h = 1e-5;
        const double t = 1.0 - fresnel(std::sqrt(1.0 - b * b / (radius * radius)), n);
        return 3.0 * t * t * b * 2.0 * h / (x * (landing(b + h) - landing(b - h)));
    };
    SceneBuilder b;
    b.sphere(glm::dvec3(0.0), radius, 128, glass(static_cast<float>(n)), true);
    b.square({0, 0, -distance}, kUp, 1.0, lambert(static_cast<float>(kRho)));
    b.sun(-kUp, 3.0);
    b.view(middle, kUp, patch, 0.5);
    const double expected = meanOverSquare(
        [&](double u, double v) { return irradianceAt(std::hypot(middle.x + patch * (u - 0.5), patch * (v - 0.5))); });
    return measureByAll(context, {b.description(),
                                  {},
                                  expected,
                                  kPiD / kRho,
                                  "irradiance",
                                  {{Method::Photon, 4, 0.015, 0.12, "caustic"},
                                   {Method::Light, 32, 0.01, 0.12, "caustic"},
                                   {Method::Bdpt, 512, 0.01, 0.36, "caustic"}},
                                  16,
                                  smallSettings()});
}

/// After one inner reflection rays crowd at the least deviation, 180 + 2i - 4r at cos i = sqrt((n^2 - 1) / 3). They are
/// caught on a zone of a sphere whose hole lets the sun in.
std::vector<Finding> rainbow(const CheckContext& context) {
    const double n = 1.333, cosine = std::sqrt((n * n - 1.0) / 3.0), i = std::acos(cosine),
                 r = std::asin(std::sin(i) / n);
    const double expected = 180.0 + (2.0 * i - 4.0 * r) * 180.0 / kPiD;
    SceneBuilder b;
    b.sphere(glm::dvec3(0.0), 1.0, 160, glass(static_cast<float>(n)), true);
    const auto zone = [](double u, double v) {
        const double phi = u >= 1.0 ? 0.0 : 2.0 * kPiD * u, theta = kPiD / 180.0 * (16.0 + 50.0 * v);
        const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
        return SurfaceSpot{4.0 * d, -d};
    };
    b.surface(96, 24, zone, lambert(static_cast<float>(kRho)), false);
    b.sun(-kUp, 3.0);
    const Scene scene = makeScene(context, b.description());
    return {measureSeeds(context, "deviation of the brightest light, degrees, photon pass", expected, 0.003, 0.005,
                         [&](std::uint64_t seed) {
                             constexpr int kBins = 80;  // of a quarter degree, from 130 on
                             double bins[kBins] = {};
                             for (const Photon& p : causticPhotons(context, scene, 300'000, seed)) {
                                 const double degrees =
                                     std::acos(std::clamp(static_cast<double>(p.wi.z), -1.0, 1.0)) * 180.0 / kPiD;
                                 const int bin = static_cast<int>((degrees - 130.0) * 4.0);
                                 if (degrees >= 130.0 && bin < kBins) bins[bin] += static_cast<double>(p.flux.g);
                             }
                             int best = 0;
                             for (int k = 1; k < kBins; ++k)
                                 if (bins[k] > bins[best]) best = k;
                             return 130.0 + (best + 0.5) * 0.25;
                         })};
}

/// A black lamp of radius a in the middle of a glass ball of radius b: at the surface sin psi = a/b sin theta, what is
/// reflected falls back on the lamp. Outside, a spherically symmetric source acts like a point (Gauss).
std::vector<Finding> lampInGlass(const CheckContext& context) {
    const double n = 1.5, b = 0.3, radiance = 20.0, patch = 0.8;
    const glm::dvec3 centre(0, 0, 1);
    SceneBuilder scene;
    scene.square(glm::dvec3(0.0), kUp, 1.0, lambert(static_cast<float>(kRho)));
    const double area = scene.sphere(centre, 0.1, 24, lamp(static_cast<float>(radiance)), false),
                 a = std::sqrt(area / (4.0 * kPiD));
    scene.sphere(centre, b, 96, glass(static_cast<float>(n)), true);
    scene.view(glm::dvec3(0.0), kUp, patch, 0.2);
    const double flux = area * radiance * integral(0.0, 0.5 * kPiD, [=](double theta) {
                            const double sine = a / b * std::sin(theta);
                            return 2.0 * kPiD * std::sin(theta) * std::cos(theta) *
                                   (1.0 - fresnel(std::sqrt(1.0 - sine * sine), 1.0 / n));
                        });
    const double expected = meanOverSquare([&](double u, double v) {
        return pointIrradiance({patch * (u - 0.5), patch * (v - 0.5), 0}, kUp, centre, flux / (4.0 * kPiD));
    });
    auto all = measureByAll(context, {scene.description(),
                                      {},
                                      expected,
                                      kPiD / kRho,
                                      "irradiance of the floor",
                                      {{Method::Path, 64, 0.003, 0.1, "caustic"},
                                       {Method::Photon, 3, 0.01, 0.05, "caustic"},
                                       {Method::Light, 4, 0.003, 0.05, "caustic"},
                                       {Method::Bdpt, 32, 0.003, 0.15, "caustic"},
                                       {Method::Reference, 1, 0.003, 0.15, "caustic"}},
                                      16,
                                      smallSettings()});
    SceneBuilder seen;
    seen.sphere(centre, 0.1, 24, lamp(static_cast<float>(radiance)), false);
    seen.sphere(centre, b, 96, glass(static_cast<float>(n)), true);
    seen.view(centre + b * kUp, kUp, 0.02, 0.5);
    auto radial = measureByAll(context, {seen.description(),
                                         {},
                                         radiance * (1.0 - fresnel(1.0, n)) / (n * n),
                                         1.0,
                                         "radiance of the lamp: L (1 - R) / n^2",
                                         {{Method::Path, 4, 0.001}, {Method::Photon, 8, 0.001}},
                                         16,
                                         smallSettings()});
    all.insert(all.end(), radial.begin(), radial.end());
    return all;
}

}  // namespace

void addLenses(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, const char* source, bool quick, auto run) {
        cases.push_back({name, CheckGroup::ClosedForm, guards, source, quick, run});
    };
    add("closed-form-20-hyperbolic-lens", "parallel light to one point, flux T E0 pi a^2", "[Hecht2002, sec. 5.2]",
        true, hyperbolicLens);
    add("closed-form-21-ball-lens", "E = E0 T^2 b db / (x dx), deviation 2 (asin(b/R) - asin(b/nR))",
        "[Hecht2002, sec. 5.2]", false, ballLens);
    add("closed-form-22-rainbow", "cos i = sqrt((n^2 - 1) / 3): 137.9 degrees at n = 1.333", "[Descartes1637]", false,
        rainbow);
    add("lamp-inside-glass", "flux and radiance that leave glass around a lamp, n^2 law included",
        "[Veach1997, sec. 5.2], Gauss", false, lampInGlass);
}

}  // namespace pellucid::check

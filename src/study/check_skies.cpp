// Closed forms 10 to 12: walls and skies, and the gradients that the irradiance cache takes from them.
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <pellucid/math/constants.h>
#include <pellucid/transport/final_gather.h>

#include "check_cases.h"
#include "check_formulas.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

constexpr double kRho = 0.5;

/// A wall at x = 0 of height 1 and width 12 over a floor of which only a patch at distance x is there.
constexpr std::array<glm::dvec3, 4> kWall{glm::dvec3(0, -6, 0), {0, 6, 0}, {0, 6, 1}, {0, -6, 1}};
[[nodiscard]] SceneBuilder corner(double x, const Material& wall) {
    SceneBuilder b;
    b.quad(kWall[0], kWall[1] - kWall[0], kWall[3] - kWall[0], wall);
    b.square({x, 0, 0}, {0, 0, 1}, 0.05, lambert(static_cast<float>(kRho)));
    b.view({x, 0, 0}, {0, 0, 1}, 0.08, 0.5);
    return b;
}
/// The wall's form factor, all but 1e-3 of that of an infinitely wide one: (1 - x / sqrt(x^2 + h^2)) / 2.
[[nodiscard]] double wallFactor(const glm::dvec3& p, const glm::dvec3& n) {
    return polygonIrradiance(p, n, kWall) / kPiD;
}
[[nodiscard]] double wallFactorOver(double x) {
    return meanOverSquare([x](double u, double v) {
        return wallFactor({x + 0.08 * (u - 0.5), 0.08 * (v - 0.5), 0}, {0, 0, 1});
    });
}

std::vector<Finding> cornerEmits(const CheckContext& context) {
    std::vector<Finding> all;
    for (const double x : {0.1, 0.5, 2.0}) {
        SceneBuilder b = corner(x, lamp(1.0F));
        Settings settings = smallSettings();
        settings.cache = "on";  // the plan sees that nothing indirect is there
        auto found = measureByAll(context, {b.description(),
                                            {},
                                            wallFactorOver(x),
                                            1.0 / kRho,
                                            fmt::format("form factor at {} h", x),
                                            {{Method::Path, 32, 0.0}, {Method::Photon, 32, 0.005, 0.03}},
                                            16,
                                            settings});
        all.insert(all.end(), found.begin(), found.end());
    }
    return all;
}

/// The sun meets the wall squarely and the floor not at all: the floor sees a wall of radiance rho E / pi.
std::vector<Finding> cornerLit(const CheckContext& context) {
    std::vector<Finding> all;
    for (const double x : {0.2, 1.0}) {
        SceneBuilder b = corner(x, lambert(0.8F));
        b.sun({-1, 0, 0}, 1.0);
        Settings settings = smallSettings();
        settings.gatherRays = 4096;  // the patch has room for one or two records
        auto found = measureByAll(
            context, {b.description(),
                      {},
                      wallFactorOver(x),
                      kPiD / (kRho * 0.8),
                      fmt::format("form factor at {} h", x),
                      {{Method::Path, 64, 0.0, 0.04, "indirect"}, {Method::Photon, 4, 0.02, 0.03, "indirect"}},
                      16,
                      settings});
        all.insert(all.end(), found.begin(), found.end());
    }
    return all;
}

/// Gradients of one record against those of Lambert's formula (by central differences in double).
std::vector<Finding> gradients(const CheckContext& context) {
    const double x = 0.6, h = 1e-4;
    SceneBuilder b = corner(x, lambert(1.0F));
    b.sun({-1, 0, 0}, 1.0);
    const Scene scene = makeScene(context, b.description());
    const double scale = scene.normalisation().scale();
    const TransportContext transport{scene, {}, {}};
    const auto record = [&](std::uint64_t seed, int rays) {
        Walk walk(transport);
        GatherPoint point;
        point.valid = true;
        point.position = glm::vec3((glm::dvec3(x, 0, 0) - scene.normalisation().centre) * scale);
        point.normal = point.geometricNormal = point.unmappedNormal = {0, 0, 1};
        return gatherRecord(walk, point, {rays, 0.0F, 1e6F, seed}, 0);
    };
    const glm::dvec3 up(0, 0, 1);
    const double slope = (wallFactor({x + h, 0, 0}, up) - wallFactor({x - h, 0, 0}, up)) / (2.0 * h);
    // (n_i x n) . rotation for n turned towards +x: n_i x n = +y.
    const auto turned = [](double a) { return glm::dvec3(std::sin(a), 0, std::cos(a)); };
    const double turning = (wallFactor({x, 0, 1e-9}, turned(h)) - wallFactor({x, 0, 1e-9}, turned(-h))) / (2.0 * h);
    std::vector<Finding> all;
    const auto add = [&](const char* what, int rays, double expected, double bias, double resolution, auto&& value) {
        all.push_back(measureSeeds(context, fmt::format("{}, {} rays", what, rays), expected, bias, resolution,
                                   [&](std::uint64_t seed) { return value(record(seed, rays)); }));
    };
    // The translational gradient sees an occluder's edge nearer than it is by up to a stratum: a bias of about 1.7 / M here.
    for (const auto& [rays, strata] : {std::pair(512, 13.0), std::pair(20'000, 80.0)}) {
        add("form factor of a gather", rays, wallFactor({x, 0, 0}, up), 0.0, 0.05,
            [](const IrradianceRecord& r) { return static_cast<double>(r.irradiance.g); });
        add("dF/dx", rays, slope, 2.0 / strata, 0.05,
            [&](const IrradianceRecord& r) { return static_cast<double>(r.translation[1].x) * scale; });
        add("dF/dangle", rays, turning, 0.01, 0.02,
            [](const IrradianceRecord& r) { return static_cast<double>(r.rotation[1].y); });
    }
    return all;
}

/// A tilted patch under a sky; y is up.
[[nodiscard]] std::vector<Finding> underSky(const CheckContext& context, const glm::dvec3& normal,
                                            const std::function<double(const glm::dvec3&)>& sky, double expected,
                                            const std::string& quantity) {
    SceneBuilder b;
    b.square(glm::dvec3(0.0), normal, 0.5, lambert(static_cast<float>(kRho)));
    b.view(glm::dvec3(0.0), normal, 0.5, 1.0);
    return measureByAll(context, {b.description(),
                                  environmentMap(512, 256, sky),
                                  expected,
                                  kPiD / kRho,
                                  quantity,
                                  {{Method::Path, 32, 0.0, 0.02}, {Method::Photon, 64, 0.005, 0.02}},
                                  16,
                                  smallSettings()});
}
void append(std::vector<Finding>& to, std::vector<Finding> from) { to.insert(to.end(), from.begin(), from.end()); }

std::vector<Finding> tiltedSky(const CheckContext& context) {
    std::vector<Finding> all;
    for (const double tilt : {0.0, 45.0, 90.0}) {
        const double beta = tilt * kPiD / 180.0;
        append(all, underSky(
                        context, {std::sin(beta) * 0.8, std::cos(beta), std::sin(beta) * 0.6},
                        [](const glm::dvec3& d) { return d.y > 0.0 ? 1.0 : 0.0; }, 0.5 * kPiD * (1.0 + std::cos(beta)),
                        fmt::format("irradiance, tilt {:.0f}", tilt)));
    }
    return all;
}

std::vector<Finding> overcastSky(const CheckContext& context) {
    return underSky(
        context, {0, 1, 0}, [](const glm::dvec3& d) { return d.y > 0.0 ? (1.0 + 2.0 * d.y) / 3.0 : 0.0; },
        7.0 * kPiD / 9.0, "irradiance");
}

std::vector<Finding> linearSky(const CheckContext& context) {
    const glm::dvec3 a(0.3, 0.5, -0.4);
    std::vector<Finding> all;
    for (const glm::dvec3& n : {glm::dvec3(0, 1, 0), glm::dvec3(0.6, 0, 0.8), glm::dvec3(-0.48, -0.6, 0.64)})
        append(all,
               underSky(
                   context, n, [&](const glm::dvec3& d) { return 1.0 + glm::dot(a, d); },
                   kPiD + 2.0 * kPiD / 3.0 * glm::dot(a, n), fmt::format("irradiance, a.n = {:.2f}", glm::dot(a, n))));
    return all;
}

}  // namespace

void addSkies(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, const char* source, bool quick, auto run) {
        cases.push_back({name, CheckGroup::ClosedForm, guards, source, quick, run});
    };
    add("closed-form-10-corner-wall-emits", "F = (1 - x / sqrt(x^2 + h^2)) / 2, direct light", "[Howell2010, app. C]",
        true, cornerEmits);
    add("closed-form-10-corner-wall-lit", "the same as indirect light, over gather, cache and global map",
        "[Howell2010, app. C]", true, cornerLit);
    add("closed-form-10-gradients", "dF/dx and dF/dn of one irradiance record", "[WardHeckbert1992]", true, gradients);
    add("closed-form-11-tilted-sky", "E = pi L (1 + cos beta) / 2", "[LiuJordan1960]", true, tiltedSky);
    add("closed-form-11-overcast-sky", "CIE overcast sky: E = 7 pi / 9 Lz", "[MoonSpencer1942]", true, overcastSky);
    add("closed-form-12-linear-sky", "L = 1 + a.w: E = pi + (2 pi / 3) a.n",
        "spherical harmonics, [RamamoorthiHanrahan2001]", true, linearSky);
}

}  // namespace pellucid::check

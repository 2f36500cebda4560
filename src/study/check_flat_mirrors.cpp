// Closed forms 13, 14 and 28: image sources.
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <pellucid/math/constants.h>

#include "check_cases.h"
#include "check_formulas.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

constexpr double kRho = 0.5, kPatch = 0.3;
const glm::dvec3 kUp(0, 0, 1);

/// A floor and a mirror at x = 1 that stands on it.
[[nodiscard]] SceneBuilder floorAndMirror() {
    SceneBuilder b;
    b.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, lambert(static_cast<float>(kRho)));
    b.quad({1, -1, 0}, {0, 0, 2}, {0, 2, 0}, mirror(1.0F));
    b.view(glm::dvec3(0.0), kUp, kPatch, 0.2);
    return b;
}
[[nodiscard]] double overPatch(const std::function<double(const glm::dvec3&)>& e) {
    return meanOverSquare([&e](double u, double v) { return e({(u - 0.5) * kPatch, (v - 0.5) * kPatch, 0.0}); });
}

std::vector<Finding> pointInMirror(const CheckContext& context) {
    SceneBuilder b = floorAndMirror();
    b.point({0.4, -0.2, 1.0}, 2.0);
    const double image = overPatch([](const glm::dvec3& p) { return pointIrradiance(p, kUp, {1.6, -0.2, 1.0}, 2.0); });
    return measureByAll(context,
                        {b.description(),
                         {},
                         image,
                         kPiD / kRho,
                         "irradiance",
                         {{Method::Photon, 4, 0.01, 0.02, "caustic"}, {Method::Light, 8, 0.0, 0.02, "caustic"}},
                         16,
                         smallSettings()});
}

/// A lamp that path tracing can hit: the image of a polygon.
std::vector<Finding> lampInMirror(const CheckContext& context) {
    SceneBuilder b = floorAndMirror();
    b.quad({0.0, -0.7, 0.8}, {0, 1.4, 0}, {0.95, 0, 0}, lamp(5.0F));
    const std::array<glm::dvec3, 4> image{
        glm::dvec3(2.0, -0.7, 0.8), {2.0, 0.7, 0.8}, {1.05, 0.7, 0.8}, {1.05, -0.7, 0.8}};
    const double expected = 5.0 * overPatch([&](const glm::dvec3& p) { return polygonIrradiance(p, kUp, image); });
    return measureByAll(context, {b.description(),
                                  {},
                                  expected,
                                  kPiD / kRho,
                                  "irradiance",
                                  {{Method::Path, 192, 0.0, 0.06, "caustic"},
                                   {Method::Photon, 8, 0.01, 0.04, "caustic"},
                                   {Method::Light, 32, 0.0, 0.05, "caustic"},
                                   {Method::Bdpt, 48, 0.0, 0.15, "caustic"},
                                   {Method::Reference, 4, 0.0, 0.15, "caustic"}},
                                  16,
                                  smallSettings()});
}

/// Mirrors of reflectance f0 (Schlick) at x = 0 and x = w: all images of the light, each weakened by its reflections.
std::vector<Finding> twoMirrors(const CheckContext& context) {
    const double f0 = 0.8, w = 1.0, x0 = 0.3, height = 1.0, intensity = 2.0;
    SceneBuilder b;
    b.quad({0, -2, 0}, {w, 0, 0}, {0, 4, 0}, lambert(static_cast<float>(kRho)));
    for (const double x : {0.0, w}) b.quad({x, -2, 0}, {0, 0, 1.2}, {0, 4, 0}, mirror(static_cast<float>(f0)));
    b.point({x0, 0, height}, intensity);
    const glm::dvec3 middle(0.5, 0.1, 0);
    b.view(middle, kUp, 0.3, 0.2);
    const auto e = [&](double u, double v) {
        const glm::dvec3 p = middle + 0.3 * glm::dvec3(u - 0.5, v - 0.5, 0.0);
        double sum = 0.0;
        // Images at 2 k w + x0 (2 |k| reflections) and 2 k w - x0 (|2 k - 1| reflections).
        for (int k = -200; k <= 200; ++k)
            for (const bool even : {true, false}) {
                const int reflections = even ? 2 * std::abs(k) : std::abs(2 * k - 1);
                if (reflections == 0) continue;
                const glm::dvec3 image(2.0 * k * w + (even ? x0 : -x0), 0, height);
                const double cosine = std::fabs(glm::normalize(image - p).x);
                sum += pointIrradiance(p, kUp, image, intensity) * std::pow(schlick(cosine, f0), reflections);
            }
        return sum;
    };
    return measureByAll(context,
                        {b.description(),
                         {},
                         meanOverSquare(e, 8),
                         kPiD / kRho,
                         "irradiance",
                         {{Method::Photon, 8, 0.01, 0.04, "caustic"}, {Method::Light, 16, 0.0, 0.03, "caustic"}},
                         16,
                         smallSettings()});
}

/// Two facing mirrors that glow: each adds its own light once a bounce.
std::vector<Finding> glowingMirrors(const CheckContext& context) {
    std::vector<Finding> all;
    for (const float r : {0.5F, 0.9F, 0.99F}) {
        SceneBuilder b;
        Material m = mirror(r);
        m.emission = Rgb(1.0F);
        b.square({0, 0, 0}, {0, 0, 1}, 1.0, m);
        b.square({0, 0, 1}, {0, 0, -1}, 1.0, m);
        b.view(glm::dvec3(0.0), kUp, 1.0, 0.5);
        auto found = measureByAll(context, {b.description(),
                                            {},
                                            1.0 / (1.0 - static_cast<double>(r)),
                                            1.0,
                                            fmt::format("radiance at R = {}", r),
                                            {{Method::Path, 8, 0.0, 0.05}, {Method::Photon, 16, 0.0, 0.1}},
                                            16,
                                            smallSettings()});
        all.insert(all.end(), found.begin(), found.end());
    }
    return all;
}

/// The camera looks into the corner and sees the lamp behind itself, weakened three times.
std::vector<Finding> cornerCube(const CheckContext& context) {
    const double f0 = 0.9;
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, 1.1, 0.9));
    SceneBuilder b;
    const Material m = mirror(static_cast<float>(f0));
    b.quad({0, 0, 0}, {0, 2, 0}, {0, 0, 2}, m);
    b.quad({0, 0, 0}, {0, 0, 2}, {2, 0, 0}, m);
    b.quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, m);
    b.square(axis * 6.0, -axis, 3.0, lamp(3.0F));
    b.view(axis * 0.5, axis, 0.5, 3.0);
    const double expected = 3.0 * schlick(axis.x, f0) * schlick(axis.y, f0) * schlick(axis.z, f0);
    return measureByAll(context, {b.description(),
                                  {},
                                  expected,
                                  1.0,
                                  "radiance sent back",
                                  {{Method::Path, 16, 0.0}, {Method::Photon, 64, 0.0}},
                                  16,
                                  smallSettings()});
}

}  // namespace

void addFlatMirrors(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, const char* source, bool quick, auto run) {
        cases.push_back({name, CheckGroup::ClosedForm, guards, source, quick, run});
    };
    add("closed-form-13-point-light-in-mirror", "image source", "[Hecht2002, sec. 5.4]", true, pointInMirror);
    add("closed-form-13-lamp-in-mirror", "image of a polygon lamp: path and photons agree",
        "[Hecht2002, sec. 5.4], [Lambert1760]", true, lampInMirror);
    add("closed-form-14-two-mirrors", "series of image sources, sum R^k I cos / d_k^2", "[Hecht2002, sec. 5.4]", false,
        twoMirrors);
    add("closed-form-14-glowing-mirrors", "facing mirrors that emit: sum R^k = 1 / (1 - R)", "geometric series", true,
        glowingMirrors);
    add("closed-form-28-corner-cube", "retroreflection, three reflections", "[Hecht2002, sec. 5.5]", true, cornerCube);
}

}  // namespace pellucid::check

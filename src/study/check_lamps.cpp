// Closed forms 6 to 9: the irradiance that a lamp makes on a floor.
#include <array>
#include <cmath>

#include <pellucid/math/constants.h>

#include "check_cases.h"
#include "check_formulas.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

constexpr double kRho = 0.5, kPatch = 0.2;

/// A floor at z = 0 seen from above over a patch of kPatch around the origin, and the mean of `e` over the patch.
[[nodiscard]] SceneBuilder floorScene() {
    SceneBuilder b;
    b.square(glm::dvec3(0.0), {0, 0, 1}, 1.0, lambert(static_cast<float>(kRho)));
    b.view(glm::dvec3(0.0), {0, 0, 1}, kPatch, 0.05);
    return b;
}
[[nodiscard]] double overPatch(const std::function<double(const glm::dvec3&)>& e) {
    return meanOverSquare([&e](double u, double v) { return e({(u - 0.5) * kPatch, (v - 0.5) * kPatch, 0.0}); });
}
[[nodiscard]] std::vector<Finding> irradiance(const CheckContext& context, SceneBuilder& b, double expected,
                                              const Settings& settings = smallSettings()) {
    return measureByAll(context, {b.description(),
                                  {},
                                  expected,
                                  kPiD / kRho,
                                  "irradiance",
                                  {{Method::Path, 16, 0.0, 0.012}, {Method::Photon, 64, 0.005, 0.02}},
                                  16,
                                  settings});
}

/// A polyhedron of area A shows on average the silhouette of a sphere of that area (Cauchy): its effective radius.
std::vector<Finding> sphereLamp(const CheckContext& context) {
    SceneBuilder b = floorScene();
    const glm::dvec3 centre(0.3, 0.1, 1.0);
    const double area = b.sphere(centre, 0.25, 32, lamp(5.0F), false), r2 = area / (4.0 * kPiD);
    return irradiance(context, b, overPatch([&](const glm::dvec3& p) {
                          return pointIrradiance(p, {0, 0, 1}, centre, kPiD * 5.0 * r2);
                      }));
}

/// A fan of 128 sectors with the disc's area.
std::vector<Finding> discLamp(const CheckContext& context) {
    const double h = 0.5, offset = 0.3, sectors = 128.0, angle = 2.0 * kPiD / sectors;
    const double radius = 0.4, drawn = radius * std::sqrt(angle / std::sin(angle));
    SceneBuilder b = floorScene();
    const auto shape = [&](double u, double v) {
        const double phi = 2.0 * kPiD * u;
        return SurfaceSpot{{offset + drawn * v * std::cos(phi), drawn * v * std::sin(phi), h}, {0, 0, -1}};
    };
    b.surface(static_cast<int>(sectors), 1, shape, lamp(5.0F), false);
    return irradiance(context, b, 5.0 * overPatch([&](const glm::dvec3& p) {
                                      return discIrradiance(h, std::hypot(offset - p.x, p.y), radius);
                                  }));
}

[[nodiscard]] std::vector<Finding> polygonLamp(const CheckContext& context, double height, const char* heuristic) {
    SceneBuilder b = floorScene();
    const std::array<glm::dvec3, 4> corners{
        glm::dvec3(-0.3, -0.2, height), {0.5, -0.2, height}, {0.5, 0.4, height}, {-0.3, 0.4, height}};
    b.quad(corners[0], corners[3] - corners[0], corners[1] - corners[0], lamp(5.0F));
    Settings settings = smallSettings();
    settings.misHeuristic = heuristic;
    return irradiance(context, b, 5.0 * overPatch([&](const glm::dvec3& p) {
                                      return polygonIrradiance(p, {0, 0, 1}, corners);
                                  }),
                      settings);
}

std::vector<Finding> tiltedTriangleLamp(const CheckContext& context) {
    SceneBuilder b = floorScene();
    const std::array<glm::dvec3, 3> corners{glm::dvec3(0.2, -0.6, 0.3), {0.9, 0.1, 0.9}, {0.1, 0.5, 0.6}};
    Mesh m;
    m.positions = {glm::vec3(corners[0]), glm::vec3(corners[1]), glm::vec3(corners[2])};
    m.triangles = {{0, 1, 2}};
    b.mesh(std::move(m), lamp(5.0F, true));
    return irradiance(context, b, 5.0 * overPatch([&](const glm::dvec3& p) {
                                      return polygonIrradiance(p, {0, 0, 1}, corners);
                                  }));
}

std::vector<Finding> pointLight(const CheckContext& context) {
    SceneBuilder b = floorScene();
    const glm::dvec3 light(0.4, -0.3, 0.8);
    b.point(light, 2.0);
    return irradiance(context, b, overPatch([&](const glm::dvec3& p) {
                          return pointIrradiance(p, {0, 0, 1}, light, 2.0);
                      }));
}

}  // namespace

void addLamps(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, const char* source, bool quick, auto run) {
        cases.push_back({name, CheckGroup::ClosedForm, guards, source, quick, run});
    };
    add("closed-form-6-sphere-lamp", "E = pi L (r/d)^2 cos, 4000 emissive triangles", "[Howell2010, app. C]", true,
        sphereLamp);
    add("closed-form-7-disc-lamp", "parallel disc at an offset", "[Walsh1958]", true, discLamp);
    add("closed-form-8-polygon-lamp", "Lambert's polygon formula, lamp at a distance", "[Lambert1760]", true,
        [](const CheckContext& c) { return polygonLamp(c, 0.8, "power"); });
    add("closed-form-8-polygon-lamp-close", "the same, the lamp a tenth of its size away", "[Lambert1760]", true,
        [](const CheckContext& c) { return polygonLamp(c, 0.06, "power"); });
    add("closed-form-8-triangle-tilted", "the same, a tilted triangle that emits from both sides", "[Lambert1760]",
        true, tiltedTriangleLamp);
    add("closed-form-9-point-light", "E = I cos / d^2", "inverse square law", true, pointLight);
    cases.push_back({"monte-carlo-balance-heuristic", CheckGroup::MonteCarlo,
                     "the balance heuristic stays unbiased (against form 8)", "[Veach1997, sec. 9.2]", true,
                     [](const CheckContext& c) { return polygonLamp(c, 0.06, "balance"); }});
}

}  // namespace pellucid::check

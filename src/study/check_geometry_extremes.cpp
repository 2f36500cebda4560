// Extremes of geometry: triangles that are none, thin gaps, glass that is not closed. The reference is the
// same scene without them.
#include <cmath>

#include <fmt/format.h>

#include <pellucid/math/constants.h>
#include <pellucid/study/record_json.h>

#include "check_cases.h"
#include "check_formulas.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

constexpr double kRho = 0.5, kPatch = 0.4;
const glm::dvec3 kUp(0, 0, 1), kLight(0.4, -0.3, 0.8);

void append(std::vector<Finding>& to, std::vector<Finding> from) { to.insert(to.end(), from.begin(), from.end()); }

/// A floor given by its triangles, under a point light: closed form 9.
[[nodiscard]] std::vector<Finding> floorOf(const CheckContext& context, Mesh mesh, const std::string& quantity) {
    SceneBuilder b;
    b.mesh(std::move(mesh), lambert(static_cast<float>(kRho)));
    b.point(kLight, 2.0);
    b.view(glm::dvec3(0.0), kUp, kPatch, 0.3);
    const double expected = meanOverSquare([](double u, double v) {
        return pointIrradiance({kPatch * (u - 0.5), kPatch * (v - 0.5), 0.0}, kUp, kLight, 2.0);
    });
    return measure(context, {b.description(),
                             {},
                             expected,
                             kPiD / kRho,
                             quantity,
                             {{Method::Path, 2, 0.0}, {Method::Photon, 4, 0.005}},
                             16,
                             smallSettings()});
}

[[nodiscard]] Mesh plainFloor() {
    Mesh m;
    m.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    m.triangles = {{0, 1, 2}, {0, 2, 3}};
    return m;
}

std::vector<Finding> badTriangles(const CheckContext& context) {
    std::vector<Finding> all;
    Mesh points = plainFloor();
    points.triangles.emplace_back(0, 0, 0);
    points.triangles.emplace_back(0, 2, 0);
    append(all, floorOf(context, points, "irradiance with triangles of no area"));
    Mesh lines = plainFloor();
    lines.positions.emplace_back(0, 0, 0);
    lines.triangles.emplace_back(0, 4, 2);
    append(all, floorOf(context, lines, "irradiance with three points on a line"));
    Mesh twice = plainFloor();
    twice.triangles.insert(twice.triangles.end(), {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}});
    append(all, floorOf(context, twice, "irradiance with faces twice, one turned over"));
    Mesh slivers;
    for (int i = 0; i <= 1000; ++i) {
        const float x = -1.0F + 0.002F * static_cast<float>(i);
        slivers.positions.insert(slivers.positions.end(), {{x, -1, 0}, {x, 1, 0}});
        if (i == 0) continue;
        const auto k = static_cast<std::uint32_t>(2 * i);
        slivers.triangles.insert(slivers.triangles.end(), {{k - 2, k, k + 1}, {k - 2, k + 1, k - 1}});
    }
    append(all, floorOf(context, slivers, "irradiance of 2000 slivers, 1:1000"));
    Mesh turned = plainFloor();
    turned.normals.assign(4, glm::vec3(0, 0, -1));
    append(all, floorOf(context, turned, "irradiance with normals turned over"));
    Mesh zero = plainFloor();
    zero.normals.assign(4, glm::vec3(0.0F));
    append(all, floorOf(context, zero, "irradiance with normals of length 0"));
    return all;
}

/// A gap of 1e-5 of the scene is air: two slabs, (1 - R) / (1 + 3 R).
std::vector<Finding> thinGap(const CheckContext& context) {
    SceneBuilder b;
    b.box({-3, -3, 0}, {3, 3, 0.125}, glass(1.5F));
    b.box({-3, -3, 0.1251}, {3, 3, 0.25}, glass(1.5F));
    b.square({0, 0, -0.5}, kUp, 3.0, lamp(1.0F));
    b.view(glm::dvec3(0.0), kUp, 0.5, 2.0);
    const double r = fresnel(1.0, 1.5);
    return measure(context, {b.description(),
                             {},
                             (1.0 - r) / (1.0 + 3.0 * r),
                             1.0,
                             "transmittance of two slabs",
                             {{Method::Path, 16, 0.0}, {Method::Photon, 32, 0.0, 0.03}},
                             16,
                             smallSettings()});
}

/// Not closed, or closed twice over: nothing right is expected, only that it ends, finite and not brighter than its sky.
std::vector<Finding> brokenGlass(const CheckContext& context) {
    const auto finite = [&](SceneBuilder& b, const std::string& what) {
        EnvironmentDescription sky;
        sky.constant = Rgb(1.0F);
        b.square({0, 0, -1.2}, kUp, 2.0, lambert(static_cast<float>(kRho)));
        b.perspective({2, -3, 2}, glm::dvec3(0.0), 0.7);
        const Scene scene = makeScene(context, b.description(), sky);
        std::vector<Finding> found;
        for (const Method method : {Method::Path, Method::Photon, Method::Bdpt, Method::Reference}) {
            const RenderResult r = renderOnce(context, scene, {method, 4}, smallSettings(), 16, context.seed);
            const double mean = meanOf(r.image);
            found.push_back(exact(
                what + ", " + methodName(method), 1.0,
                std::isfinite(mean) && mean > 0.1 && mean < 2.3 && r.record.nonfinite.count == 0 ? 1.0 : 0.0, 0.0));
        }
        return found;
    };
    std::vector<Finding> all;
    SceneBuilder open;
    open.square(glm::dvec3(0.0), {0.3, -0.2, 1.0}, 1.0, glass(1.5F));
    append(all, finite(open, "a single face of glass"));
    SceneBuilder twice;
    for (int i = 0; i < 2; ++i) twice.sphere(glm::dvec3(0.0), 1.0, 24, glass(1.5F), true);
    append(all, finite(twice, "a ball of glass twice in one place"));
    SceneBuilder inside;
    inside.sphere(glm::dvec3(0.0), 1.0, 24, glass(1.5F), true, true);
    append(all, finite(inside, "a ball of glass with its normals inwards"));
    SceneBuilder manifold;  // three faces at each edge of the sheet in the middle
    manifold.box({-0.8, -0.8, -0.8}, {0.8, 0.8, 0.8}, glass(1.5F));
    manifold.quad({-0.8, -0.8, 0}, {1.6, 0, 0}, {0, 1.6, 0}, glass(1.5F));
    append(all, finite(manifold, "a box of glass with a wall inside that shares its edges"));
    return all;
}

}  // namespace

void addGeometryExtremes(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, bool quick, auto run) {
        cases.push_back({name, CheckGroup::Extreme, guards, "invariance", quick, run});
    };
    add("extreme-bad-triangles", "triangles without area, slivers, duplicates and bad normals change nothing", false,
        badTriangles);
    add("extreme-thin-gap", "a gap of 1e-4 m between slabs of 6 m is air", true, thinGap);
    add("extreme-broken-glass", "glass that is open, doubled, inside out or no manifold ends finite", true,
        brokenGlass);
}

}  // namespace pellucid::check

// Extremes of what is seen: radiances twelve orders apart, lamps seen in mirrors alone, light kept in by grazing total
// reflection, ten thousand reflections.
#include <array>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include <pellucid/math/constants.h>

#include "check_cases.h"
#include "check_formulas.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

constexpr double kRho = 0.5;
const glm::dvec3 kUp(0, 0, 1);

/// Thirteen stripes of radiance 1e-6 ... 1e6, one a column; the worst column decides.
std::vector<Finding> twelveOrders(const CheckContext& context) {
    constexpr int kStripes = 13;
    SceneBuilder b;
    for (int i = 0; i < kStripes; ++i)
        b.quad({static_cast<double>(i), 0, 0}, {1, 0, 0}, {0, kStripes, 0},
               lamp(static_cast<float>(std::pow(10.0, i - 6))));
    b.view({0.5 * kStripes, 0.5 * kStripes, 0}, kUp, kStripes, 5.0);
    const Scene scene = makeScene(context, b.description());
    const Camera camera = scene.camera("", kStripes, kStripes);
    std::vector<Finding> all;
    for (const Method method : {Method::Path, Method::Photon}) {
        const Image image = renderOnce(context, scene, {method, 4}, smallSettings(), kStripes, context.seed).image;
        double worst = 0.0;
        for (int x = 0; x < kStripes; ++x) {
            const CameraRay ray = camera.ray({static_cast<float>(x) + 0.5F, 6.5F}, {0.5F, 0.5F});
            const auto hit = scene.intersect(ray.ray, 0.5F);
            const double expected =
                hit ? static_cast<double>(scene.description().materials[hit->point.material].emission.g) : 0.0;
            double mean = 0.0;
            for (int y = 0; y < kStripes; ++y)
                mean += static_cast<double>(image.at(static_cast<std::size_t>(y * kStripes + x), image.channel("G"))) /
                        kStripes;
            worst = std::max(worst, std::fabs(mean / expected - 1.0));
        }
        all.push_back(exact(method == Method::Path ? "largest relative error of a stripe, path" : "the same, photon",
                            0.0, worst, 1e-6));
    }
    return all;
}

/// The floor, the mirror at x = 1 and a lamp that a screen hides from the patch: all light comes over the mirror.
std::vector<Finding> seenInMirror(const CheckContext& context) {
    constexpr double kPatch = 0.3;
    SceneBuilder b;
    b.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, lambert(static_cast<float>(kRho)));
    b.quad({1, -1, 0}, {0, 0, 2}, {0, 2, 0}, mirror(1.0F));
    b.quad({-0.9, -0.7, 0.8}, {0, 1.4, 0}, {0.7, 0, 0}, lamp(5.0F));
    b.quad({-0.35, -0.4, 0.1}, {0.475, 0, 0}, {0, 0.8, 0}, lambert(0.0F));
    b.view(glm::dvec3(0.0), kUp, kPatch, 0.05);
    const std::array<glm::dvec3, 4> image{
        glm::dvec3(2.9, -0.7, 0.8), {2.9, 0.7, 0.8}, {2.2, 0.7, 0.8}, {2.2, -0.7, 0.8}};
    const double expected = 5.0 * meanOverSquare([&](double u, double v) {
                                return polygonIrradiance({kPatch * (u - 0.5), kPatch * (v - 0.5), 0.0}, kUp, image);
                            });
    return measure(
        context,
        {b.description(),
         {},
         expected,
         kPiD / kRho,
         "irradiance",
         {{Method::Path, 128, 0.0, 0.2}, {Method::Photon, 16, 0.01, 0.06}, {Method::Light, 16, 0.0, 0.2, "caustic"}},
         16,
         smallSettings()});
}

/// Down a rod of 40 times its width at 2 degrees: the sides are met at 88.7 degrees, and keep all.
std::vector<Finding> grazingTotalReflection(const CheckContext& context) {
    SceneBuilder b;
    b.box({-0.1, -0.1, 0}, {0.1, 0.1, 8}, glass(1.5F));
    b.square({0, 0, -0.05}, kUp, 1.0, lamp(1.0F));
    const double angle = 2.0 * kPiD / 180.0;
    b.view({0, 0, 8}, {std::sin(angle), 0, std::cos(angle)}, 0.15, 0.5);
    return measure(context, {b.description(),
                             {},
                             slabTransmittance(std::cos(angle), 1.5),
                             1.0,
                             "transmittance",
                             {{Method::Path, 16, 0.0}, {Method::Photon, 32, 0.0, 0.03}},
                             16,
                             smallSettings()});
}

/// Two perfect mirrors, 1 long, looked into at 45 degrees: 1 / gap reflections on the way to the lamp. Beyond 64 vertices
/// roulette keeps 0.9995 of the paths a bounce, so the interval widens with their number; what is asked is that nothing is
/// lost, and that it ends.
std::vector<Finding> tenThousandBounces(const CheckContext& context) {
    std::vector<Finding> all;
    for (const auto& [bounces, samples, resolution] : {std::tuple(1000, 16U, 0.15), std::tuple(10'000, 24U, 2.0)}) {
        const double gap = 1.0 / bounces;
        SceneBuilder b;
        b.quad({0, -1, 0}, {1, 0, 0}, {0, 2, 0}, mirror(1.0F));
        b.quad({0, -1, gap}, {0, 2, 0}, {1, 0, 0}, mirror(1.0F));
        b.quad({1, -1, -0.1}, {0, 0, 0.2}, {0, 2, 0}, lamp(1.0F));
        b.view({-1e-6, 0, 0.5 * gap}, {-1, 0, 1}, 0.5 * gap, 0.01);
        const std::vector<Finding> found =
            measure(context, {b.description(),
                              {},
                              1.0,
                              1.0,
                              fmt::format("radiance of the lamp behind {} reflections", bounces),
                              {{Method::Path, samples, 0.0, resolution}},
                              4,
                              smallSettings()});
        all.insert(all.end(), found.begin(), found.end());
    }
    return all;
}

}  // namespace

void addSightExtremes(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, const char* source, bool quick, auto run) {
        cases.push_back({name, CheckGroup::Extreme, guards, source, quick, run});
    };
    add("extreme-twelve-orders", "radiances from 1e-6 to 1e6 in one image", "emission as given", true, twelveOrders);
    add("extreme-lamp-in-mirror-only", "a lamp that is seen in a mirror alone", "[Lambert1760], image source", false,
        seenInMirror);
    add("extreme-grazing-total-reflection", "a light pipe whose sides are met at 88.7 degrees", "[Hecht2002, sec. 5.6]",
        true, grazingTotalReflection);
    add("extreme-ten-thousand-bounces", "a lamp behind ten thousand reflections", "energy conservation", false,
        tenThousandBounces);
}

}  // namespace pellucid::check

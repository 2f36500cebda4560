/// Photons that go where they are of use, where hardly any would by themselves: the two scenes that the makers of "one-click
/// caustics" name as the hard ones. [SikKrivanek2019]
#include <iostream>

#include <gtest/gtest.h>

#include <pellucid/render/plan.h>
#include <pellucid/transport/caster_aim.h>
#include <pellucid/transport/photon_trace.h>

#include "../../src/study/check_scenes.h"

namespace pellucid {
namespace {

struct UsefulShares {
    double unguided = 0.0, guided = 0.0;  ///< useful photons a path
};

/// What the plan's guide is worth against emission without one.
[[nodiscard]] UsefulShares sharesOf(const Scene& scene, std::uint32_t pathsUnguided, const Workers& workers) {
    RenderRequest request;
    request.width = request.height = 48;
    request.seed = 3;
    const TransportContext context{scene, {}, {}};
    const Camera camera = scene.camera("", request.width, request.height);
    const Survey seen = survey(context, camera, request.seed, 12.0F, 0.05F * scene.radius(), workers);
    const Plan plan = makePlan(scene, camera, request, seen, workers);
    const auto photons = [&](std::vector<UsefulEmission> training, std::uint32_t paths) {
        const EmissionGuide guide(scene.lights(), std::move(training));
        const CausticPass pass = traceCausticPhotons(scene, guide, {5, 1, paths}, &seen.visible, workers);
        return static_cast<double>(pass.useful.size()) / paths;
    };
    const UsefulShares shares{photons({}, pathsUnguided), photons(plan.training, 20'000)};
    std::cout << "useful photons a path: " << shares.unguided << " without guide, " << shares.guided << " with it\n";
    return shares;
}

/// A glass ball of ten centimetres on the floor of a hall of a hundred metres, with lamps of a square metre under the roof.
[[nodiscard]] SceneDescription stadium() {
    check::SceneBuilder b;
    b.box({-50, 0, -50}, {50, 25, 50}, check::lambert(0.5F), true);
    b.sphere({7.0, 0.1, -11.0}, 0.05, 16, check::glass(1.5F), true);
    for (const double x : {-30.0, 0.0, 30.0})
        for (const double z : {-30.0, 0.0, 30.0}) b.square({x, 24.5, z}, {0, -1, 0}, 0.5, check::lamp(4000.0F));
    b.perspective({7.0, 0.5, -10.4}, {7.0, 0.0, -11.0}, 0.6);
    return b.description();
}

TEST(PhotonAim, TheCausticInTheStadium) {
    const Workers workers;
    const Scene scene(stadium(), std::nullopt, SceneOptions{}, workers);
    const UsefulShares shares = sharesOf(scene, 2'000'000, workers);
    EXPECT_GT(shares.guided, 0.02);
    EXPECT_GT(shares.guided, 10.0 * shares.unguided);
}

/// Without aiming the pilot finds hardly a path to learn from.
TEST(PhotonAim, EveryStepOfTheAimIsNeeded) {
    const Workers workers;
    const Scene scene(stadium(), std::nullopt, SceneOptions{}, workers);
    const EmissionGuide unguided(scene.lights(), {});
    const CausticPass pilot = traceCausticPhotons(scene, unguided, {5, 1, 60'000}, nullptr, workers);
    EXPECT_LT(pilot.useful.size(), 24U);
    const std::vector<UsefulEmission> aimed = aimAtCasters(scene, 5, workers);
    EXPECT_GT(aimed.size(), 200U);
    const EmissionGuide guide(scene.lights(), aimed);
    const CausticPass pass = traceCausticPhotons(scene, guide, {5, 2, 20'000}, nullptr, workers);
    EXPECT_GT(pass.useful.size(), 100U);
    double power = 0.0;
    for (const Photon& p : pass.photons) power += static_cast<double>(luminance(p.flux));
    EXPECT_GT(power, 0.0);
}

/// A hundred bright lamps behind a wall, and one small sun-like lamp, of a thousandth of their power, over a glass ball.
TEST(PhotonAim, OneSunAmongAHundredLamps) {
    const Workers workers;
    check::SceneBuilder b;
    b.box({-10, 0, -10}, {10, 8, 10}, check::lambert(0.5F), true);
    b.quad({-10, 0, -2}, {20, 0, 0}, {0, 8, 0}, check::lambert(0.5F));
    b.sphere({0.0, 0.5, 5.0}, 0.3, 16, check::glass(1.5F), true);
    for (int i = 0; i < 100; ++i)
        b.square({-9.0 + 2.0 * (i % 10), 7.5, -9.5 + 0.7 * (i / 10)}, {0, -1, 0}, 0.2, check::lamp(100.0F));
    b.square({2.0, 7.0, 6.0}, glm::normalize(glm::dvec3(-2.0, -6.5, -1.0)), 0.02, check::lamp(1000.0F));
    b.perspective({0.0, 3.0, 9.0}, {-0.5, 0.0, 4.8}, 0.6);
    const Scene scene(b.description(), std::nullopt, SceneOptions{}, workers);
    const UsefulShares shares = sharesOf(scene, 1'000'000, workers);
    EXPECT_GT(shares.guided, 0.1);
    EXPECT_GT(shares.guided, 10.0 * shares.unguided);
}

/// A pool of two metres in a park of two hundred, under a sun of half a degree far away.
TEST(PhotonAim, AFarSunOverAPool) {
    const Workers workers;
    check::SceneBuilder b;
    b.quad({-100, 0.02, 100}, {200, 0, 0}, {0, 0, -95}, check::lambert(0.4F));
    b.quad({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, check::lambert(0.7F));
    b.surface(
        24, 24,
        [](double u, double v) {
            const double x = 2.0 * u - 1.0, z = 2.0 * v - 1.0;
            return check::SurfaceSpot{{x, 0.02 * std::sin(9.0 * x) * std::cos(7.0 * z), z},
                                      glm::normalize(glm::dvec3(-0.18 * std::cos(9.0 * x) * std::cos(7.0 * z), 1.0,
                                                                0.14 * std::sin(9.0 * x) * std::sin(7.0 * z)))};
        },
        check::glass(1.33F), true);
    b.square({30, 60, -45}, {-30, -60, 45}, 0.35, check::lamp(2e4F));
    b.perspective({0.0, 1.6, 1.2}, {0.0, -1.0, 0.0}, 0.9);
    const Scene scene(b.description(), std::nullopt, SceneOptions{}, workers);
    const UsefulShares shares = sharesOf(scene, 2'000'000, workers);
    EXPECT_GT(shares.guided, 0.05);
    EXPECT_GT(shares.guided, 10.0 * shares.unguided);
}

/// A closed room with one small window, a bright sky outside, a glass ball on the floor within.
TEST(PhotonAim, AnEnvironmentThroughAWindow) {
    const Workers workers;
    check::SceneBuilder b;
    const Material wall = check::lambert(0.6F);
    b.box({-2, 0, -2}, {2, 3, 2}, wall, true);
    // The wall x = 2 gives way to four parts around a window of half a metre.
    Mesh& room = b.description().meshes.back();
    std::erase_if(room.triangles, [&](const glm::uvec3& t) {
        return room.positions[t.x].x > 1.9F && room.positions[t.y].x > 1.9F && room.positions[t.z].x > 1.9F;
    });
    b.quad({2, 0, 2}, {0, 0, -4}, {0, 1.5, 0}, wall);
    b.quad({2, 2, 2}, {0, 0, -4}, {0, 1.0, 0}, wall);
    b.quad({2, 1.5, 2}, {0, 0, -1.75}, {0, 0.5, 0}, wall);
    b.quad({2, 1.5, -0.25}, {0, 0, -1.75}, {0, 0.5, 0}, wall);
    b.sphere({0.5, 0.3, 0.0}, 0.2, 16, check::glass(1.5F), true);
    b.perspective({-1.0, 1.2, 1.5}, {0.4, 0.0, 0.0}, 0.6);
    const EnvironmentDescription sky =
        check::environmentMap(64, 32, [](const glm::dvec3& d) { return 1.0 + std::max(0.0, d.y); });
    const Scene scene(b.description(), sky, SceneOptions{}, workers);
    const UsefulShares shares = sharesOf(scene, 2'000'000, workers);
    EXPECT_GT(shares.guided, 0.02);
    EXPECT_GT(shares.guided, 10.0 * shares.unguided);
}

}  // namespace
}  // namespace pellucid

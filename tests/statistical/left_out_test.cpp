/// The plan leaves cache and global map out where light that they would know is hardly any of path tracing's noise, really
/// out; and keeps them where that noise is theirs, and where path tracing would lose light for good. Photons of a pilot are
/// not traced for a camera that sees nothing that they could light.
#include <gtest/gtest.h>

#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>
#include <pellucid/study/record_json.h>

#include "small_scenes.h"

namespace pellucid {
namespace {

using namespace testing;

struct Spent {
    std::uint64_t rays = 0;
    std::size_t records = 0, photons = 0;
};

/// On the passes before the eye's that are for indirect light.
Spent spentOnIndirectLight(const SmallScene& small, const std::string& cache = "auto") {
    const Workers workers(2);
    const Scene scene(small.scene, small.environment, SceneOptions{}, workers);
    RenderRequest request;
    request.width = request.height = 32;
    request.budget.samples = 2;
    request.settings.cache = cache;
    request.settings.globalPhotons = 4000;
    const RenderResult result = render(scene, request, workers);
    Spent spent;
    for (const StageRecord& s : result.record.stages)
        if (s.name == "irradiance cache" || s.name == "global photons") {
            spent.rays += s.rays;
            spent.records += s.records;
            spent.photons += s.photonsEmitted;
        }
    return spent;
}

/// A plane and a ball of rough metal under a sky brighter on one side: the plane's light comes nearly all from the sky at once.
SmallScene open() {
    check::SceneBuilder b;
    b.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, check::lambert(0.4F));
    b.sphere({0.0, 0.5, 0.0}, 0.5, 16, check::mirror(0.7F, 0.5F), true);
    b.perspective({0.3, 1.5, 3.4}, {0, 0.3, 0}, 0.7);
    SmallScene s{"open", b.description()};
    s.environment = check::environmentMap(16, 8, [](const glm::dvec3& d) { return 1.0 + 3.0 * std::max(0.0, d.x); });
    return s;
}

/// The same plane with a glass ball under a point light: what its caustic lights no eye path finds.
SmallScene openUnderPoint() {
    check::SceneBuilder b;
    b.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, check::lambert(0.4F));
    b.sphere({0.0, 0.6, 0.0}, 0.5, 16, check::glass(1.5F), true);
    b.perspective({0.3, 1.5, 3.4}, {0, 0.3, 0}, 0.7);
    b.point({0.4, 3.0, 0.2}, 10.0);
    return {"open under a point light", b.description()};
}

TEST(CacheLeftOut, UnderAnOpenSky) {
    const Spent nothing = spentOnIndirectLight(open());
    EXPECT_EQ(nothing.rays, 0U);
    EXPECT_EQ(nothing.records, 0U);
    EXPECT_EQ(nothing.photons, 0U);
    EXPECT_GT(spentOnIndirectLight(open(), "on").records, 0U) << "asked for";
}

TEST(CacheLeftOut, NotInACorner) {
    EXPECT_GT(spentOnIndirectLight(roughGlass()).records, 0U);
    EXPECT_GT(spentOnIndirectLight(smoothCasters()).records, 0U);
}

/// A lamp through a slab of glass; with a floor in view where `floor` is set.
[[nodiscard]] std::uint64_t pilotPhotons(Method method, bool floor) {
    check::SceneBuilder b;
    b.box({-3, -3, 0}, {3, 3, 0.2}, check::glass(1.5F));
    b.square({0, 0, -0.5}, {0, 0, 1}, 1.0, check::lamp(1.0F));
    if (floor) b.square({0, 0, -0.6}, {0, 0, 1}, 3.0, check::lambert(0.5F));
    b.perspective({0.1, 0.2, 3.0}, {0, 0, 0}, 0.9);
    const Workers workers(2);
    const Scene scene(b.description(), std::nullopt, SceneOptions{}, workers);
    RenderRequest request;
    request.method = method;
    request.width = request.height = 32;
    request.budget.samples = 1;
    for (const StageRecord& s : render(scene, request, workers).record.stages)
        if (s.name == "pilot") return s.photonsEmitted;
    return 0;
}

TEST(PilotLeftOut, WhereTheCameraSeesNoReceiver) {
    for (const Method method : {Method::Photon, Method::Light, Method::Reference, Method::Sppm}) {
        EXPECT_EQ(pilotPhotons(method, false), 0U) << methodName(method);
        EXPECT_GT(pilotPhotons(method, true), 0U) << methodName(method);
    }
}

TEST(CacheLeftOut, NotWherePathTracingWouldLoseLight) { EXPECT_GT(spentOnIndirectLight(openUnderPoint()).records, 0U); }

}  // namespace
}  // namespace pellucid

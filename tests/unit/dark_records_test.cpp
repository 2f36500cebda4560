/// A record that sees hardly more than a dark thing near by must not speak far: a lamp of 40 cm hangs 2 cm under a ceiling, its
/// black back towards it. What lies between gets no light that a few rays would find, so they find no curvature either. One
/// such record, believed, took an eighth of its light from the whole ceiling, and a third at a smaller `cache.error`.
#include <gtest/gtest.h>

#include <pellucid/scene/scene.h>
#include <pellucid/transport/final_gather.h>

#include "../../src/study/check_scenes.h"

namespace pellucid {
namespace {

TEST(DarkRecords, SpeakNoFartherThanTheySee) {
    check::SceneBuilder b;
    b.box({0, 0, 0}, {2, 2, 2}, check::lambert(0.6F), true);
    b.square({1.0, 1.98, 1.0}, {0, -1, 0}, 0.2, check::lamp(15.0F));
    const Scene scene(b.description(), std::nullopt, SceneOptions{}, Workers(1));
    const TransportContext context{scene, {}, {}};
    const auto recordAt = [&](const glm::dvec3& metres) {
        GatherPoint point;
        point.valid = true;
        point.position = glm::vec3((metres - scene.normalisation().centre) * scene.normalisation().scale());
        point.normal = point.geometricNormal = point.unmappedNormal = {0, -1, 0};
        GatherOptions options{128, 0.0F, 1e6F, 1, CacheMetric::Hessian, scene.radius(), 0.3F};
        Walk walk(context);
        return gatherRecord(walk, point, options, 0);
    };
    const IrradianceRecord dark = recordAt({1.0, 2.0, 1.0}), lit = recordAt({0.4, 2.0, 0.4});
    EXPECT_LT(average(dark.irradiance), 0.05F * average(lit.irradiance));
    EXPECT_LE(dark.radius, 4.001F * dark.harmonicDistance);
    EXPECT_LT(dark.radius, 0.25F * lit.radius);
}

}  // namespace
}  // namespace pellucid

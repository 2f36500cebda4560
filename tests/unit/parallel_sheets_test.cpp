/// Two sheets that face the same way, 3 mm apart (a page over a table, lit from above), are two surfaces to the global map: no
/// photon of the page counts on the table below, and no place of the page answers for it.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/scene/scene.h>
#include <pellucid/transport/irradiance_cache.h>
#include <pellucid/transport/radiance_map.h>

#include "../../src/study/check_scenes.h"

namespace pellucid {
namespace {

constexpr double kApart = 0.003;

TEST(ParallelSheets, DoNotShareGlobalPhotons) {
    check::SceneBuilder b;
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, check::lambert(0.5F));
    b.quad({-1, kApart, 1}, {2, 0, 0}, {0, 0, -2}, check::lambert(0.5F));
    b.square({0, 1.5, 0}, {0, -1, 0}, 0.3, check::lamp(5.0F));
    const Scene scene(b.description(), std::nullopt, SceneOptions{}, Workers(1));
    const auto inScene = [&](double x, double y, double z) {
        return glm::vec3((glm::dvec3(x, y, z) - scene.normalisation().centre) * scene.normalisation().scale());
    };
    const glm::vec3 up(0.0F, 1.0F, 0.0F);
    std::vector<GlobalPhoton> photons;
    std::vector<GatherPoint> places;
    for (int i = 0; i < 40 * 40; ++i) {
        const double x = -0.5 + (i % 40 + 0.5) / 40.0, z = -0.5 + (i / 40 + 0.5) / 40.0;
        photons.push_back({{inScene(x, kApart, z), up, up, Rgb(1e-3F)}, Arrived::Otherwise});
        if (i % 4 != 0) continue;
        GatherPoint place;
        place.valid = true;
        place.position = inScene(x, i % 8 == 0 ? 0.0 : kApart, z);
        place.normal = place.geometricNormal = place.unmappedNormal = up;
        place.lobe.reflectance = Rgb(0.5F);
        places.push_back(place);
    }
    const RadianceMap map(scene, photons, places, RadianceMapOptions{}, Workers(1));
    for (const double x : {-0.2, 0.03, 0.31}) {
        const auto above = map.find(inScene(x, kApart, 0.011), up), below = map.find(inScene(x, 0.0, 0.011), up);
        ASSERT_TRUE(above);
        EXPECT_GT(above->irradiance.g, 0.1F);
        if (below) {
            EXPECT_EQ(below->irradiance.g, 0.0F) << x;
        }
    }
    EXPECT_TRUE(map.find(inScene(0.0, 0.0, 0.011), up)) << "the table has places of its own";
}

/// Nor does a record of the page speak for the table, or the table's for the page; along a bent sheet records go on speaking.
TEST(ParallelSheets, DoNotShareRecords) {
    Bounds bounds;
    bounds.extend(glm::vec3(-1.0F));
    bounds.extend(glm::vec3(1.0F));
    const glm::vec3 up(0.0F, 1.0F, 0.0F);
    IrradianceCache cache(bounds, 0.3F);
    IrradianceRecord record;
    record.normal = up;
    record.irradiance = Rgb(1.0F);
    record.radius = record.harmonicDistance = 0.4F;
    cache.insert(record);
    const auto apart = static_cast<float>(kApart);
    for (const float distance : {0.01F, 0.05F, 0.1F}) {
        EXPECT_TRUE(cache.lookup({distance, 0.0F, 0.0F}, up)) << distance;
        EXPECT_FALSE(cache.lookup({distance, -apart, 0.0F}, up)) << distance;
        EXPECT_FALSE(cache.lookup({distance, apart, 0.0F}, up)) << distance;
    }
    for (const float angle : {-0.15F, 0.1F, 0.15F}) {  // on a cylinder of radius 0.4 that stands out at the record
        const glm::vec3 normal(std::sin(angle), std::cos(angle), 0.0F);
        EXPECT_TRUE(cache.lookup(0.4F * (normal - up), normal)) << angle;
    }
}

}  // namespace
}  // namespace pellucid

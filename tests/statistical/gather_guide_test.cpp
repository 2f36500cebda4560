/// Gather rays by photons: a bright spot on the floor fills a twentieth of one stratum of a record on the ceiling. Photons that
/// came from it call more rays there, which must not change what a record means, and makes it far less noisy.
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include <pellucid/scene/scene.h>
#include <pellucid/transport/final_gather.h>
#include <pellucid/transport/photon_trace.h>

#include "../../src/study/check_scenes.h"
#include "agreement.h"

namespace pellucid {
namespace {

using namespace testing;

struct SpotRoom {
    Workers workers;
    Scene scene = build(workers);
    TransportContext context{scene, once(), {}};

    /// What gather rays meet is lit by the spot; no path goes on to meet it by chance.
    static TransportOptions once() {
        TransportOptions options;
        options.maxDepth = 1;
        return options;
    }
    static Scene build(const Workers& workers) {
        check::SceneBuilder b;
        b.box({0, 0, 0}, {2, 2, 2}, check::lambert(0.3F), true);
        b.description().lights.push_back(
            {"spot", PunctualKind::Spot, {0.5, 1.5, 0.5}, {0, -1, 0}, Rgb(30.0F), 0.03, 0.05});
        return {b.description(), std::nullopt, SceneOptions{}, workers};
    }
    [[nodiscard]] GatherPoint onCeiling() const {
        GatherPoint point;
        point.valid = true;
        const glm::dvec3 metres(1.2, 2.0, 1.1);
        point.position = glm::vec3((metres - scene.normalisation().centre) * scene.normalisation().scale());
        point.normal = point.geometricNormal = point.unmappedNormal = {0, -1, 0};
        return point;
    }
    [[nodiscard]] GatherGuide guide() const {
        return {traceGlobalPhotons(scene, {1, 1, 40'000}, workers).photons, 0.3F * scene.radius(), workers};
    }
    [[nodiscard]] MeanOfSeeds irradiance(const GatherGuide* guide, std::uint64_t seed) const {
        std::vector<double> values;
        for (std::uint64_t key = 0; key < 3000; ++key) {
            Walk walk(context);
            GatherOptions options{128, 0.0F, 1e6F, seed, CacheMetric::Hessian, scene.radius(), 0.3F};
            options.guide = guide;
            values.push_back(average(gatherRecord(walk, onCeiling(), options, key).irradiance));
        }
        return meanOfSeeds(values);
    }
};

TEST(GatherGuide, CallsRaysWhereThePhotonsCameFrom) {
    const SpotRoom room;
    GatherStrata strata;
    strata.elevations = 6, strata.azimuths = 20;
    const GatherPoint at = room.onCeiling();
    const Frame frame(at.unmappedNormal);
    const auto rays = room.guide().rays(at.position, frame, strata);
    const auto towardsSpot =
        static_cast<glm::vec3>(glm::normalize((glm::dvec3(0.5, 0.0, 0.5) - glm::dvec3(1.2, 2.0, 1.1))));
    const std::size_t spot = strata.containing(frame.toLocal(towardsSpot));
    EXPECT_GE(rays[spot], 16);
    EXPECT_LT(std::accumulate(rays.begin(), rays.end(), 0), 120 + 100) << "hardly any others";
    for (const std::uint8_t n : rays) EXPECT_GE(n, 1);
}

TEST(GatherGuide, SaysNothingWithoutPhotons) {
    const SpotRoom room;
    GatherStrata strata;
    strata.elevations = 6, strata.azimuths = 20;
    const GatherGuide none({}, 1.0F, room.workers);
    for (const std::uint8_t n : none.rays(room.onCeiling().position, Frame(glm::vec3(0, -1, 0)), strata))
        EXPECT_EQ(n, 1);
}

TEST(GatherGuide, StrataHoldTheirDirections) {
    GatherStrata strata;
    strata.elevations = 5, strata.azimuths = 16;
    for (int k = 0; k < strata.azimuths; ++k)
        for (int j = 0; j < strata.elevations; ++j) {
            const float sine = std::sqrt((static_cast<float>(j) + 0.5F) / 5.0F);
            const float phi = kTwoPi * (static_cast<float>(k) + 0.5F) / 16.0F;
            EXPECT_EQ(strata.containing({sine * std::cos(phi), sine * std::sin(phi), 0.1F}), strata.index(j, k));
            for (const glm::vec2 within : {glm::vec2(0.5F), glm::vec2(0.01F, 0.99F), glm::vec2(0.99F, 0.01F)})
                EXPECT_EQ(strata.containing(strata.direction(j, k, within)), strata.index(j, k));
        }
}

TEST(GatherGuide, KeepsTheMeanAndTakesTheNoise) {
    const SpotRoom room;
    const GatherGuide guide = room.guide();
    const MeanOfSeeds plain = room.irradiance(nullptr, 1), guided = room.irradiance(&guide, 2);
    EXPECT_GT(welch(plain, guided), sidakLevel(1)) << plain.mean << " and " << guided.mean;
    EXPECT_LT(guided.variance, 0.25 * plain.variance);
    RecordProperty("variance_ratio", std::to_string(guided.variance / plain.variance));
}

}  // namespace
}  // namespace pellucid

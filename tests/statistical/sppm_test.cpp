/// Stochastic progressive photon mapping: the energy of every class, the same bits at any number of threads and over a break,
/// and an error that falls with the iterations.
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "../support/same_bits.h"
#include "agreement.h"
#include "class_groups.h"
#include "small_scenes.h"

namespace pellucid {
namespace {

using namespace testing;
using test::expectSameBits;

[[nodiscard]] Scene made(const SmallScene& s, const Workers& workers) {
    return Scene(s.scene, s.environment, SceneOptions{}, workers);
}

class Sppm : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(Sppm, EveryClassHasItsEnergy) {
    const Workers workers;
    for (const SmallScene& small : {roughGlass(), smoothCasters()}) {
        const Scene scene = made(small, workers);
        Rendering reference{Method::Bdpt, 64, 6};
        reference.width = reference.height = 20;
        reference.layers = {"classes"};
        Rendering sppm = reference.by(Method::Sppm, 32, 700);
        setParameter(sppm.settings, GetParam().first, GetParam().second);
        expectSameEnergy(small.name, renderSeeds(scene, reference, workers), renderSeeds(scene, sppm, workers));
    }
}

INSTANTIATE_TEST_SUITE_P(Ways, Sppm,
                         ::testing::Values(std::pair{"photon.shrink", "alpha"}, std::pair{"photon.shrink", "chi2"},
                                           std::pair{"photon.chance", "on"}, std::pair{"photon.caustic_map", "off"}));

[[nodiscard]] RenderRequest request(Method method, std::uint32_t samples, const char* shrink) {
    RenderRequest r;
    r.method = method;
    r.width = r.height = 16;
    r.budget.samples = samples;
    r.layers = {"all"};
    setParameter(r.settings, "photon.shrink", shrink);
    setParameter(r.settings, "photon.global", "3000");
    setParameter(r.settings, "photon.caustic", "3000");
    setParameter(r.settings, "cache.rays", "32");
    return r;
}

/// Also of the photon method where a test shrinks its kernels.
TEST(SppmBits, AreTheSameAtAnyNumberOfThreadsAndOverABreak) {
    const SmallScene small = smoothCasters();
    const Workers one(1), three(3);
    const Scene scene = made(small, one);
    for (const auto& [method, shrink] :
         {std::pair{Method::Sppm, "alpha"}, std::pair{Method::Sppm, "chi2"}, std::pair{Method::Photon, "chi2"}}) {
        const Image alone = render(scene, request(method, 12, shrink), one).image;
        expectSameBits(alone, render(scene, request(method, 12, shrink), three).image);
        RenderRequest broken = request(method, 5, shrink);
        broken.checkpoint = std::filesystem::temp_directory_path() / ("pellucid-sppm-" + std::to_string(::getpid()));
        (void)render(scene, broken, three);
        broken.budget.samples = 12;
        broken.resume = true;
        const Image resumed = render(scene, broken, one).image;
        std::filesystem::remove(broken.checkpoint);
        expectSameBits(alone, resumed);
    }
}

TEST(SppmRecord, TellsOfBothPhotonPasses) {
    const SmallScene small = smoothCasters();
    const Workers workers;
    const Scene scene = made(small, workers);
    const RenderRecord record = render(scene, request(Method::Sppm, 3, "alpha"), workers).record;
    int found = 0;
    for (const StageRecord& stage : record.stages)
        if (stage.name == "caustic photons" || stage.name == "other photons") {
            ++found;
            EXPECT_EQ(stage.photonsEmitted, 9000U) << stage.name;
            EXPECT_GT(stage.photonsStored, 0U) << stage.name;
            EXPECT_NEAR(stage.energy.residual(), 0.0, 1e-6) << stage.name;
        }
    EXPECT_EQ(found, 2);
    EXPECT_EQ(record.resolved.cache, "off");
}

}  // namespace
}  // namespace pellucid

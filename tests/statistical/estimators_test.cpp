/// Every two unbiased estimators must mean the same image, and the gate that says so must see planted bugs.
#include <gtest/gtest.h>

#include "agreement.h"
#include "small_scenes.h"

namespace pellucid {
namespace {

using namespace testing;

Scene made(const SmallScene& s, const Workers& workers) { return Scene(s.scene, s.environment, SceneOptions{}, workers); }

class Estimators : public ::testing::TestWithParam<int> {};

TEST_P(Estimators, BidirectionalMeansWhatPathTracingMeans) {
    const SmallScene small = smallScenes()[static_cast<std::size_t>(GetParam())];
    const Workers workers;
    const Scene scene = made(small, workers);
    Rendering path{Method::Path, 64};
    path.settings = small.settings;
    path.width = path.height = 24;
    Rendering bdpt = path;
    bdpt.method = Method::Bdpt;
    bdpt.samples = 32;
    bdpt.firstSeed = 1000;
    const auto a = renderSeeds(scene, path, workers), b = renderSeeds(scene, bdpt, workers);
    for (const char* layer : {"", "emission", "direct", "caustic", "indirect"}) {
        const Agreement agreement = agreementOf(valuesOf(a, 2, layer), valuesOf(b, 2, layer));
        EXPECT_TRUE(agreement.holds(sidakLevel(35))) << small.name << ", " << (*layer == '\0' ? "all" : layer) << ": " << agreement;
        if (*layer == '\0') std::cout << small.name << ": " << agreement << "\n";
    }
}

INSTANTIATE_TEST_SUITE_P(SmallScenes, Estimators, ::testing::Range(0, 7));

}  // namespace
}  // namespace pellucid

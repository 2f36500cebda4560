/// How far a record may speak, in pixels, by what was asked and by how small the image is.
#include <gtest/gtest.h>

#include <pellucid/render/render.h>

#include "agreement.h"
#include "small_scenes.h"

namespace pellucid {
namespace {

using namespace testing;

/// The resolved spacings of a 64 x 32 image: least and most, in pixels.
[[nodiscard]] std::pair<double, double> spacings(double least, double most) {
    const Workers workers;
    const Scene scene(roomLitByItsCeiling(), std::nullopt, SceneOptions{}, workers);
    RenderRequest request;
    request.width = 64;
    request.height = 32;
    request.settings.minSpacing = least;
    request.settings.maxSpacing = most;
    const Settings resolved = planOnly(scene, request, workers).resolved;
    return {resolved.minSpacing, resolved.maxSpacing};
}

TEST(RecordSpacing, NoRecordSpeaksToMoreThanAnEighthOfASmallImage) {
    EXPECT_DOUBLE_EQ(spacings(-1.0, -1.0).second, 4.0) << "an eighth of the shorter side";
    EXPECT_DOUBLE_EQ(spacings(-1.0, 12.0).second, 12.0) << "but where it was asked to";
}

TEST(RecordSpacing, TheMostIsNeverLessThanTheLeast) {
    for (const double least : {6.0, 100.0}) {
        const auto [low, high] = spacings(least, -1.0);
        EXPECT_DOUBLE_EQ(low, least);
        EXPECT_GE(high, low);
    }
    EXPECT_GE(spacings(20.0, 10.0).second, 20.0);
}

}  // namespace
}  // namespace pellucid

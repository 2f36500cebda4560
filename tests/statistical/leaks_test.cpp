/// Light does not leak: a bright room beside a dark one behind a wall of 4 mm, a corner of three surfaces, a book on a table.
/// The first two are sealed: with the bright room's lamp alone not a photon gets to the dark side, so whatever arrives there
/// has leaked, and it is held against what the dark side's own lamp brings by path tracing. The book's shadow is held
/// against path tracing as it stands. Records lie much farther apart than the walls are thick.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>

#include "agreement.h"
#include "small_scenes.h"

namespace pellucid {
namespace {

using namespace testing;
using namespace testing::detail;

constexpr int kWidth = 40, kHeight = 20;
constexpr float kBright = 30.0F;       ///< radiance of the bright lamp; the dark side has one of 1
constexpr double kMostLeaked = 0.005;  ///< of the dark side's mean

/// Which of the two lamps shine.
enum class Lamps { Both, Bright, Dark };

/// A scene seen from above, with a bright and a dark side; `isDark` tells the dark one's points of the floor, in metres.
struct TwoSides {
    SceneDescription scene;
    std::function<bool(double x, double z)> isDark;
};

/// Four walls of 1 m and a ceiling, all facing inwards.
void addRoom(check::SceneBuilder& b, const glm::dvec2& lower, const glm::dvec2& upper, float reflectance) {
    const Material m = check::lambert(reflectance);
    const double x = upper.x - lower.x, z = upper.y - lower.y;
    b.quad({lower.x, 0, lower.y}, {x, 0, 0}, {0, 1, 0}, m);
    b.quad({lower.x, 0, upper.y}, {0, 1, 0}, {x, 0, 0}, m);
    b.quad({lower.x, 0, lower.y}, {0, 1, 0}, {0, 0, z}, m);
    b.quad({upper.x, 0, lower.y}, {0, 0, z}, {0, 1, 0}, m);
    b.quad({lower.x, 1, lower.y}, {x, 0, 0}, {0, 0, z}, m);
}

/// A floor that goes on below all walls, and the lamps.
[[nodiscard]] check::SceneBuilder floorAndLamps(const glm::dvec3& bright, const glm::dvec3& dark, Lamps lamps) {
    check::SceneBuilder b;
    b.quad({-1.1, 0, 0.6}, {2.2, 0, 0}, {0, 0, -1.2}, check::lambert(0.5F));
    if (lamps != Lamps::Dark) b.square(bright, {0, -1, 0}, 0.15, check::lamp(kBright));
    if (lamps != Lamps::Bright) b.square(dark, {0, -1, 0}, 0.15, check::lamp(1.0F));
    b.view({0, 0, 0}, {0, 1, 0}, 2.0, 0.5);
    return b;
}

/// A wall of 4 mm from side to side and from floor to ceiling. Its dark face lies on a border of pixels.
[[nodiscard]] TwoSides thinWall(Lamps lamps) {
    check::SceneBuilder b = floorAndLamps({-0.5, 0.9, 0.0}, {0.5, 0.9, 0.0}, lamps);
    addRoom(b, {-1.0, -0.5}, {1.0, 0.5}, 0.6F);
    b.box({-0.004, -0.01, -0.51}, {0.0, 1.01, 0.51}, check::lambert(0.6F));
    return {b.description(), [](double x, double) { return x > 0.0; }};
}

/// A dark closet in one corner of a bright room: floor and two walls of 4 mm meet.
[[nodiscard]] TwoSides closet(Lamps lamps) {
    check::SceneBuilder b = floorAndLamps({-0.4, 0.9, 0.0}, {0.65, 0.9, -0.1}, lamps);
    addRoom(b, {-1.0, -0.5}, {1.0, 0.5}, 0.6F);
    b.box({0.296, -0.01, -0.51}, {0.3, 1.01, 0.304}, check::lambert(0.6F));
    b.box({0.297, -0.01, 0.3}, {1.01, 1.01, 0.304}, check::lambert(0.6F));
    return {b.description(), [](double x, double z) { return x > 0.3 && z < 0.3; }};
}

/// A book of 2 cm stands on a table; a lamp before it lights the table there and a wall, and behind it lies its shadow.
[[nodiscard]] TwoSides book() {
    check::SceneBuilder b;
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, check::lambert(0.5F));
    addRoom(b, {-1, -1}, {1, 1}, 0.5F);
    b.box({-0.01, 0.0, -0.3}, {0.01, 0.25, 0.3}, check::lambert(0.5F));
    b.square({-0.5, 0.95, 0.0}, {0, -1, 0}, 0.4, check::lamp(3.0F));
    b.view({0, 0, 0}, {0, 1, 0}, 0.6, 0.6);
    return {b.description(), [](double x, double z) { return x > 0.02 && x < 0.12 && std::fabs(z) < 0.1; }};
}

/// Mean of the indirect light of the dark pixels, by seed.
[[nodiscard]] MeanOfSeeds darkMean(const TwoSides& what, const Scene& scene, const Rendering& rendering,
                                   const Workers& workers) {
    std::vector<double> means;
    const Camera camera = scene.camera("", kWidth, kHeight);
    for (const Image& image : renderSeeds(scene, rendering, workers)) {
        const int channel = image.channel("indirect.G");
        double sum = 0.0, count = 0.0;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                const Ray ray =
                    camera.ray({static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F}, {0.5F, 0.5F}).ray;
                const glm::dvec3 at =
                    glm::dvec3(ray.origin) / scene.normalisation().scale() + scene.normalisation().centre;
                if (!what.isDark(at.x, at.z)) continue;
                sum += static_cast<double>(image.at(static_cast<std::size_t>(y * image.width() + x), channel));
                count += 1.0;
            }
        means.push_back(sum / count);
    }
    return meanOfSeeds(means);
}

/// Far-reaching records: what speaks for 12 pixels of 5 cm must not speak through 4 mm.
[[nodiscard]] Settings farReaching(const std::string& metric) {
    Settings s;
    s.cache = "on";
    s.cacheMetric = metric;
    s.minSpacing = 2.0;
    s.maxSpacing = 12.0;
    s.rouletteThreshold = 0.1;
    return s;
}

/// What leaks from the bright lamp alone, as a share of what the dark lamp brings.
void expectNoLeak(const std::function<TwoSides(Lamps)>& what, Settings settings) {
    const Workers workers(2);
    const TwoSides bright = what(Lamps::Bright), dark = what(Lamps::Dark);
    const Scene leaking(bright.scene, std::nullopt, SceneOptions{}, workers),
        own(dark.scene, std::nullopt, SceneOptions{}, workers);
    const MeanOfSeeds truth = darkMean(dark, own, {Method::Path, 128, 4, 100, settings, kWidth, kHeight}, workers);
    for (const int globalPhotons :
         {0, 75'000}) {  // what records leak alone, and with what the global map leaks to them
        settings.globalPhotons = globalPhotons;
        const MeanOfSeeds leaked =
            darkMean(bright, leaking, {Method::Photon, 2, 4, 1, settings, kWidth, kHeight}, workers);
        EXPECT_LT((leaked.mean + 3.0 * std::sqrt(leaked.variance)) / truth.mean, kMostLeaked) << globalPhotons;
    }
    EXPECT_LT(std::sqrt(truth.variance), 0.05 * truth.mean);
}

class Leaks : public ::testing::TestWithParam<const char*> {};

TEST_P(Leaks, ThroughAWallOfFourMillimetres) { expectNoLeak(thinWall, farReaching(GetParam())); }
TEST_P(Leaks, InACornerOfThreeSurfaces) { expectNoLeak(closet, farReaching(GetParam())); }

INSTANTIATE_TEST_SUITE_P(ByMetric, Leaks, ::testing::Values("ward", "tabellion", "hessian"),
                         [](const auto& test) { return std::string(test.param); });

/// The shadow's mean is that of path tracing: what the table before the book holds is some times as bright.
TEST(Leaking, BehindABookOnATable) {
    const Workers workers(2);
    const TwoSides what = book();
    const Scene scene(what.scene, std::nullopt, SceneOptions{}, workers);
    Settings settings = farReaching("hessian");
    settings.gatherRays = 1024;
    const MeanOfSeeds truth = darkMean(what, scene, {Method::Path, 512, 8, 100, settings, kWidth, kHeight}, workers),
                      found = darkMean(what, scene, {Method::Photon, 2, 10, 1, settings, kWidth, kHeight}, workers);
    const double share = found.mean / truth.mean - 1.0, error = std::sqrt(found.variance + truth.variance) / truth.mean;
    EXPECT_LT(error, kMostLeaked) << "too noisy to tell";
    EXPECT_LT(share, kMostLeaked + 2.0 * error) << "+- " << error;
}

}  // namespace
}  // namespace pellucid

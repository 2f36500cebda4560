/// Images made by another renderer from the same triangles (../shared/scenes): the mean agrees within half a percent and
/// every 16 x 16 block within its error bar. And class by class, photons against the reference, on all scenes at hand.
#include <cmath>
#include <filesystem>
#include <iostream>

#include <gtest/gtest.h>

#include <pellucid/io/gltf.h>
#include <pellucid/io/image_file.h>

#include "../../src/render/plan_parts.h"
#include "../statistical/class_groups.h"
#include "../statistical/small_scenes.h"

namespace pellucid {
namespace {

using namespace testing;

const std::filesystem::path kShared = PELLUCID_SHARED_SCENES,
                            kOwn = std::filesystem::path(PELLUCID_SOURCE_DIR) / "scenes";

struct Witness {
    const char* name;
    Method method;
    std::uint32_t samples;
    double blockBias;  ///< what the witness itself may be off by in a block: photon-mapped ones blur
};

/// Variance of a block's mean by the noise of its pixels: the mask of second differences that is blind to slopes.
/// [Immerkaer1996]
double noiseOfBlock(const Image& image, int x0, int y0, int block) {
    constexpr int kMask[3][3] = {{1, -2, 1}, {-2, 4, -2}, {1, -2, 1}};
    double sum = 0.0;
    int count = 0;
    for (int y = y0 + 1; y < y0 + block - 1; ++y)
        for (int x = x0 + 1; x < x0 + block - 1; ++x, ++count) {
            double v = 0.0;
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i) {
                    const auto at = static_cast<std::size_t>((y + j) * image.width() + x + i);
                    v += kMask[j + 1][i + 1] * static_cast<double>(average(Rgb(image.at(at, image.channel("R")),
                                                                               image.at(at, image.channel("G")),
                                                                               image.at(at, image.channel("B")))));
                }
            sum += v * v;
        }
    return sum / (36.0 * count) / (block * block);
}

class Witnesses : public ::testing::TestWithParam<Witness> {};

TEST_P(Witnesses, MeanAndBlocksAgree) {
    const Witness w = GetParam();
    const std::filesystem::path folder = kShared / "generated", scenePath = folder / (std::string(w.name) + ".glb");
    if (!std::filesystem::exists(scenePath)) GTEST_SKIP() << "no ../shared/scenes";
    const Image reference = readImage(folder / (std::string(w.name) + ".ref.exr"));
    const Workers workers;
    const Scene scene(loadGltf(scenePath), std::nullopt, SceneOptions{}, workers);
    Rendering what{w.method, w.samples, 6};
    what.width = reference.width();
    what.height = reference.height();
    if (w.method != Method::Bdpt) setParameter(what.settings, "path.split", "on");  // glints of the lamp in the pool
    constexpr int kBlock = 16;
    const SeedValues ours = valuesOf(renderSeeds(scene, what, workers), kBlock);
    const std::vector<double> theirs = blockMeans(reference, kBlock);
    const MeanOfSeeds whole = imageOverSeeds(ours);
    double mean = 0.0;
    for (const double v : theirs) mean += v / static_cast<double>(theirs.size());
    std::cout << w.name << ": bias " << whole.mean / mean - 1.0 << " +- " << std::sqrt(whole.variance) / mean << "\n";
    EXPECT_NEAR(whole.mean / mean, 1.0, 0.005 + 3.0 * std::sqrt(whole.variance) / mean);
    const int columns = (reference.width() + kBlock - 1) / kBlock;
    int outside = 0;
    for (std::size_t i = 0; i < theirs.size(); ++i) {
        const int x0 = static_cast<int>(i) % columns * kBlock, y0 = static_cast<int>(i) / columns * kBlock;
        const MeanOfSeeds cell = cellOverSeeds(ours, i);
        // Student's t with 5 degrees of freedom: 9.7 leaves one block in ten thousand outside.
        const double bar = 9.7 * std::sqrt(cell.variance) + 4.0 * std::sqrt(noiseOfBlock(reference, x0, y0, kBlock)) +
                           w.blockBias * theirs[i] + 1e-4 * mean;
        if (std::fabs(cell.mean - theirs[i]) <= bar) continue;
        ++outside;
        std::cout << "  block at " << x0 << "," << y0 << ": " << cell.mean << " for " << theirs[i] << ", bar " << bar
                  << "\n";
    }
    EXPECT_EQ(outside, 0) << w.name;
}

// Not bidirectional paths on ring and goblet: caustics that are seen in the ring or through the glass (E S+ D S+ L) they meet by
// chance alone, too seldom for six seeds to tell how far off they are.
INSTANTIATE_TEST_SUITE_P(
    Shared, Witnesses,
    ::testing::Values(Witness{"cornell-boxes", Method::Path, 24, 0.0}, Witness{"cornell-boxes", Method::Bdpt, 12, 0.0},
                      Witness{"corridor", Method::Bdpt, 24, 0.0}, Witness{"cornell-glass", Method::Reference, 24, 0.02},
                      Witness{"cornell-glass", Method::Bdpt, 24, 0.02}, Witness{"ring", Method::Reference, 24, 0.02},
                      Witness{"pool", Method::Reference, 24, 0.02}, Witness{"goblet", Method::Reference, 24, 0.02},
                      Witness{"peer-box", Method::Reference, 8, 0.01}),
    [](const auto& w) {
        std::string name = w.param.name;
        name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
        return name + (w.param.method == Method::Path ? "Path" : w.param.method == Method::Bdpt ? "Bdpt" : "Reference");
    });

class Ledger : public ::testing::TestWithParam<std::string> {};

TEST_P(Ledger, PhotonsAgreeWithTheReferenceClassByClass) {
    const std::filesystem::path own = kOwn / (GetParam() + ".glb"),
                                shared = kShared / "generated" / (GetParam() + ".glb");
    const std::filesystem::path file = std::filesystem::exists(own) ? own : shared;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no ../shared/scenes";
    const Workers workers;
    const Scene scene(loadGltf(file), std::nullopt, SceneOptions{}, workers);
    Rendering reference{Method::Reference, 96, 6};
    reference.width = reference.height = 40;
    reference.layers = {"classes"};
    Rendering photon = reference.by(Method::Photon, 12, 900);
    expectSameEnergy(GetParam(), renderSeeds(scene, reference, workers), renderSeeds(scene, photon, workers));
}

INSTANTIATE_TEST_SUITE_P(AllScenes, Ledger,
                         ::testing::Values("corner-open", "diffuse-room", "glass-and-mirror", "goblet", "lens-point",
                                           "many-lamps", "pool", "prism-spot", "ring", "rough-metal", "textured",
                                           "two-rooms", "cornell-glass", "cornell-boxes", "peer-box"),
                         [](const auto& name) {
                             std::string text = name.param;
                             text.erase(std::remove(text.begin(), text.end(), '-'), text.end());
                             return text;
                         });

}  // namespace
}  // namespace pellucid

/// Near the edge of a table and at the foot of a wall a kernel loses light: the dark rim without `photon.edges`, and with it none.
#include <iostream>

#include <gtest/gtest.h>

#include <pellucid/math/constants.h>
#include <pellucid/transport/kernel_mass.h>

#include "agreement.h"

#include "../../src/study/check_scenes.h"

namespace pellucid {
namespace {

using namespace testing;

/// A table top under a point lamp beside a mirror; a wall stands on it. All light of class E D S L is that of the lamp's image.
[[nodiscard]] SceneDescription table() {
    check::SceneBuilder b;
    b.quad({-1, -0.3, 0}, {1.99, 0, 0}, {0, 0.6, 0}, check::lambert(0.5F));
    b.quad({-0.2, -0.3, 0}, {0, 0.6, 0}, {0, 0, 0.4}, check::lambert(0.5F));  // its back to the mirror's side: +x
    b.quad({1, -2, -1}, {0, 0, 4}, {0, 4, 0}, check::mirror(1.0F));
    b.point({0.2, 0.0, 0.8}, 1.0);
    b.view({0.1, 0.0, 0.0}, {0, 0, 1}, 0.8, 0.25);
    return b.description();
}

TEST(KernelMass, IsOneInTheOpenOneHalfAtAnEdgeAndAtAWall) {
    const Workers workers;
    const Scene scene(table(), std::nullopt, SceneOptions{}, workers);
    const auto mass = [&](const glm::dvec3& metres, PhotonKernel kernel) {
        const Normalisation& n = scene.normalisation();
        double sum = 0.0;
        std::uint64_t rays = 0;
        for (int i = 0; i < 64; ++i)
            sum += static_cast<double>(kernelMass(scene, glm::vec3((metres - n.centre) * n.scale()), {0, 0, 1},
                                                  static_cast<float>(0.1 * n.scale()), kernel,
                                                  static_cast<float>(i) / 64.0F, rays));
        return sum / 64.0;
    };
    for (const PhotonKernel kernel :
         {PhotonKernel::Epanechnikov, PhotonKernel::Uniform, PhotonKernel::Cone, PhotonKernel::Biweight}) {
        EXPECT_NEAR(mass({0.3, 0.0, 0.0}, kernel), 1.0, 1e-6);
        EXPECT_NEAR(mass({0.3, 0.29999, 0.0}, kernel), 0.5, 0.03);
        EXPECT_NEAR(mass({-0.19999, 0.0, 0.0}, kernel), 0.5, 0.03);
        EXPECT_NEAR(mass({-0.19999, 0.29999, 0.0}, kernel), 0.25, 0.03);
    }
    // Epanechnikov's share of a disc up to a chord at half its radius: 1/2 + 8 / (3 pi) int_0^(1/2) (1 - x^2)^(3/2) dx.
    EXPECT_NEAR(mass({0.3, 0.25, 0.0}, PhotonKernel::Epanechnikov), 0.8734, 0.02);
}

/// Mean of the caustic over rows next to the table's edge against closed form, by `photon.edges`.
TEST(KernelMass, TakesTheDarkRimAway) {
    const Workers workers;
    const Scene scene(table(), std::nullopt, SceneOptions{}, workers);
    constexpr int kSize = 32;
    const auto rim = [&](const char* edges, Method method) {
        Rendering what{method, 8, 4};
        what.width = what.height = kSize;
        for (const auto& [name, value] :
             {std::pair{"photon.edges", edges}, std::pair{"photon.radius", "4"}, std::pair{"photon.alpha", "1"},
              std::pair{"photon.caustic", "30000"}, std::pair{"photon.global", "100"}, std::pair{"cache.mode", "off"}})
            setParameter(what.settings, name, value);
        double sum = 0.0, expected = 0.0;
        for (const Image& image : renderSeeds(scene, what, workers))
            for (int y = 0; y < kSize; ++y)
                for (int x = 10; x < kSize - 2; ++x) {
                    // Pixels of 0.025 m; the image shows x from -0.3 to 0.5 and y from 0.4 down to -0.4.
                    const double px = -0.3 + 0.025 * (x + 0.5), py = 0.4 - 0.025 * (y + 0.5);
                    if (std::fabs(py) > 0.3 || std::fabs(py) < 0.25) continue;  // within two pixels of the edge
                    const glm::dvec3 to = glm::dvec3(1.8, 0.0, 0.8) - glm::dvec3(px, py, 0.0);
                    const double d2 = glm::dot(to, to);
                    expected += 0.5 / kPiD * to.z / (d2 * std::sqrt(d2));
                    sum += static_cast<double>(
                        image.at(static_cast<std::size_t>(y * kSize + x), image.channel("caustic.G")));
                }
        std::cout << "rim with photon.edges=" << edges << ": " << sum / expected << " of what it must be\n";
        return sum / expected;
    };
    EXPECT_LT(rim("off", Method::Photon), 0.85);
    EXPECT_NEAR(rim("on", Method::Photon), 1.0, 0.04);
    EXPECT_NEAR(rim("on", Method::Sppm), 1.0, 0.04);
}

}  // namespace
}  // namespace pellucid

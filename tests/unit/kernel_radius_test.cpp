/// The radii of caustic kernels: wide in even light, and not over an edge.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/math/sampler.h>
#include <pellucid/transport/kernel_radius.h>

namespace pellucid {
namespace {

constexpr int kSize = 48;  ///< pixels a side, of one scene unit each

/// A floor seen from above, at a pixel's middle each.
[[nodiscard]] std::vector<GatherPoint> floorPoints() {
    std::vector<GatherPoint> points(kSize * kSize);
    for (int i = 0; i < kSize * kSize; ++i) {
        GatherPoint& p = points[static_cast<std::size_t>(i)];
        p.valid = true;
        p.position = {static_cast<float>(i % kSize) + 0.5F, 0.0F, static_cast<float>(i / kSize) + 0.5F};
        p.normal = p.geometricNormal = {0.0F, 1.0F, 0.0F};
        p.footprint = 1.0F;
    }
    return points;
}

/// `perPixel` photons where `lit` says so.
template <class Lit>
[[nodiscard]] CausticMap mapOf(double perPixel, std::uint64_t seed, const Lit& lit) {
    PhotonList photons;
    const auto count = static_cast<std::uint64_t>(perPixel * kSize * kSize);
    for (std::uint64_t i = 0; i < count; ++i) {
        Sampler sampler(seed, i, 0);
        const glm::vec2 at = static_cast<float>(kSize) * sampler.next2D();
        if (!lit(at)) continue;
        Photon photon;
        photon.position = {at.x, 0.0F, at.y};
        photon.wi = photon.normal = {0.0F, 1.0F, 0.0F};
        photon.flux = Rgb(1.0F);
        photons.push_back(photon);
    }
    return CausticMap(std::move(photons));
}

/// A focus of three pixels in the dark: nearly all neighbours of a dark pixel beside it would speak for wide kernels.
TEST(KernelRadii, DoNotReachOverTheEdgeOfASmallFocus) {
    const Workers workers;
    const glm::vec2 middle(24.0F, 24.0F);
    constexpr float kFocus = 1.5F;
    KernelRadii radii(kSize, kSize, {});
    for (std::uint64_t pass = 0; pass < 3; ++pass)
        radii.learn(mapOf(40.0, pass, [&](const glm::vec2& at) { return glm::length(at - middle) < kFocus; }),
                    floorPoints(), workers);
    for (int y = 12; y < 36; ++y)
        for (int x = 12; x < 36; ++x) {
            // From where a sample of the pixel lies next to it.
            const glm::vec2 nearest = glm::clamp(middle, glm::vec2(x, y), glm::vec2(x + 1, y + 1));
            const float away = glm::length(nearest - middle) - kFocus;
            if (away <= 1.0F) continue;
            EXPECT_LT(radii.at(x, y), away + 0.8F) << x << ", " << y;
        }
}

/// What chance alone ends does not count as an edge.
TEST(KernelRadii, AreWideInEvenLight) {
    const Workers workers;
    KernelRadii radii(kSize, kSize, {});
    for (std::uint64_t pass = 0; pass < 3; ++pass)
        radii.learn(mapOf(1.0, pass, [](const glm::vec2&) { return true; }), floorPoints(), workers);
    double mean = 0.0;
    int count = 0;
    for (int y = 12; y < 36; ++y)
        for (int x = 12; x < 36; ++x) mean += std::log(static_cast<double>(radii.at(x, y))), ++count;
    // 60 photons lie within 4.4 pixels; steps of 1.4 from 0.7 reach 5.3.
    EXPECT_GT(std::exp(mean / count), 3.3);
}

}  // namespace
}  // namespace pellucid

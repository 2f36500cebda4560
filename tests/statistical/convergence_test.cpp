/// The error of progressive photon mapping falls with the slope that theory gives, and the gate that says so sees a radius that
/// does not shrink.
#include <iostream>

#include <gtest/gtest.h>

#include <pellucid/study/convergence.h>

namespace pellucid {
namespace {

TEST(Convergence, ShrinkingRadiiFallByTwoThirds) {
    const Workers workers;
    ConvergenceOptions options{{8, 64, 512},
                               4,
                               {{"photon", Method::Photon, {}},
                                {"sppm", Method::Sppm, {}},
                                {"chi2", Method::Sppm, {{"photon.shrink", "chi2"}}},
                                {"fixed", Method::Photon, {{"photon.alpha", "1"}}}}};
    const std::vector<ConvergenceCurve> curves = measureConvergence({workers, 1}, options);
    std::cout << convergenceTable(curves);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_LT(curves[i].slope.low, -2.0 / 3.0 + 0.07) << curves[i].label;
        EXPECT_GT(curves[i].slope.high, -2.0 / 3.0 - 0.07) << curves[i].label;
    }
    EXPECT_LT(curves[2].slope.value, -0.5);
    // A radius that stays has a bias that stays: over the last factor of eight it gains less than half of what is due.
    const auto gain = [&](std::size_t i) { return curves[i].relmse[1] / curves[i].relmse[2]; };
    EXPECT_GT(gain(0), 3.0);
    EXPECT_LT(gain(3), 2.5);
}

}  // namespace
}  // namespace pellucid

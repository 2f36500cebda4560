/// The kernels of the caustic map: their integrals and moments in closed form, an even field of photons, and the map's own
/// estimate of its bias on a field of which the bias is known.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <pellucid/math/constants.h>
#include <pellucid/transport/caustic_map.h>

namespace pellucid {
namespace {

using namespace kernel_shape;

struct Moments {
    double mass = 0.0, second = 0.0,
           square = 0.0;  ///< int K dA, int K x^2 dA, pi int K^2 dA over the unit disc, K / pi the density
};

template <class Shape>
[[nodiscard]] Moments moments() {
    constexpr int kSteps = 20000;
    Moments m;
    for (int i = 0; i < kSteps; ++i) {
        const double r = (i + 0.5) / kSteps,
                     k = static_cast<double>(Shape::kScale * Shape::shape(static_cast<float>(r * r)));
        const double dt = 2.0 * r / kSteps;
        m.mass += k * dt;
        m.second += k * 0.5 * r * r * dt;
        m.square += k * k * dt;
    }
    return m;
}

TEST(PhotonKernel, MassAndMomentsInClosedForm) {
    const auto expect = [](const Moments& m, double second, double square) {
        EXPECT_NEAR(m.mass, 1.0, 1e-5);
        EXPECT_NEAR(m.second, second, 1e-5);
        EXPECT_NEAR(m.square, square, 1e-5);
    };
    expect(moments<Epanechnikov>(), 1.0 / 6.0, 4.0 / 3.0);
    expect(moments<Uniform>(), 1.0 / 4.0, 1.0);
    expect(moments<Cone>(), 3.0 / 20.0, 3.0 / 2.0);
    expect(moments<Biweight>(), 1.0 / 8.0, 9.0 / 5.0);
}

TEST(PhotonKernel, PhotonsWantedIsTheSquareOfTheRatioOfOptimalRadii) {
    EXPECT_DOUBLE_EQ(photonsWanted(PhotonKernel::Epanechnikov), 1.0);
    EXPECT_NEAR(photonsWanted(PhotonKernel::Uniform), 0.6934, 1e-3);
    EXPECT_NEAR(photonsWanted(PhotonKernel::Cone), 1.1157, 1e-3);
    EXPECT_NEAR(photonsWanted(PhotonKernel::Biweight), 1.3389, 1e-3);
}

/// Photons on a fine lattice in z = 0 with the flux of their cells under the irradiance 2 + c x^2.
[[nodiscard]] CausticMap field(PhotonKernel kernel, float curvature) {
    constexpr int kHalf = 150;
    constexpr float kStep = 0.008F;
    PhotonList photons;
    for (int y = -kHalf; y <= kHalf; ++y)
        for (int x = -kHalf; x <= kHalf; ++x) {
            Photon p;
            p.position = {static_cast<float>(x) * kStep, static_cast<float>(y) * kStep, 0.0F};
            p.wi = p.normal = {0.0F, 0.0F, 1.0F};
            p.flux = Rgb(kStep * kStep * (2.0F + curvature * p.position.x * p.position.x));
            photons.push_back(p);
        }
    return CausticMap(std::move(photons), kernel);
}

class Kernels : public ::testing::TestWithParam<std::pair<PhotonKernel, double>> {};

TEST_P(Kernels, AnEvenFieldIsEvenAndWithoutBias) {
    const CausticMap map = field(GetParam().first, 0.0F);
    const glm::vec3 up(0.0F, 0.0F, 1.0F);
    for (const float radius : {0.3F, 0.7F}) {
        const DiffuseLobe lobe{Rgb(1.0F)};
        const PhotonEstimate e = map.estimate({{0.013F, -0.021F, 0.0F}, up, up, lobe, radius});
        EXPECT_NEAR(e.photons, kPiD * static_cast<double>(radius * radius) / (0.008 * 0.008), 100.0);
        EXPECT_NEAR(e.irradiance.g, 2.0F, 0.008F) << radius;
        EXPECT_NEAR(e.blur, 0.0F, 0.03F) << radius;
    }
}

TEST_P(Kernels, BiasOfACurvedFieldAndItsEstimateAreTheSecondMoment) {
    constexpr float kCurvature = 3.0F, kRadius = 0.8F;
    const CausticMap map = field(GetParam().first, kCurvature);
    const glm::vec3 up(0.0F, 0.0F, 1.0F);
    const double bias = static_cast<double>(kCurvature * kRadius * kRadius) * GetParam().second;
    const DiffuseLobe lobe{Rgb(1.0F)};
    const PhotonEstimate e = map.estimate({{0.0F, 0.0F, 0.0F}, up, up, lobe, kRadius});
    EXPECT_NEAR(static_cast<double>(e.irradiance.g) - 2.0, bias, 0.03 * bias);
    EXPECT_NEAR(static_cast<double>(e.blur), bias, 0.08 * bias);
}

INSTANTIATE_TEST_SUITE_P(All, Kernels,
                         ::testing::Values(std::pair{PhotonKernel::Epanechnikov, 1.0 / 6.0},
                                           std::pair{PhotonKernel::Uniform, 1.0 / 4.0},
                                           std::pair{PhotonKernel::Cone, 3.0 / 20.0},
                                           std::pair{PhotonKernel::Biweight, 1.0 / 8.0}));

}  // namespace
}  // namespace pellucid

/// What a photon map keeps of a photon: power without bias, directions within a degree.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <pellucid/transport/caustic_map.h>

#include "../../src/transport/packed_photon.h"

namespace pellucid {
namespace {

/// The same power ten thousand times: a rounding that always went the same way would show.
TEST(PackedPhoton, PowerHasNoBias) {
    for (const Rgb& flux :
         {Rgb(1.0F, 0.3F, 0.001F), Rgb(3.1e-9F, 2.9e-9F, 0.0F), Rgb(0.9999999F), Rgb(7e20F, 1.0F, 2e18F)}) {
        glm::dvec3 sum(0.0);
        constexpr int kTimes = 10'000;
        for (std::uint64_t i = 0; i < kTimes; ++i) {
            const Rgb v = PackedFlux(flux, i).value();
            sum += glm::dvec3(v);
            for (glm::length_t c = 0; c < 3; ++c)
                EXPECT_LE(std::fabs(v[c] - flux[c]), std::max({flux.r, flux.g, flux.b}) / 127.0F);
        }
        // A step is 1/127 of the largest colour at most, its standard deviation at most half of that.
        const double step = static_cast<double>(std::max({flux.r, flux.g, flux.b})) / 127.0;
        for (glm::length_t c = 0; c < 3; ++c)
            EXPECT_NEAR(sum[c] / kTimes, static_cast<double>(flux[c]), 4.0 * 0.5 * step / std::sqrt(kTimes)) << c;
    }
    EXPECT_TRUE(isBlack(PackedFlux(Rgb(0.0F), 1).value()));
}

TEST(PackedPhoton, DirectionsAreWithinADegreeAndTheAxesExact) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    double worst = 1.0;
    for (int i = 0; i < 20'000; ++i) {
        const glm::vec3 v = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
        const OctahedralVector packed(v);
        worst = std::min(worst, static_cast<double>(glm::dot(packed.unit(), v)));
        EXPECT_GT(glm::length(packed.direction()), 0.56F);
    }
    EXPECT_GT(worst, std::cos(1.0 * 3.14159265 / 180.0));
    for (const float sign : {-1.0F, 1.0F})
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 v(0.0F);
            v[axis] = sign;
            EXPECT_EQ(glm::dot(OctahedralVector(v).unit(), v), 1.0F) << axis;
        }
}

TEST(PackedPhoton, AMapOfManyTreesIsTheMapOfOne) {
    std::mt19937 random(6);
    std::uniform_real_distribution<float> u(0.0F, 1.0F);
    PhotonList photons(200'000);
    for (Photon& p : photons) {
        p.position = {u(random), u(random), 0.0F};
        p.wi = p.normal = {0.0F, 0.0F, 1.0F};
        p.flux = Rgb(u(random) * 1e-5F);
    }
    const Workers workers(3);
    const CausticMap one(photons), many(photons, PhotonKernel::Epanechnikov, &workers);
    const glm::vec3 up(0.0F, 0.0F, 1.0F);
    const DiffuseLobe lobe{Rgb(1.0F)};
    for (int i = 0; i < 300; ++i) {
        const glm::vec3 at(u(random), u(random), 0.0F);
        const PhotonEstimate a = one.estimate({at, up, up, lobe, 0.02F}), b = many.estimate({at, up, up, lobe, 0.02F});
        EXPECT_EQ(a.photons, b.photons);
        EXPECT_NEAR(a.irradiance.g, b.irradiance.g, 1e-5F * a.irradiance.g);
    }
}

}  // namespace
}  // namespace pellucid

/// Conventions of the camera, its two mappings against each other, and light tracing through project() against a closed
/// form: a Lambertian plane of irradiance E shows E rho / pi in every pixel, whatever the lens.
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <pellucid/math/constants.h>
#include <pellucid/scene/camera.h>

namespace pellucid {
namespace {

class Numbers {
public:
    explicit Numbers(unsigned seed) : engine_(seed) {}
    float one() { return std::uniform_real_distribution<float>(0.0F, kOneMinusEpsilon)(engine_); }
    glm::vec2 two() { return {one(), one()}; }

private:
    std::mt19937 engine_;
};

CameraSpec turnedSpec(bool orthographic) {
    CameraSpec spec;
    spec.orthographic = orthographic;
    spec.verticalFov = 0.9;
    spec.ymag = 0.7;
    spec.toWorld = glm::translate(glm::dmat4(1.0), {0.3, -0.2, 0.9}) *
                   glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(0.2, 1.0, -0.4))) *
                   glm::scale(glm::dmat4(1.0), {3.0, 0.5, 2.0});
    return spec;
}

std::vector<Camera> someCameras() {
    std::vector<Camera> cameras;
    for (const bool orthographic : {false, true})
        for (const double aperture : {0.0, 0.3}) cameras.emplace_back(turnedSpec(orthographic), 6, 4, aperture, 1.7);
    return cameras;
}

TEST(Camera, LooksAlongMinusZWithTheFirstPixelUpperLeft) {
    const Camera camera(CameraSpec{}, 200, 100);
    const glm::vec3 middle = camera.ray({100.0F, 50.0F}, {0.5F, 0.5F}).ray.direction;
    EXPECT_NEAR(middle.z, -1.0F, 1e-6F);
    const glm::vec3 corner = camera.ray({0.0F, 0.0F}, {0.5F, 0.5F}).ray.direction;
    EXPECT_NEAR(corner.y / -corner.z, std::tan(0.4F), 1e-6F);          // vertical field of view 0.8
    EXPECT_NEAR(corner.x / -corner.z, -2.0F * std::tan(0.4F), 1e-6F);  // square pixels
}

TEST(Camera, ScaleOfTheNodeDoesNotMatterAndMirroringDoes) {
    CameraSpec spec = turnedSpec(false);
    const Camera scaled(spec, 30, 20);
    spec.toWorld *= glm::scale(glm::dmat4(1.0), {0.01, 7.0, 1e-5});
    const Camera rescaled(spec, 30, 20);
    spec.toWorld *= glm::scale(glm::dmat4(1.0), {-1.0, 1.0, 1.0});
    const Camera mirrored(spec, 30, 20);
    const glm::vec2 film(3.0F, 4.0F), lens(0.5F);
    EXPECT_LT(glm::length(scaled.ray(film, lens).ray.direction - rescaled.ray(film, lens).ray.direction), 1e-6F);
    EXPECT_LT(glm::length(scaled.ray(film, lens).ray.direction - mirrored.ray({27.0F, 4.0F}, lens).ray.direction),
              1e-6F);
}

TEST(Camera, NodeScaledToNothingStillMakesFiniteRays) {
    CameraSpec spec;
    spec.toWorld = glm::scale(glm::dmat4(1.0), glm::dvec3(0.0));
    const CameraRay ray = Camera(spec, 8, 8).ray({1.0F, 2.0F}, {0.1F, 0.9F});
    EXPECT_NEAR(glm::length(ray.ray.direction), 1.0F, 1e-6F);
}

TEST(Camera, ProjectUndoesRay) {
    Numbers numbers(1);
    for (const Camera& camera : someCameras()) {
        for (int i = 0; i < 500; ++i) {
            const glm::vec2 film = numbers.two() * glm::vec2(6.0F, 4.0F), lens = numbers.two();
            const Ray ray = camera.ray(film, lens).ray;
            const float t = 0.3F + 3.0F * numbers.one();
            const auto back = camera.project(ray.origin + t * ray.direction, lens);
            ASSERT_TRUE(back.has_value());
            EXPECT_LT(glm::length(back->position - film), 2e-4F);
            EXPECT_NEAR(back->distance, t, 1e-5F);
            EXPECT_LT(glm::length(back->direction + ray.direction), 1e-5F);
        }
    }
}

TEST(Camera, NothingBehindOrBesideTheImageIsSeen) {
    const Camera camera(CameraSpec{}, 100, 100);
    EXPECT_FALSE(camera.project({0.0F, 0.0F, 1.0F}, {0.5F, 0.5F}));
    EXPECT_FALSE(camera.project({0.0F, 0.0F, 0.0F}, {0.5F, 0.5F}));
    EXPECT_FALSE(camera.project({2.0F, 0.0F, -1.0F}, {0.5F, 0.5F}));
    EXPECT_TRUE(camera.project({0.1F, 0.0F, -1.0F}, {0.5F, 0.5F}));
}

TEST(Camera, ThinLensIsSharpInThePlaneOfFocus) {
    const Camera camera(CameraSpec{}, 64, 48, 0.2, 2.5);
    const CameraRay first = camera.ray({10.0F, 40.0F}, {0.1F, 0.2F}), second = camera.ray({10.0F, 40.0F}, {0.9F, 0.7F});
    EXPECT_GT(glm::length(first.ray.origin - second.ray.origin), 0.05F);
    const auto inFocus = [](const Ray& r) { return r.origin + r.direction * ((-2.5F - r.origin.z) / r.direction.z); };
    EXPECT_LT(glm::length(inFocus(first.ray) - inFocus(second.ray)), 1e-5F);
}

TEST(Camera, FootprintIsTheRootOfThePixelsCrossSection) {
    const Camera camera(turnedSpec(false), 600, 400);
    for (const glm::vec2 film : {glm::vec2(300.0F, 200.0F), glm::vec2(20.0F, 30.0F)}) {
        const auto direction = [&](float dx, float dy) {
            return glm::dvec3(camera.ray(film + glm::vec2(dx, dy), {0.5F, 0.5F}).ray.direction);
        };
        const glm::dvec3 alongX = direction(2.0F, 0.0F) - direction(-2.0F, 0.0F);
        const glm::dvec3 alongY = direction(0.0F, 2.0F) - direction(0.0F, -2.0F);
        const double width = std::sqrt(glm::length(glm::cross(alongX, alongY))) / 4.0;
        EXPECT_NEAR(static_cast<double>(camera.ray(film, {0.5F, 0.5F}).footprintSpread) / width, 1.0, 1e-3);
    }
    const CameraRay parallel = Camera(turnedSpec(true), 600, 400).ray({1.0F, 1.0F}, {0.5F, 0.5F});
    EXPECT_NEAR(parallel.footprintAtOrigin, 1.4F / 400.0F, 1e-7F);
    EXPECT_EQ(parallel.footprintSpread, 0.0F);
}

/// Light tracing onto a tilted plane patch that fills the image and receives `kFlux` evenly; each hit is connected to
/// the lens. The mean over paths of every pixel is E rho / pi within five standard errors, and the whole image within
/// 1 %.
TEST(Camera, LightTracedPlaneShowsItsRadianceInEveryPixel) {
    constexpr int kPaths = 600000;
    constexpr float kFlux = 5.0F, kReflectance = 0.6F, kHalf = 2.2F;
    Numbers numbers(7);
    for (const Camera& camera : someCameras()) {
        const glm::vec3 centre = camera.position() + 1.3F * camera.forward();
        const glm::vec3 normal = glm::normalize(-camera.forward() + glm::vec3(0.2F, 0.15F, -0.1F));
        const glm::vec3 side = glm::normalize(glm::cross(normal, glm::vec3(0.0F, 1.0F, 0.0F)));
        const glm::vec3 other = glm::cross(normal, side);
        std::vector<double> sum(24, 0.0), squares(24, 0.0);
        for (int i = 0; i < kPaths; ++i) {
            const glm::vec2 at = (2.0F * numbers.two() - 1.0F) * kHalf;
            const auto film = camera.project(centre + side * at.x + other * at.y, numbers.two());
            if (!film) continue;
            const float cosine = glm::dot(normal, film->direction);
            ASSERT_GT(cosine, 0.0F);
            const auto value = static_cast<double>(kFlux * kReflectance * kInvPi * cosine * film->importance);
            const auto pixel =
                static_cast<std::size_t>(film->position.y) * 6 + static_cast<std::size_t>(film->position.x);
            sum[pixel] += value;
            squares[pixel] += value * value;
        }
        const double expected = static_cast<double>(kFlux / (4.0F * kHalf * kHalf) * kReflectance * kInvPi);
        double whole = 0.0;
        for (std::size_t pixel = 0; pixel < 24; ++pixel) {
            const double mean = sum[pixel] / kPaths;
            const double error = std::sqrt((squares[pixel] / kPaths - mean * mean) / kPaths);
            EXPECT_NEAR(mean, expected, 5.0 * error) << "pixel " << pixel;
            EXPECT_LT(error, 0.05 * expected);
            whole += mean / 24.0;
        }
        EXPECT_NEAR(whole / expected, 1.0, 0.01);
    }
}

}  // namespace
}  // namespace pellucid

#include <pellucid/study/convergence.h>

#include <cmath>

#include <pellucid/math/constants.h>
#include <pellucid/math/hash.h>

#include "check_measure.h"

namespace pellucid {

namespace {

using namespace check;

constexpr int kSize = 24;
constexpr double kWidth = 0.5, kReflectance = 0.5, kIntensity = 1.0;
const glm::dvec3 kCentre(0.55, 0.0, 0.0), kLampPosition(0.8, 0.0, 0.12), kLampImage(1.2, 0.0, 0.12);

[[nodiscard]] SceneDescription mirroredPoint() {
    SceneBuilder b;
    b.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, lambert(static_cast<float>(kReflectance)));
    b.quad({1, -4, 0}, {0, 0, 4}, {0, 8, 0}, mirror(1.0F));
    b.point(kLampPosition, kIntensity);
    b.view(kCentre, {0, 0, 1}, kWidth, 0.05);
    return b.description();
}

/// Radiance of the caustic at a point of the floor.
[[nodiscard]] double expectedAt(const glm::dvec3& p) {
    const glm::dvec3 to = kLampImage - p;
    const double d2 = glm::dot(to, to);
    return kReflectance / kPiD * kIntensity * to.z / (d2 * std::sqrt(d2));
}

/// Where the camera sees the centre of each pixel on the floor.
[[nodiscard]] std::vector<double> pictureOf(const Scene& scene) {
    const Camera camera = scene.camera("", kSize, kSize);
    const Normalisation& n = scene.normalisation();
    std::vector<double> picture;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const Ray ray = camera.ray({static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F}, {0.5F, 0.5F}).ray;
            const glm::dvec3 origin = glm::dvec3(ray.origin) / n.scale() + n.centre, direction(ray.direction);
            picture.push_back(expectedAt(origin - direction * (origin.z / direction.z)));
        }
    return picture;
}

[[nodiscard]] double relmseOf(const Image& image, const std::vector<double>& picture) {
    const int red = image.channel("caustic.R");
    double sum = 0.0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const double off = static_cast<double>(image.at(i, red)) / picture[i] - 1.0;
        sum += off * off / static_cast<double>(picture.size());
    }
    return sum;
}

[[nodiscard]] Interval meanOfSlopes(const std::vector<double>& slopes) {
    const auto n = static_cast<double>(slopes.size());
    double mean = 0.0, square = 0.0;
    for (const double s : slopes) mean += s / n;
    for (const double s : slopes) square += (s - mean) * (s - mean);
    const double half = slopes.size() > 1 ? studentQuantile(0.975, static_cast<int>(slopes.size()) - 1) *
                                                std::sqrt(square / (n * (n - 1.0)))
                                          : std::nan("");
    return {mean, mean - half, mean + half};
}

}  // namespace

ConvergenceOptions wholeConvergence() {
    return {{4, 16, 64, 256, 1024, 4096},
            4,
            {{"photon, alpha 2/3", Method::Photon, {}},
             {"photon, chi2", Method::Photon, {{"photon.shrink", "chi2"}}},
             {"sppm, alpha 2/3", Method::Sppm, {}},
             {"sppm, chi2", Method::Sppm, {{"photon.shrink", "chi2"}}},
             {"photon, alpha 1", Method::Photon, {{"photon.alpha", "1"}}}}};
}

std::vector<ConvergenceCurve> measureConvergence(const CheckContext& context, const ConvergenceOptions& options,
                                                 const std::function<void(const ConvergenceCurve&)>& done) {
    const Scene scene = makeScene(context, mirroredPoint());
    const std::vector<double> picture = pictureOf(scene);
    std::vector<ConvergenceCurve> curves;
    for (const ConvergenceMethod& method : options.methods) {
        Settings settings;
        // Few photons a kernel and pass: well spread ones would have less than their shot noise until kernels get small.
        setParameter(settings, "photon.guiding", "off");
        setParameter(settings, "photon.radius", "8");
        setParameter(settings, "photon.caustic", std::to_string(kSize * kSize));
        setParameter(settings, "photon.global", "16");
        setParameter(settings, "cache.mode", "off");
        for (const auto& [name, value] : method.settings) setParameter(settings, name, value);
        ConvergenceCurve curve;
        curve.label = method.label;
        curve.relmse.assign(options.iterations.size(), 0.0);
        for (const std::uint32_t n : options.iterations) curve.photons.push_back(n);
        std::vector<double> slopes;
        for (int k = 0; k < options.seeds; ++k) {
            std::vector<double> errors;
            for (const std::uint32_t n : options.iterations) {
                // Other photons at every length: the points of a curve are independent.
                const std::uint64_t seed = hashCombine(hashCombine(context.seed, n), static_cast<std::uint64_t>(k));
                errors.push_back(
                    relmseOf(renderOnce(context, scene, {method.method, n}, settings, kSize, seed).image, picture));
            }
            for (std::size_t i = 0; i < errors.size(); ++i) curve.relmse[i] += errors[i] / options.seeds;
            slopes.push_back(logLogSlope(curve.photons, errors));
        }
        curve.slope = meanOfSlopes(slopes);
        if (done) done(curve);
        curves.push_back(std::move(curve));
    }
    return curves;
}

}  // namespace pellucid

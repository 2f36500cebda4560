// Extremes of light: lamps of no area, tiny beside huge, ten thousand of them; environments with bad or burning texels.
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>

#include <fmt/format.h>

#include <pellucid/base/error.h>
#include <pellucid/io/image_file.h>
#include <pellucid/math/constants.h>

#include "check_cases.h"
#include "check_formulas.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

constexpr double kRho = 0.5, kPatch = 0.2;
const glm::dvec3 kUp(0, 0, 1);

void append(std::vector<Finding>& to, std::vector<Finding> from) { to.insert(to.end(), from.begin(), from.end()); }

[[nodiscard]] SceneBuilder floorScene(double halfWidth) {
    SceneBuilder b;
    b.square(glm::dvec3(0.0), kUp, halfWidth, lambert(static_cast<float>(kRho)));
    b.view(glm::dvec3(0.0), kUp, kPatch, 0.3);
    return b;
}
[[nodiscard]] double overPatch(const std::function<double(const glm::dvec3&)>& e) {
    return meanOverSquare([&e](double u, double v) { return e({(u - 0.5) * kPatch, (v - 0.5) * kPatch, 0.0}); }, 8);
}
[[nodiscard]] std::array<glm::dvec3, 4> squareAt(const glm::dvec3& centre, double half) {
    return {centre + glm::dvec3(-half, -half, 0), centre + glm::dvec3(-half, half, 0),
            centre + glm::dvec3(half, half, 0), centre + glm::dvec3(half, -half, 0)};
}
[[nodiscard]] std::vector<Finding> irradiance(const CheckContext& context, SceneBuilder& b, double expected,
                                              const std::string& quantity, double resolution = 0.02,
                                              std::uint32_t photonSamples = 16) {
    return measureByAll(context,
                        {b.description(),
                         {},
                         expected,
                         kPiD / kRho,
                         quantity,
                         {{Method::Path, 8, 0.0, resolution}, {Method::Photon, photonSamples, 0.005, resolution}},
                         16,
                         smallSettings()});
}

std::vector<Finding> zeroArea(const CheckContext& context) {
    const glm::dvec3 light(0.4, -0.3, 0.8);
    Mesh nothing;
    nothing.positions = {{0, 0, 0.5F}, {0.5F, 0, 0.5F}, {1, 0, 0.5F}};
    nothing.triangles = {{0, 1, 2}, {0, 0, 1}};
    SceneBuilder b = floorScene(1.0);
    b.mesh(nothing, lamp(1e6F));
    b.point(light, 2.0);
    std::vector<Finding> all =
        irradiance(context, b, overPatch([&](const glm::dvec3& p) { return pointIrradiance(p, kUp, light, 2.0); }),
                   "irradiance beside a lamp of no area");
    SceneBuilder dark = floorScene(1.0);
    dark.mesh(nothing, lamp(1e6F));
    double refused = 0.0;
    try {
        const Scene scene = makeScene(context, dark.description());
    } catch (const Error& error) {
        refused = error.kind() == ErrorKind::BadInput ? 1.0 : 0.0;
    }
    all.push_back(exact("a scene with no other light is refused as bad input", 1.0, refused, 0.0));
    return all;
}

/// A lamp of 1 mm and radiance 1e9 beside one of 10 m and 0.1; a second floor stands in the shade of the first alone.
std::vector<Finding> tinyBesideHuge(const CheckContext& context) {
    const auto huge = squareAt({0, 0, 3}, 5.0), tiny = squareAt({0, 0, 1}, 0.0005), shade = squareAt({0, 0, 0.9}, 0.05);
    std::vector<Finding> all;
    for (const bool shaded : {false, true}) {
        SceneBuilder b = floorScene(1.0);
        b.quad(huge[0], huge[1] - huge[0], huge[3] - huge[0], lamp(0.1F));
        b.quad(tiny[0], tiny[1] - tiny[0], tiny[3] - tiny[0], lamp(1e9F));
        if (shaded) b.quad(shade[0], shade[1] - shade[0], shade[3] - shade[0], lambert(0.0F));
        const double expected = overPatch([&](const glm::dvec3& p) {
            const double open = 0.1 * polygonIrradiance(p, kUp, huge);
            return shaded ? open - 0.1 * polygonIrradiance(p, kUp, shade)
                          : open + (1e9 - 0.1) * polygonIrradiance(p, kUp, tiny);
        });
        append(all, irradiance(context, b, expected, shaded ? "irradiance in the tiny lamp's shade" : "irradiance",
                               0.05, 256));
    }
    return all;
}

/// A lamp that nearly touches the ceiling and stands over the camera.
std::vector<Finding> touchingWall(const CheckContext& context) {
    const auto corners = squareAt({0.1, 0, 1.0 - 1e-5}, 0.3);
    SceneBuilder b = floorScene(1.0);
    b.square({0, 0, 1.0}, -kUp, 1.0, lambert(0.0F));
    b.quad(corners[0], corners[1] - corners[0], corners[3] - corners[0], lamp(5.0F));
    return irradiance(context, b,
                      5.0 * overPatch([&](const glm::dvec3& p) { return polygonIrradiance(p, kUp, corners); }),
                      "irradiance");
}

/// A lamp whose edge lies on a wall: what it makes of the wall right beside that edge.
std::vector<Finding> onTheWall(const CheckContext& context) {
    const glm::dvec3 out(1, 0, 0), middle(0, 0, 0.85);
    const std::array<glm::dvec3, 4> corners{glm::dvec3(0, -0.3, 1), glm::dvec3(0, 0.3, 1), glm::dvec3(0.5, 0.3, 1),
                                            glm::dvec3(0.5, -0.3, 1)};
    SceneBuilder b;
    b.square({0, 0, 1}, out, 1.0, lambert(static_cast<float>(kRho)));
    b.quad(corners[0], corners[1] - corners[0], corners[3] - corners[0], lamp(5.0F));
    b.view(middle, out, kPatch, 0.3);
    const double expected =
        5.0 * meanOverSquare([&](double u, double v) {
            return polygonIrradiance(middle + kPatch * glm::dvec3(0, u - 0.5, v - 0.5), out, corners);
        });
    return irradiance(context, b, expected, "irradiance of the wall", 0.02, 48);
}

/// A tilted lamp that reflects, from behind: by rounding alone its points lie before it or behind, and it must light none.
std::vector<Finding> backOfALamp(const CheckContext& context) {
    const glm::dvec3 back = glm::normalize(glm::dvec3(0.3, 0.1, 1.0)), right = glm::normalize(glm::cross(kUp, back));
    const glm::dvec3 middle(0.7, 0.4, -0.5);  // nowhere near the scene's, where floats would be finer
    const auto other = squareAt({-0.3, -0.2, 1.0}, 0.3);
    Material reflecting = lamp(5000.0F);
    reflecting.baseColor = lambert(static_cast<float>(kRho)).baseColor;
    SceneBuilder b;
    b.square(middle, -back, 0.4, reflecting);
    b.quad(other[0], other[1] - other[0], other[3] - other[0], lamp(3.0F));
    b.view(middle, back, kPatch, 0.3);
    const double expected =
        3.0 * meanOverSquare([&](double u, double v) {
            return polygonIrradiance(middle + kPatch * ((u - 0.5) * right + (v - 0.5) * glm::cross(back, right)), back,
                                     other);
        });
    return irradiance(context, b, expected, "irradiance by another lamp");
}

std::vector<Finding> tenThousandLights(const CheckContext& context) {
    constexpr int kSide = 100;
    SceneBuilder b = floorScene(2.0);
    std::vector<glm::dvec3> places;
    for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i) {
            places.emplace_back(-2.0 + 4.0 * (i + 0.5) / kSide, -2.0 + 4.0 * (j + 0.5) / kSide,
                                0.5 + 0.3 * std::sin(0.7 * i + 1.3 * j));
            b.point(places.back(), 1e-3);
        }
    const double expected = overPatch([&](const glm::dvec3& p) {
        double sum = 0.0;
        for (const glm::dvec3& light : places) sum += pointIrradiance(p, kUp, light, 1e-3);
        return sum;
    });
    return irradiance(context, b, expected, "irradiance");
}

[[nodiscard]] std::vector<Finding> underMap(const CheckContext& context, EnvironmentDescription sky, double expected,
                                            const std::string& quantity) {
    SceneBuilder b;
    b.square(glm::dvec3(0.0), {0, 1, 0}, 0.5, lambert(static_cast<float>(kRho)));
    b.view(glm::dvec3(0.0), {0, 1, 0}, 0.5, 1.0);
    return measureByAll(context, {b.description(),
                                  std::move(sky),
                                  expected,
                                  kPiD / kRho,
                                  quantity,
                                  {{Method::Path, 8, 0.0, 0.02}, {Method::Photon, 16, 0.005, 0.03}},
                                  16,
                                  smallSettings()});
}

/// One texel of 1e6 among others of 1e-3; the bilinear look-up makes it a pyramid of two texels' width.
std::vector<Finding> burningTexel(const CheckContext& context) {
    constexpr int kWidth = 64, kHeight = 32, kRow = 9;
    EnvironmentDescription sky = environmentMap(kWidth, kHeight, [](const glm::dvec3&) { return 1e-3; });
    sky.map.setRgb(static_cast<std::size_t>(kRow) * kWidth + 20, Rgb(1e6F));
    const double pyramid =
        (1e6 - 1e-3) * (2.0 * kPiD / kWidth) * integral(kRow - 0.5, kRow + 1.5, [](double row) {
            const double theta = kPiD * row / kHeight;
            return (1.0 - std::fabs(row - kRow - 0.5)) * std::cos(theta) * std::sin(theta) * kPiD / kHeight;
        });
    return underMap(context, sky, 1e-3 * kPiD + pyramid, "irradiance");
}

std::vector<Finding> oneTexel(const CheckContext& context) {
    EnvironmentDescription sky;
    sky.map = Image(1, 1, {"R", "G", "B"});
    sky.map.setRgb(0, Rgb(2.0F));
    return underMap(context, sky, 2.0 * kPiD, "irradiance");
}

/// Written and read back: texels that are no radiance count as 0, and are counted.
std::vector<Finding> badTexels(const CheckContext& context) {
    EnvironmentDescription sky = environmentMap(64, 32, [](const glm::dvec3&) { return 1.0; });
    const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -5.0F};
    for (std::size_t i = 0; i < 3; ++i) sky.map.setRgb(20 * 64 + 5 * i, Rgb(bad[i]));  // below the horizon
    const auto file =
        std::filesystem::temp_directory_path() /
        fmt::format("pellucid-check-{:x}.exr",
                    static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count()));
    writeExr(file, sky.map, {});
    EnvironmentDescription loaded;
    try {
        loaded = loadEnvironment(file.string());
    } catch (...) {
        std::filesystem::remove(file);
        throw;
    }
    std::filesystem::remove(file);
    std::vector<Finding> all{exact("texels mended", 3.0, static_cast<double>(loaded.mendedTexels), 0.0)};
    append(all, underMap(context, std::move(loaded), kPiD, "irradiance"));
    return all;
}

}  // namespace

void addLampExtremes(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, const char* source, bool quick, auto run) {
        cases.push_back({name, CheckGroup::Extreme, guards, source, quick, run});
    };
    add("extreme-lamp-of-no-area", "emissive triangles without area are no lamps", "invariance", true, zeroArea);
    add("extreme-tiny-beside-huge-lamp", "1 mm of radiance 1e9 beside 10 m of 0.1", "[Lambert1760]", true,
        tinyBesideHuge);
    add("extreme-lamp-touching-ceiling", "a lamp 1e-5 under a ceiling, behind the camera", "[Lambert1760]", false,
        touchingWall);
    add("extreme-lamp-on-a-wall", "a lamp whose edge lies on the wall that it lights", "[Lambert1760]", true,
        onTheWall);
    add("extreme-back-of-a-lamp", "a lamp that reflects does not light its own back", "[Lambert1760]", true,
        backOfALamp);
    add("extreme-ten-thousand-lights", "sum I cos / d^2 over 10,000 point lights", "inverse square law", true,
        tenThousandLights);
    add("extreme-burning-texel", "one texel nine orders brighter than the rest", "integral of the bilinear map", true,
        burningTexel);
    add("extreme-one-texel", "an environment of 1 x 1", "pi L", true, oneTexel);
    add("extreme-bad-texels", "NaN, infinite and negative texels", "pi L", true, badTexels);
}

}  // namespace pellucid::check

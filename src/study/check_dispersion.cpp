// Glass whose ior differs by wavelength.
#include <array>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include <pellucid/math/constants.h>
#include <pellucid/study/record_json.h>
#include <pellucid/surface/dispersion.h>

#include "check_cases.h"
#include "check_formulas.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

/// Integral over the wavelengths of what of each passes, by how much of the channel lies there.
[[nodiscard]] double meanOverWaves(const Material& m, glm::length_t channel,
                                   const std::function<double(double n)>& passes) {
    return integral(static_cast<double>(kShortestWave), static_cast<double>(kLongestWave), [&](double nm) {
        const auto wave = static_cast<float>(nm);
        const auto n = static_cast<double>(iorAt(m.ior, m.dispersion, {wave}));
        return static_cast<double>(channelsAt(wave)[channel]) * passes(n);
    });
}

[[nodiscard]] Material dispersing(float ior, float dispersion) {
    Material m = glass(ior);
    m.dispersion = dispersion;
    return m;
}

/// Each channel's mean over the image, times `toQuantity`, by each method; `expected`: by channel.
[[nodiscard]] std::vector<Finding> byChannel(const CheckContext& context, const SceneDescription& description,
                                             const std::string& quantity, double toQuantity, const glm::dvec3& expected,
                                             const std::vector<By>& methods) {
    const Scene scene = makeScene(context, description);
    const char* const names[] = {"red", "green", "blue"};
    std::vector<Finding> all;
    for (const By& by : methods) {
        std::array<std::vector<double>, 3> values;
        for (const glm::dvec3& means : forSeeds(context, kManySeeds, [&](std::uint64_t seed) {
                 return channelsOf(renderOnce(context, scene, by, smallSettings(), 16, seed).image, by.layer);
             }))
            for (glm::length_t c = 0; c < 3; ++c) values[static_cast<std::size_t>(c)].push_back(toQuantity * means[c]);
        for (std::size_t c = 0; c < 3; ++c)
            all.push_back(findingOf(fmt::format("{}, {}, {}", quantity, names[c], methodName(by.method)),
                                    expected[static_cast<glm::length_t>(c)], by.bias, by.resolution, values[c]));
    }
    return all;
}

/// Sunlight squarely through a slab: blue is reflected more than red.
std::vector<Finding> sunThroughSlab(const CheckContext& context) {
    const Material flint = dispersing(1.7F, 10.0F);
    const double rho = 0.5, sun = 3.0;
    SceneBuilder b;
    b.square(glm::dvec3(0.0), {0, 0, 1}, 1.0, lambert(static_cast<float>(rho)));
    b.box({-1, -1, 0.5}, {1, 1, 0.7}, flint);
    b.sun({0, 0, -1}, sun);
    b.view(glm::dvec3(0.0), {0, 0, 1}, 0.6, 0.3);
    glm::dvec3 expected(0.0);
    for (glm::length_t c = 0; c < 3; ++c)
        expected[c] = sun * meanOverWaves(flint, c, [](double n) { return slabTransmittance(1.0, n); });
    return byChannel(context, b.description(), "irradiance", kPiD / rho, expected,
                     {{Method::Photon, 2, 0.005, 0.04, "caustic"},
                      {Method::Light, 2, 0.0, 0.04, "caustic"},
                      {Method::Bdpt, 32, 0.0, 0.1, "caustic"}});
}

/// A right-angled prism met squarely, with a wide lamp close behind its long side: there blue light is totally reflected, red
/// is not. What is reflected leaves squarely through the other leg, but for R0 that comes back to the long side, and so on.
std::vector<Finding> nearTotalReflection(const CheckContext& context) {
    const Material flint = dispersing(1.404F, 2.0F);  // n from 1.38 to 1.48: sqrt(2) lies in it, at 543 nm
    SceneBuilder b;
    b.mesh(rightAngledPrism(2.0F), flint);
    const glm::dvec3 out = glm::normalize(glm::dvec3(1, 0, 1));
    b.square(glm::dvec3(0.5, 0, 0.5) + 0.01 * out, -out, 6.0,
             lamp(1.0F, true));  // little leaves so flatly that it misses
    b.view({0.5, 0, 0}, {0, 0, -1}, 0.1, 0.5);
    glm::dvec3 expected(0.0);
    for (glm::length_t c = 0; c < 3; ++c)
        expected[c] = meanOverWaves(flint, c, [](double n) {
            const double leg = fresnel(1.0, n), longSide = fresnel(std::sqrt(0.5), 1.0 / n);
            return (1.0 - leg) * (1.0 - longSide) / (1.0 - longSide * leg);
        });
    return byChannel(context, b.description(), "transmittance", 1.0, expected,
                     {{Method::Path, 64, 0.002, 0.05},
                      {Method::Photon, 32, 0.002, 0.02},
                      {Method::Bdpt, 32, 0.002, 0.07},
                      {Method::Reference, 8, 0.002, 0.06}});
}

}  // namespace

void addDispersion(Cases& cases) {
    cases.push_back({"dispersion-sun-through-slab", CheckGroup::ClosedForm,
                     "each channel the mean over wavelengths of E = 2n / (n^2 + 1) E0", "[Hecht2002, eqs. 4.34-4.40]",
                     true, sunThroughSlab});
    cases.push_back({"dispersion-near-total-reflection", CheckGroup::ClosedForm,
                     "each channel the mean over wavelengths of what passes where blue is totally reflected",
                     "[Hecht2002, eqs. 4.34-4.40]", true, nearTotalReflection});
}

}  // namespace pellucid::check

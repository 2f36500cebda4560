// Closed forms 25 to 27: the statistics of the density estimate, on photons made by hand.
#include <cmath>

#include <fmt/format.h>

#include <pellucid/math/constants.h>
#include <pellucid/transport/caustic_map.h>

#include "check_cases.h"
#include "check_measure.h"
#include "check_random.h"

namespace pellucid::check {

namespace {

const glm::vec3 kUp(0, 0, 1);

[[nodiscard]] Photon photonAt(double x, double y, double flux) {
    Photon p;
    p.position = {static_cast<float>(x), static_cast<float>(y), 0.0F};
    p.wi = p.normal = kUp;
    p.flux = Rgb(static_cast<float>(flux));
    return p;
}

[[nodiscard]] double lookUp(const CausticMap& map, double x, double y, double radius) {
    return static_cast<double>(map.irradiance({static_cast<float>(x), static_cast<float>(y), 0.0F}, kUp, kUp,
                                              {Rgb(1.0F)}, static_cast<float>(radius))
                                   .g);
}

/// A square lattice of photons over [-1, 1]^2 that carries the irradiance `e`: no noise, only bias.
[[nodiscard]] CausticMap lattice(int n, const std::function<double(double, double)>& e) {
    PhotonList photons;
    const double cell = 2.0 / n;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const double x = -1.0 + (i + 0.5) * cell, y = -1.0 + (j + 0.5) * cell, value = e(x, y);
            if (value > 0.0) photons.push_back(photonAt(x, y, value * cell * cell));
        }
    return CausticMap(std::move(photons));
}

/// Relative variance pi R_K / n_r with R_K = 4 / (3 pi) for Epanechnikov: 4 / (3 n_r).
std::vector<Finding> variance(const CheckContext& context) {
    std::vector<Finding> all;
    for (const double inKernel : {20.0, 100.0, 400.0}) {
        const double radius = 0.1, count = inKernel * 4.0 / (kPiD * radius * radius);
        all.push_back(measureSeeds(context, fmt::format("variance x n_r at n_r = {:.0f}", inKernel), 4.0 / 3.0, 0.01,
                                   0.15, [&](std::uint64_t seed) {
                                       Independent random(seed);
                                       double square = 0.0;
                                       int looks = 0;
                                       for (int map = 0; map < 16; ++map) {
                                           PhotonList photons;
                                           for (int i = 0; i < static_cast<int>(count); ++i)
                                               photons.push_back(photonAt(2.0 * random.next() - 1.0,
                                                                          2.0 * random.next() - 1.0, 4.0 / count));
                                           const CausticMap caustics(std::move(photons));
                                           for (double y = -0.8; y < 0.81; y += 0.2)
                                               for (double x = -0.8; x < 0.81; x += 0.2, ++looks) {
                                                   const double e = lookUp(caustics, x, y, radius);
                                                   square += (e - 1.0) * (e - 1.0);
                                               }
                                       }
                                       return square / looks * inKernel;
                                   }));
    }
    return all;
}

std::vector<Finding> smoothBias(const CheckContext&) {
    const double radius = 0.2;
    const CausticMap linear = lattice(1000, [](double x, double y) { return 3.0 + 2.0 * x - y; });
    const CausticMap quadratic = lattice(1000, [](double x, double y) { return 1.0 + 4.0 * x * x + 2.0 * y * y; });
    // mu2 = 1/6 for Epanechnikov; the Laplacian is 8 + 4.
    return {exact("flat and linear field at (0, 0)", 3.0, lookUp(linear, 0.0, 0.0, radius), 2e-3),
            exact("linear field at (0.3, -0.4)", 4.0, lookUp(linear, 0.3, -0.4, radius), 2e-3),
            exact("quadratic field at (0, 0): bias r^2 mu2 lap E / 2", 1.0 + radius * radius / 6.0 * 12.0 / 2.0,
                  lookUp(quadratic, 0.0, 0.0, radius), 2e-3)};
}

std::vector<Finding> edges(const CheckContext&) {
    const double radius = 0.2;
    const CausticMap step = lattice(1000, [](double x, double) { return x < 0.0 ? 1.0 : 5.0; });
    const CausticMap sheet = lattice(1000, [](double x, double) { return x < 0.0 ? 2.0 : 0.0; });
    return {exact("on a step from 1 to 5: the mean", 3.0, lookUp(step, 0.0, 0.0, radius), 5e-3),
            exact("on the edge of a sheet: E / 2", 1.0, lookUp(sheet, 0.0, 0.0, radius), 5e-3),
            exact("in its corner: E / 4", 0.5, lookUp(sheet, 0.0, -1.0, radius), 5e-3)};
}

/// Photons on the other side, and off the plane, are not of this surface.
std::vector<Finding> rejects(const CheckContext&) {
    PhotonList photons;
    Photon other = photonAt(0.0, 0.0, 1.0);
    other.normal = other.wi = -kUp;
    photons.push_back(other);
    Photon above = photonAt(0.0, 0.0, 1.0);
    above.position.z = 0.15F;
    photons.push_back(above);
    const CausticMap map(std::move(photons));
    return {exact("photons of the other side and off the plane", 0.0, lookUp(map, 0.0, 0.0, 0.2), 0.0)};
}

}  // namespace

void addKernels(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, const char* source, auto run) {
        cases.push_back({name, CheckGroup::Kernel, guards, source, true, run});
    };
    add("closed-form-25-kernel-variance", "relative variance pi R_K / n_r = 4 / (3 n_r) in a flat field",
        "[Silverman1986, ch. 4]", variance);
    add("closed-form-26-kernel-bias", "none where E is linear, r^2 mu2 lap E / 2 where it is quadratic",
        "[Silverman1986, ch. 4]", smoothBias);
    add("closed-form-27-kernel-edges", "the mean at a step, a half at an edge", "[Silverman1986, sec. 2.10]", edges);
    add("kernel-rejects", "photons of another surface do not count", "[Jensen1996]", rejects);
}

}  // namespace pellucid::check

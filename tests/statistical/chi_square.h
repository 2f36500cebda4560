/// Pearson's chi^2 test of a sampling function against its density on the sphere: the density is integrated adaptively
/// over a theta-phi grid, cells that expect little are pooled, and what sampling loses must match what the density
/// lacks to 1. Each test is at level 1 % over all the tests that a caller declares (Sidak). [Jakob2010chi2]
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <random>
#include <vector>

#include <glm/glm.hpp>

#include <pellucid/math/constants.h>
#include <pellucid/math/frame.h>

namespace pellucid::testing {

/// Upper tail of the chi^2 distribution: the regularised incomplete gamma Q(dof/2, x/2), by the series for P below a +
/// 1 and by Lentz's continued fraction above. [DLMF 8.11.4, 8.9.2]
inline double chiSquareTail(double chi2, double dof) {
    const double a = 0.5 * dof, x = 0.5 * chi2;
    if (x <= 0.0) return 1.0;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1.0) {
        double term = 1.0 / a, sum = term;
        for (int n = 1; n < 10000 && term > 1e-16 * sum; ++n) sum += term *= x / (a + n);
        return 1.0 - front * sum;
    }
    double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, fraction = d;
    for (int n = 1; n < 10000; ++n) {
        const double numerator = -n * (n - a);
        b += 2.0;
        d = 1.0 / (numerator * d + b);
        c = b + numerator / c;
        fraction *= c * d;
        if (std::fabs(c * d - 1.0) < 1e-15) break;
    }
    return front * fraction;
}

/// Level of one test of `tests` so that all together reject a right hypothesis with probability 1 %.
inline double sidakLevel(int tests) { return 1.0 - std::pow(0.99, 1.0 / tests); }

struct ChiSquareResult {
    double pValue = 0.0;
    double mass = 0.0;  ///< integral of the density over the sphere
    double lost = 0.0;  ///< share of the samples that gave no direction
    int cells = 0;      ///< after pooling
};

/// Pools cells that expect fewer than five and compares the rest.
inline ChiSquareResult compareCounts(const std::vector<double>& expected, const std::vector<double>& observed) {
    std::vector<std::size_t> order(expected.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
    double chi2 = 0.0, pooledExpected = 0.0, pooledObserved = 0.0;
    ChiSquareResult result;
    const auto close = [&](double e, double o) {
        chi2 += (o - e) * (o - e) / e;
        ++result.cells;
    };
    for (const std::size_t i : order) {
        if (expected[i] < 5.0 || (pooledExpected > 0.0 && pooledExpected < 5.0)) {
            pooledExpected += expected[i];
            pooledObserved += observed[i];
        } else {
            close(expected[i], observed[i]);
        }
    }
    // Samples where the density is (next to) nothing: a floor keeps one rounding from failing, ten will.
    if (pooledExpected > 0.0 || pooledObserved > 0.0)
        close(std::max(pooledExpected, 0.5), std::max(pooledObserved, 0.5));
    result.pValue = result.cells > 1 ? chiSquareTail(chi2, result.cells - 1) : 1.0;
    return result;
}

/// Cells in polar angles about `axis`; theta = pi t^power, so that a power above 1 resolves a narrow peak at the axis.
struct SphereGrid {
    glm::vec3 axis{0.0F, 0.0F, 1.0F};
    double power = 1.0;
    int thetas = 24, phis = 32;
};

namespace detail {

using Density = std::function<double(const glm::vec3&)>;

struct Cell {
    double t0, t1, phi0, phi1;
};

inline double theta(const SphereGrid& grid, double t) { return kPiD * std::pow(t, grid.power); }

inline double gauss4x4(const SphereGrid& grid, const Frame& frame, const Density& density, const Cell& cell) {
    constexpr std::array<double, 4> kNode{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                          0.8611363115940526};
    constexpr std::array<double, 4> kWeight{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                            0.3478548451374538};
    const double ht = 0.5 * (cell.t1 - cell.t0), hp = 0.5 * (cell.phi1 - cell.phi0);
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        const double t = cell.t0 + ht * (1.0 + kNode[i]), angle = theta(grid, t), sine = std::sin(angle);
        const double stretch = kPiD * grid.power * std::pow(t, grid.power - 1.0) * sine;
        for (std::size_t j = 0; j < 4; ++j) {
            const double phi = cell.phi0 + hp * (1.0 + kNode[j]);
            const glm::dvec3 local{sine * std::cos(phi), sine * std::sin(phi), std::cos(angle)};
            sum += kWeight[i] * kWeight[j] * stretch * density(frame.toWorld(glm::vec3{local}));
        }
    }
    return sum * ht * hp;
}

inline double integrate(const SphereGrid& grid, const Frame& frame, const Density& density, const Cell& c, double whole,
                        int depth) {
    const double t = 0.5 * (c.t0 + c.t1), phi = 0.5 * (c.phi0 + c.phi1);
    const std::array<Cell, 4> parts{
        {{c.t0, t, c.phi0, phi}, {t, c.t1, c.phi0, phi}, {c.t0, t, phi, c.phi1}, {t, c.t1, phi, c.phi1}}};
    std::array<double, 4> values{};
    for (std::size_t i = 0; i < 4; ++i) values[i] = gauss4x4(grid, frame, density, parts[i]);
    const double sum = values[0] + values[1] + values[2] + values[3];
    if (depth >= 8 || (depth >= 1 && std::fabs(sum - whole) < 1e-7)) return sum;
    double refined = 0.0;
    for (std::size_t i = 0; i < 4; ++i) refined += integrate(grid, frame, density, parts[i], values[i], depth + 1);
    return refined;
}

}  // namespace detail

/// `sample` draws a direction or loses it; `density` is its claimed pdf per solid angle.
inline ChiSquareResult chiSquareTest(const std::function<std::optional<glm::vec3>(std::mt19937_64&)>& sample,
                                     const detail::Density& density, const SphereGrid& grid, int samples,
                                     std::uint64_t seed) {
    const Frame frame(grid.axis);
    const auto count = static_cast<std::size_t>(grid.thetas * grid.phis);
    std::vector<double> expected(count + 1), observed(count + 1);
    double mass = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto row = static_cast<double>(i / static_cast<std::size_t>(grid.phis));
        const auto column = static_cast<double>(i % static_cast<std::size_t>(grid.phis));
        const detail::Cell cell{row / grid.thetas, (row + 1.0) / grid.thetas, 2.0 * kPiD * column / grid.phis,
                                2.0 * kPiD * (column + 1.0) / grid.phis};
        const double value =
            detail::integrate(grid, frame, density, cell, detail::gauss4x4(grid, frame, density, cell), 0);
        expected[i] = samples * value;
        mass += value;
    }
    expected[count] = samples * std::max(0.0, 1.0 - mass);
    std::mt19937_64 random(seed);
    for (int i = 0; i < samples; ++i) {
        std::size_t cell = count;
        if (const auto w = sample(random)) {
            const glm::dvec3 local{frame.toLocal(*w)};
            const double angle = std::atan2(std::hypot(local.x, local.y), local.z);
            double phi = std::atan2(local.y, local.x);
            if (phi < 0.0) phi += 2.0 * kPiD;
            const int row =
                std::min(grid.thetas - 1, static_cast<int>(std::pow(angle / kPiD, 1.0 / grid.power) * grid.thetas));
            const int column = std::min(grid.phis - 1, static_cast<int>(phi / (2.0 * kPiD) * grid.phis));
            cell = static_cast<std::size_t>(row * grid.phis + column);
        }
        observed[cell] += 1.0;
    }
    ChiSquareResult result = compareCounts(expected, observed);
    result.mass = mass;
    result.lost = observed[count] / samples;
    return result;
}

/// Uniform in [0, 1), as the renderer's samplers make them.
inline float uniform(std::mt19937_64& random) { return static_cast<float>(random() >> 40U) * 0x1p-24F; }
inline glm::vec2 uniform2(std::mt19937_64& random) {
    const float x = uniform(random);
    return {x, uniform(random)};
}

}  // namespace pellucid::testing

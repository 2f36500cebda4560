/// The kernels of photon density estimation, by t = (d/r)^2. Each is `kScale * shape(t)`, 0 beyond t = 1, and its mean over the
/// disc is 1: int_0^1 kScale shape(t) dt = 1, as d(area) / (pi r^2) = dt. [Silverman1986]
#pragma once

#include <cmath>
#include <cstdint>

namespace pellucid {

enum class PhotonKernel : std::uint8_t { Epanechnikov, Uniform, Cone, Biweight };

namespace kernel_shape {

struct Epanechnikov {
    static constexpr float kScale = 2.0F;
    [[nodiscard]] static float shape(float t) noexcept { return 1.0F - t; }
};
struct Uniform {
    static constexpr float kScale = 1.0F;
    [[nodiscard]] static float shape(float) noexcept { return 1.0F; }
};
/// Slope 1: Jensen's cone with k = 1. [Jensen1996]
struct Cone {
    static constexpr float kScale = 3.0F;
    [[nodiscard]] static float shape(float t) noexcept { return 1.0F - std::sqrt(t); }
};
struct Biweight {
    static constexpr float kScale = 3.0F;
    [[nodiscard]] static float shape(float t) noexcept { return (1.0F - t) * (1.0F - t); }
};

}  // namespace kernel_shape

/// Calls function(a shape of kernel_shape) with the kernel's and returns what it returns.
template <class Function>
[[nodiscard]] auto withShape(PhotonKernel kernel, const Function& function) noexcept {
    switch (kernel) {
        case PhotonKernel::Uniform:
            return function(kernel_shape::Uniform{});
        case PhotonKernel::Cone:
            return function(kernel_shape::Cone{});
        case PhotonKernel::Biweight:
            return function(kernel_shape::Biweight{});
        case PhotonKernel::Epanechnikov:
            break;
    }
    return function(kernel_shape::Epanechnikov{});
}

/// A photon within a kernel lies on the surface of the kernel's middle when its normal leans by at most 60 degrees, and its
/// height over the tangent plane is at most this share of the radius.
inline constexpr float kLeastNormalCosine = 0.5F, kMostPlaneDistance = 0.3F;

/// Photons that a kernel needs for the noise of Epanechnikov's at the same balance of noise and bias: the square of the ratio of
/// the radii that are optimal for each, r^6 ~ R / m^2 with R = int K^2 and m the second moment: (R, m) of the unit disc are
/// (4/3 pi, 1/6), (1/pi, 1/4), (3/2 pi, 3/20), (9/5 pi, 1/8). [Silverman1986, sec. 4.2]
[[nodiscard]] inline double photonsWanted(PhotonKernel kernel) noexcept {
    const auto optimal = [](double roughness, double moment) { return std::cbrt(roughness / (moment * moment)); };
    constexpr double kEpanechnikov = 4.0 / 3.0;
    switch (kernel) {
        case PhotonKernel::Uniform:
            return optimal(1.0, 1.0 / 4.0) / optimal(kEpanechnikov, 1.0 / 6.0);
        case PhotonKernel::Cone:
            return optimal(3.0 / 2.0, 3.0 / 20.0) / optimal(kEpanechnikov, 1.0 / 6.0);
        case PhotonKernel::Biweight:
            return optimal(9.0 / 5.0, 1.0 / 8.0) / optimal(kEpanechnikov, 1.0 / 6.0);
        case PhotonKernel::Epanechnikov:
            break;
    }
    return 1.0;
}

}  // namespace pellucid

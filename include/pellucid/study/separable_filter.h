/// Convolution of an image's plane with a product of two one-dimensional kernels, in two passes. Beyond the border the
/// nearest pixel stands, so any image, however small, can be filtered.
#pragma once

#include <cstddef>
#include <vector>

namespace pellucid {

using Kernel = std::vector<float>;  ///< odd length, centred
using Plane = std::vector<float>;   ///< one value a pixel, in rows

struct PlaneSize {
    int width = 0, height = 0;
    [[nodiscard]] std::size_t pixels() const noexcept {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
};

[[nodiscard]] Plane convolve(const Plane& in, const PlaneSize& size, const Kernel& alongX, const Kernel& alongY);

/// value(i) for i = -radius ... radius.
template <class Function>
[[nodiscard]] Kernel makeKernel(int radius, Function&& value) {
    Kernel kernel;
    for (int i = -radius; i <= radius; ++i) kernel.push_back(value(static_cast<float>(i)));
    return kernel;
}

/// Scales the positive weights to the sum 1 and the negative ones, if any, to -1.
[[nodiscard]] Kernel normalised(Kernel kernel);

}  // namespace pellucid

#include <pellucid/study/separable_filter.h>

#include <algorithm>

namespace pellucid {
namespace {

[[nodiscard]] Plane convolveRows(const Plane& in, const PlaneSize& size, const Kernel& kernel) {
    const std::size_t radius = kernel.size() / 2, width = static_cast<std::size_t>(size.width);
    Plane out(in.size(), 0.0F), padded(width + 2 * radius);
    for (std::size_t row = 0; row < in.size(); row += width) {
        std::fill_n(padded.begin(), radius, in[row]);
        std::copy_n(&in[row], width, &padded[radius]);
        std::fill_n(&padded[radius + width], radius, in[row + width - 1]);
        for (std::size_t k = 0; k < kernel.size(); ++k)
            for (std::size_t x = 0; x < width; ++x) out[row + x] += kernel[k] * padded[x + k];
    }
    return out;
}

[[nodiscard]] Plane convolveColumns(const Plane& in, const PlaneSize& size, const Kernel& kernel) {
    const std::size_t width = static_cast<std::size_t>(size.width);
    const int radius = static_cast<int>(kernel.size() / 2);
    Plane out(in.size(), 0.0F);
    for (int y = 0; y < size.height; ++y) {
        float* const to = &out[static_cast<std::size_t>(y) * width];
        for (int k = -radius; k <= radius; ++k) {
            const int source = std::clamp(y + k, 0, size.height - 1);
            const float* const from = &in[static_cast<std::size_t>(source) * width];
            const float weight = kernel[static_cast<std::size_t>(k + radius)];
            for (std::size_t x = 0; x < width; ++x) to[x] += weight * from[x];
        }
    }
    return out;
}

}  // namespace

Plane convolve(const Plane& in, const PlaneSize& size, const Kernel& alongX, const Kernel& alongY) {
    return convolveColumns(convolveRows(in, size, alongX), size, alongY);
}

Kernel normalised(Kernel kernel) {
    float positive = 0.0F, negative = 0.0F;
    for (const float w : kernel) (w > 0.0F ? positive : negative) += w;
    for (float& w : kernel) w /= w > 0.0F ? positive : (negative < 0.0F ? -negative : 1.0F);
    return kernel;
}

}  // namespace pellucid

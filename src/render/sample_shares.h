/// Adaptive sampling in image space: how many eye samples each pixel takes in every iteration to come.
///
/// A pixel's value is a mean over iterations of the mean of its samples in each, and a number of samples is fixed from
/// iterations before it alone: so each term is unbiased. Iterations are weighed by the inverse of the variance that their
/// samples and photons give the image, one weight for all pixels. (Weighing a pixel's terms by its own numbers of samples
/// would bias it: pixels that were bright by chance would take more samples and count them.)
///
/// With v the variance of one eye sample, c its rays, L the pixel's luminance and e2 the floor of relmse, the sum over pixels
/// of v / (k (L^2 + e2)) is least for a given number of rays when k ~ sqrt(v / (c (L^2 + e2))). The photons' noise P is
/// the same for all samples of an iteration, and P / f for f times as many photons; f and the mean of k make (P / f + Q)
/// (f rays of the photon pass + rays of the eye pass) least, Q being the eye samples' relative variance.
#pragma once

#include <cstdint>
#include <vector>

#include <pellucid/render/film.h>

namespace pellucid {

struct ShareLimits {
    float mostOfPixel = 32.0F;  ///< samples of one pixel in an iteration
    float mostMean = 8.0F;      ///< of an iteration, over the pixels
    double photonRays = 0.0;    ///< of an iteration, in units of an eye ray's time
    bool fixedPhotons = false;  ///< their number is not to be changed
};

struct SampleShares {
    std::vector<std::uint8_t> ofPixel;  ///< samples in an iteration, at least 1
    double photons = 1.0;               ///< photon paths, as a multiple of those of the iterations so far
    double lessNoise = 1.0;  ///< how many times less variance than an iteration of `before` it gives the image
};

/// `before`: samples of each pixel in the last iteration. `seed` keys the rounding.
[[nodiscard]] SampleShares sampleShares(const std::vector<PixelNoise>& noise, const std::vector<std::uint8_t>& before,
                                        int width, int height, const ShareLimits& limits, std::uint64_t seed);

}  // namespace pellucid

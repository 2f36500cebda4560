/// How far an image is from a reference. Definitions as in the contract of the command line.
#pragma once

#include <cstddef>

#include <pellucid/math/image.h>

namespace pellucid {

/// Of the pixels, the worst ones: a trimmed mean leaves them out.
inline constexpr double kTrimmedShare = 0.001;

struct Metrics {
    double rmse = 0.0;           ///< root of the mean of (I-R)^2 over pixels and channels
    double relmse = 0.0;         ///< mean of (I-R)^2 / (R^2 + 0.01 mean(R)^2)
    double relmseTrimmed = 0.0;  ///< relmse without the worst 0.1 % of pixels
    double smape = 0.0;          ///< mean of |I-R| / (|I|+|R|) x 2, 0 where both are 0
    double flip = 0.0;           ///< HDR-FLIP, mean over pixels [Andersson2021]
    double bias = 0.0;           ///< mean(I)/mean(R) - 1
    std::size_t nonfinite = 0;   ///< values of I or R left out because they are not finite
};

struct CropBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< half open, in pixels from the upper left corner
};

/// The crop of `image`; throws Error{Usage} when it is empty or leaves the image.
[[nodiscard]] Image crop(const Image& image, const CropBox& box);

/// Compares the channels R G B. `withFlip` false leaves flip at 0 (it costs more than all others together).
[[nodiscard]] Metrics compareImages(const Image& reference, const Image& image, bool withFlip = true);

/// Per-pixel relative squared error (mean over channels of the relmse term), one channel "Y".
[[nodiscard]] Image relativeErrorMap(const Image& reference, const Image& image);

/// Per-pixel HDR-FLIP error in [0, 1], one channel "Y".
[[nodiscard]] Image hdrFlipMap(const Image& reference, const Image& image);

}  // namespace pellucid

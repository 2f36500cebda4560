#include <pellucid/study/metrics.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <pellucid/base/error.h>
#include <pellucid/study/image_pair.h>

namespace pellucid {
namespace {

/// Sums over the values that count and are finite in both images.
struct ValueSums {
    double reference = 0.0, image = 0.0, squaredError = 0.0, symmetric = 0.0;
    std::size_t values = 0, nonfinite = 0;
};

[[nodiscard]] bool bothFinite(double r, double i) noexcept { return std::isfinite(r) && std::isfinite(i); }

[[nodiscard]] ValueSums sumValues(const ImagePair& pair) {
    ValueSums sums;
    for (std::size_t pixel = 0; pixel < pair.pixels(); ++pixel) {
        if (!pair.counts(pixel)) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const double r = pair.reference(pixel, c), i = pair.image(pixel, c);
            if (!bothFinite(r, i)) {
                ++sums.nonfinite;
                continue;
            }
            ++sums.values;
            sums.reference += r;
            sums.image += i;
            sums.squaredError += (i - r) * (i - r);
            const double size = std::abs(i) + std::abs(r);
            if (size > 0.0) sums.symmetric += 2.0 * std::abs(i - r) / size;
        }
    }
    return sums;
}

/// The quotient where 0 / 0 means no error.
[[nodiscard]] double ratio(double part, double whole) noexcept { return part == 0.0 ? 0.0 : part / whole; }

[[nodiscard]] double meanOf(double sum, std::size_t count) noexcept {
    return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

/// The terms of relmse of one pixel: their sum and their number (3 less the values that are not finite).
struct PixelError {
    double sum = 0.0;
    int values = 0;
    [[nodiscard]] double mean() const noexcept { return values == 0 ? 0.0 : sum / values; }
};

[[nodiscard]] PixelError pixelError(const ImagePair& pair, std::size_t pixel) noexcept {
    PixelError error;
    for (std::size_t c = 0; c < 3; ++c) {
        const double r = pair.reference(pixel, c), i = pair.image(pixel, c);
        if (!bothFinite(r, i)) continue;
        error.sum += ratio((i - r) * (i - r), r * r + pair.relativeFloor());
        ++error.values;
    }
    return error;
}

/// Mean of the errors without the worst 0.1 % (rounded down). Reorders `errors`.
[[nodiscard]] double trimmedMean(std::vector<double>& errors) {
    const auto left = static_cast<double>(errors.size()) * kTrimmedShare;
    const std::size_t kept = errors.size() - static_cast<std::size_t>(left);
    if (kept < errors.size())
        std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(kept), errors.end());
    const auto end = errors.begin() + static_cast<std::ptrdiff_t>(kept);
    return meanOf(std::accumulate(errors.begin(), end, 0.0), kept);
}

void addRelativeErrors(const ImagePair& pair, Metrics& metrics) {
    std::vector<double> errors;
    errors.reserve(pair.pixels());
    double sum = 0.0;
    std::size_t values = 0;
    for (std::size_t pixel = 0; pixel < pair.pixels(); ++pixel) {
        if (!pair.counts(pixel)) continue;
        const PixelError error = pixelError(pair, pixel);
        if (error.values == 0) continue;
        sum += error.sum;
        values += static_cast<std::size_t>(error.values);
        errors.push_back(error.mean());
    }
    metrics.relmse = meanOf(sum, values);
    metrics.relmseTrimmed = trimmedMean(errors);
}

/// Mean of the FLIP map over the pixels that count and are finite.
[[nodiscard]] double meanFlip(const ImagePair& pair, const Image& map) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t pixel = 0; pixel < pair.pixels(); ++pixel) {
        bool usable = pair.counts(pixel);
        for (std::size_t c = 0; c < 3; ++c)
            usable = usable && bothFinite(pair.reference(pixel, c), pair.image(pixel, c));
        if (!usable) continue;
        sum += static_cast<double>(map.at(pixel, 0));
        ++count;
    }
    return meanOf(sum, count);
}

}  // namespace

Image crop(const Image& image, const CropBox& box) {
    if (box.x0 < 0 || box.y0 < 0 || box.x1 > image.width() || box.y1 > image.height() || box.x0 >= box.x1 ||
        box.y0 >= box.y1)
        throw Error(ErrorKind::Usage, "the crop is empty or leaves the image",
                    "--crop " + std::to_string(box.x0) + "," + std::to_string(box.y0) + "," + std::to_string(box.x1) +
                        "," + std::to_string(box.y1),
                    "the image is " + std::to_string(image.width()) + "x" + std::to_string(image.height()) +
                        "; x1 and y1 lie one past the last pixel");
    Image result(box.x1 - box.x0, box.y1 - box.y0, image.channelNames());
    const auto channels = static_cast<std::ptrdiff_t>(image.channels());
    for (int y = box.y0; y < box.y1; ++y) {
        const auto from = image.data().begin() + (std::ptrdiff_t{y} * image.width() + box.x0) * channels;
        const auto to = result.data().begin() + std::ptrdiff_t{y - box.y0} * result.width() * channels;
        std::copy_n(from, std::ptrdiff_t{result.width()} * channels, to);
    }
    return result;
}

Metrics compareImages(const Image& reference, const Image& image, bool withFlip) {
    const ImagePair pair(reference, image);
    const ValueSums sums = sumValues(pair);
    Metrics metrics;
    metrics.nonfinite = sums.nonfinite;
    metrics.rmse = std::sqrt(meanOf(sums.squaredError, sums.values));
    metrics.smape = meanOf(sums.symmetric, sums.values);
    metrics.bias = ratio(sums.image - sums.reference, sums.reference);
    addRelativeErrors(pair, metrics);
    if (withFlip) metrics.flip = meanFlip(pair, hdrFlipMap(reference, image));
    return metrics;
}

Image relativeErrorMap(const Image& reference, const Image& image) {
    const ImagePair pair(reference, image);
    Image map(pair.width(), pair.height(), {"Y"});
    for (std::size_t pixel = 0; pixel < pair.pixels(); ++pixel)
        if (pair.counts(pixel)) map.at(pixel, 0) = static_cast<float>(pixelError(pair, pixel).mean());
    return map;
}

}  // namespace pellucid

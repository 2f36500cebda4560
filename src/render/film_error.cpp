// What the film shows of itself: means, and how far they are from their limit.
#include <algorithm>
#include <cmath>

#include <pellucid/render/film.h>

namespace pellucid {

Rgb Film::mean(const Pixel& p, int layer) const noexcept {
    Rgb value(0.0F);
    for (glm::length_t c = 0; c < 3; ++c) {
        double v = p.layer[layer][c] / terms_.divisor();
        if (splatPasses_ > 0) v += p.splat[layer][c] / splatPasses_;
        value[c] = static_cast<float>(v);
    }
    return value;
}

double Film::luminanceOf(const Pixel& p) const noexcept {
    Rgb sum(0.0F);
    for (int l = 0; l < kPathClasses; ++l) sum += mean(p, l);
    return static_cast<double>(luminance(sum));
}

double Film::luminanceAt(int x, int y) const noexcept {
    return luminanceOf(
        pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)]);
}

double Film::meanLuminance() const noexcept {
    double sum = 0.0;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) sum += luminanceAt(x, y);
    return sum / static_cast<double>(std::max<std::size_t>(1, pixels_.size()));
}

double Film::indirectShare() const noexcept {
    const double floor = 0.1 * meanLuminance();
    double sum = 0.0;
    for (const Pixel& p : pixels_) {
        const double value = luminanceOf(p) + floor;
        if (value > 0.0) sum += static_cast<double>(luminance(mean(p, static_cast<int>(PathClass::Indirect)))) / value;
    }
    return sum / static_cast<double>(std::max<std::size_t>(1, pixels_.size()));
}

/// Of the pixel's mean luminance: of a weighted mean sum w^2 (y - mean)^2 / (sum w)^2, times n / (n - 1); and that of the
/// passes' splats, which are taken as independent of the rest.
double Film::variance(const Pixel& p) const noexcept {
    const auto meanOf = [](const double(&layers)[kPathClasses][3], double divisor) {
        double sum = 0.0;
        for (const auto& l : layers) sum += 0.2126 * l[0] + 0.7152 * l[1] + 0.0722 * l[2];
        return sum / divisor;
    };
    const double n = terms_.count, w = terms_.divisor(), m = meanOf(p.layer, w);
    const double spread = p.squareSquare - 2.0 * m * p.squareSum + m * m * terms_.squares;
    const double passes = std::max<std::uint32_t>(1, splatPasses_), s = meanOf(p.splat, passes);
    return std::max(0.0, spread) / (w * w) * (n / std::max(1.0, n - 1.0)) +
           std::max(0.0, p.splatSquare / passes - s * s) / std::max(1.0, passes - 1.0);
}

/// An iteration's mean of k samples has the variance of a sample over k: so k (mean - expectation)^2 has that of a sample.
PixelNoise Film::noise(std::size_t pixel) const noexcept {
    const Pixel& p = pixels_[pixel];
    const double n = terms_.count, free = std::max(1.0, n - 1.0), taken = std::max<std::uint32_t>(1, p.taken);
    PixelNoise noise;
    noise.eyeVariance = static_cast<float>(std::max(0.0, p.eyeSquare - p.eyeSum * p.eyeSum / taken) / free);
    noise.photonVariance =
        static_cast<float>(std::max(0.0, p.sharedSquare - p.sharedSum * p.sharedSum / std::max(1.0, n)) / free);
    noise.luminance = static_cast<float>(p.eyeSum / taken + p.sharedSum / std::max(1.0, n));
    noise.rays = static_cast<float>(static_cast<double>(p.rays) / taken);
    noise.blur2 = static_cast<float>(blur2(p));
    noise.inside = p.taken > 0;
    return noise;
}

/// Square of the kernels' bias, as the product of what odd and even iterations say.
double Film::blur2(const Pixel& p) const noexcept {
    const double odd = terms_.odd, even = terms_.sum - terms_.odd;
    return odd > 0.0 && even > 0.0 ? p.blurHalf / odd * ((p.blur - p.blurHalf) / even) : 0.0;
}

template <class Square>
double Film::relative(const Square& square) const noexcept {
    double meanValue = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < pixels_.size(); ++i) meanValue += luminanceOf(pixels_[i]);
    meanValue /= static_cast<double>(pixels_.size());
    const double floor = std::max(0.01 * meanValue * meanValue, 1e-300);
    for (const Pixel& p : pixels_) {
        const double value = luminanceOf(p);
        sum += square(p) / (value * value + floor);
    }
    return std::max(0.0, sum / static_cast<double>(pixels_.size()));
}

double Film::relativeBlur2() const noexcept {
    if (terms_.count < 2) return 0.0;
    return relative([this](const Pixel& p) { return blur2(p); });
}

double Film::relativeRecordNoise2() const noexcept {
    return relative([this](const Pixel& p) { return std::pow(p.recordNoise / terms_.divisor(), 2.0); });
}

double Film::relativeNoise2() const noexcept {
    const double odd = terms_.odd, even = terms_.sum - terms_.odd;
    if (terms_.count < 2) return 1.0;
    const double oddPasses = splatPasses_ / 2, evenPasses = splatPasses_ - splatPasses_ / 2;
    double meanValue = 0.0;
    std::vector<double> value(pixels_.size() * 3), difference(pixels_.size() * 3);
    for (std::size_t i = 0; i < pixels_.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const Pixel& p = pixels_[i];
            double sum = 0.0;
            for (const auto& l : p.layer) sum += l[c];
            double a = p.half[c] / odd, b = (sum - p.half[c]) / even;
            if (oddPasses >= 1.0) {
                double splats = 0.0;
                for (const auto& l : p.splat) splats += l[c];
                a += p.splatHalf[c] / oddPasses;
                b += (splats - p.splatHalf[c]) / evenPasses;
            }
            value[3 * i + c] = 0.5 * (a + b);
            difference[3 * i + c] = 0.5 * (a - b);
            meanValue += value[3 * i + c];
        }
    meanValue /= static_cast<double>(value.size());
    const double floor = 0.01 * meanValue * meanValue;
    double sum = 0.0;
    for (std::size_t i = 0; i < value.size(); ++i) {
        const double d2 = difference[i] * difference[i], v2 = value[i] * value[i] + floor;
        if (v2 > 0.0) sum += d2 / v2;
    }
    return sum / static_cast<double>(value.size());
}

}  // namespace pellucid

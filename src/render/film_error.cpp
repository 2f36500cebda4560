// What the film shows of itself: means, and how far they are from their limit.
#include <algorithm>
#include <cmath>

#include <pellucid/render/film.h>

namespace pellucid {

Rgb Film::mean(const Pixel& p, int layer) const noexcept {
    Rgb value(0.0F);
    const double n = std::max<std::uint32_t>(1, samples_);
    for (glm::length_t c = 0; c < 3; ++c) {
        double v = p.layer[layer][c] / n;
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

/// Of the pixel's mean luminance: sample variance over the number of samples, of the eye's samples and of the passes'
/// splats, which are taken as independent of each other.
double Film::variance(const Pixel& p) const noexcept {
    const auto ofMean = [](const double(&layers)[kPathClasses][3], double square, double count) {
        double sum = 0.0;
        for (const auto& l : layers) sum += 0.2126 * l[0] + 0.7152 * l[1] + 0.0722 * l[2];
        const double m = sum / count;
        return std::max(0.0, square / count - m * m) / std::max(1.0, count - 1.0);
    };
    return ofMean(p.layer, p.square, std::max<std::uint32_t>(1, samples_)) +
           ofMean(p.splat, p.splatSquare, std::max<std::uint32_t>(1, splatPasses_));
}

/// An iteration's mean of k samples has the variance of a sample over k: so k (mean - expectation)^2 has that of a sample.
PixelNoise Film::noise(std::size_t pixel) const noexcept {
    const Pixel& p = pixels_[pixel];
    const double n = samples_, free = std::max(1.0, n - 1.0), taken = std::max<std::uint32_t>(1, p.taken);
    PixelNoise noise;
    noise.eyeVariance = static_cast<float>(std::max(0.0, p.eyeSquare - p.eyeSum * p.eyeSum / taken) / free);
    noise.photonVariance =
        static_cast<float>(std::max(0.0, p.sharedSquare - p.sharedSum * p.sharedSum / std::max(1.0, n)) / free);
    noise.luminance = static_cast<float>(p.eyeSum / taken + p.sharedSum / std::max(1.0, n));
    noise.rays = static_cast<float>(static_cast<double>(p.rays) / taken);
    const double odd = std::max<std::uint32_t>(1, samples_ / 2),
                 even = std::max<std::uint32_t>(1, samples_ - samples_ / 2);
    noise.blur2 = static_cast<float>(p.blurHalf / odd * ((p.blur - p.blurHalf) / even));
    noise.inside = p.taken > 0;
    return noise;
}

double Film::relativeBlur2() const noexcept {
    const double odd = samples_ / 2, even = samples_ - samples_ / 2;
    if (odd < 1.0) return 0.0;
    double meanValue = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < pixels_.size(); ++i) meanValue += luminanceOf(pixels_[i]);
    meanValue /= static_cast<double>(pixels_.size());
    const double floor = std::max(0.01 * meanValue * meanValue, 1e-300);
    for (const Pixel& p : pixels_) {
        const double value = luminanceOf(p);
        sum += p.blurHalf / odd * ((p.blur - p.blurHalf) / even) / (value * value + floor);
    }
    return std::max(0.0, sum / static_cast<double>(pixels_.size()));
}

double Film::relativeNoise2() const noexcept {
    const double odd = samples_ / 2, even = samples_ - samples_ / 2;
    if (odd < 1.0) return 1.0;
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

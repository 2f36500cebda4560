/// Do two renderers mean the same image? Each renders it with several seeds; a pixel (or a block of pixels) gets Welch's
/// t-test [Welch1947]. Over the image the p-values must be uniform (chi^2 over ten bins), their least one no smaller than
/// that many tests allow (Sidak), and the whole image's mean, a test by itself, must agree.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include <pellucid/math/rgb.h>
#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>

#include "chi_square.h"

namespace pellucid::testing {

/// Regularised incomplete beta function I_x(a, b) by Lentz's continued fraction. [DLMF 8.17.22]
inline double incompleteBeta(double a, double b, double x) {
    if (x <= 0.0) return 0.0;
    if (x >= 1.0) return 1.0;
    if (x > (a + 1.0) / (a + b + 2.0)) return 1.0 - incompleteBeta(b, a, 1.0 - x);
    const double front =
        std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x)) / a;
    double c = 1.0, d = 1.0 - (a + b) * x / (a + 1.0);
    d = 1.0 / d;
    double f = d;
    for (int m = 1; m < 500; ++m) {
        for (const double term : {m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
                                  -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))}) {
            d = 1.0 / (1.0 + term * d);
            c = 1.0 + term / c;
            f *= c * d;
        }
        if (std::fabs(c * d - 1.0) < 1e-14) break;
    }
    return front * f;
}

/// Two-sided tail of Student's t. [DLMF 8.17]
inline double studentTail(double t, double dof) { return incompleteBeta(0.5 * dof, 0.5, dof / (dof + t * t)); }

/// What is compared of each seed's image: values[seed][cell].
using SeedValues = std::vector<std::vector<double>>;

/// Means of the three channels over blocks of `block` x `block` pixels; `layer` empty: all light.
inline std::vector<double> blockMeans(const Image& image, int block, const std::string& layer = {}) {
    const int bx = (image.width() + block - 1) / block, by = (image.height() + block - 1) / block;
    std::vector<double> sum(static_cast<std::size_t>(bx * by), 0.0), count(sum.size(), 0.0);
    const std::string prefix = layer.empty() ? "" : layer + ".";
    const std::vector<std::string> names = image.channelNames();
    for (const char* c : {"R", "G", "B"}) {
        if (std::find(names.begin(), names.end(), prefix + c) == names.end()) continue;
        const int channel = image.channel(prefix + c);
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                const auto cell = static_cast<std::size_t>(y / block * bx + x / block);
                sum[cell] += static_cast<double>(image.at(static_cast<std::size_t>(y * image.width() + x), channel));
                count[cell] += 1.0;
            }
    }
    for (std::size_t i = 0; i < sum.size(); ++i)
        if (count[i] > 0.0) sum[i] /= count[i];
    return sum;
}

struct Rendering {
    Method method = Method::Path;
    std::uint32_t samples = 16;
    int seeds = 8;
    std::uint64_t firstSeed = 1;
    Settings settings = {};
    int width = 32, height = 32;
    std::vector<std::string> layers = {};
    std::string camera = {};

    /// The same image by another method and from other seeds on.
    [[nodiscard]] Rendering by(Method other, std::uint32_t itsSamples, std::uint64_t itsFirstSeed) const {
        Rendering r = *this;
        r.method = other;
        r.samples = itsSamples;
        r.firstSeed = itsFirstSeed;
        return r;
    }
};

inline std::vector<Image> renderSeeds(const Scene& scene, const Rendering& what, const Workers& workers) {
    std::vector<Image> images;
    for (int s = 0; s < what.seeds; ++s) {
        RenderRequest request;
        request.method = what.method;
        request.width = what.width;
        request.height = what.height;
        request.camera = what.camera;
        request.seed = what.firstSeed + static_cast<std::uint64_t>(s);
        request.budget.samples = what.samples;
        request.settings = what.settings;
        request.layers = what.layers;
        images.push_back(render(scene, request, workers).image);
    }
    return images;
}

inline SeedValues valuesOf(const std::vector<Image>& images, int block, const std::string& layer = {}) {
    SeedValues values;
    for (const Image& image : images) values.push_back(blockMeans(image, block, layer));
    return values;
}

/// Mean and variance of the mean over seeds.
struct MeanOfSeeds {
    double mean = 0.0, variance = 0.0;
    int seeds = 0;
};
inline MeanOfSeeds meanOfSeeds(const std::vector<double>& values) {
    MeanOfSeeds m;
    m.seeds = static_cast<int>(values.size());
    for (const double v : values) m.mean += v / m.seeds;
    for (const double v : values) m.variance += (v - m.mean) * (v - m.mean);
    m.variance /= static_cast<double>(m.seeds) * (m.seeds - 1.0);
    return m;
}
inline MeanOfSeeds cellOverSeeds(const SeedValues& values, std::size_t cell) {
    std::vector<double> v;
    for (const auto& seed : values) v.push_back(seed[cell]);
    return meanOfSeeds(v);
}
inline MeanOfSeeds imageOverSeeds(const SeedValues& values) {
    std::vector<double> v;
    for (const auto& seed : values) {
        double sum = 0.0;
        for (const double x : seed) sum += x / static_cast<double>(seed.size());
        v.push_back(sum);
    }
    return meanOfSeeds(v);
}

/// Welch's p-value; 1 where both are the same constant.
inline double welch(const MeanOfSeeds& a, const MeanOfSeeds& b) {
    const double variance = a.variance + b.variance, difference = a.mean - b.mean;
    // What float sums round off is no difference.
    const double rounding = 1e-6 * (std::fabs(a.mean) + std::fabs(b.mean));
    if (variance <= rounding * rounding) return std::fabs(difference) <= 10.0 * rounding ? 1.0 : 0.0;
    const double dof =
        variance * variance / (a.variance * a.variance / (a.seeds - 1) + b.variance * b.variance / (b.seeds - 1));
    return studentTail(difference / std::sqrt(variance), dof);
}

struct Agreement {
    double ratio = 1.0;     ///< of the means of the whole image, b over a
    double error = 0.0;     ///< standard error of that ratio
    double pMean = 1.0;     ///< of the means being equal
    double pUniform = 1.0;  ///< of the cells' p-values being uniform
    double pLeast = 1.0;    ///< of the least of them being that small
    int cells = 0;
    [[nodiscard]] bool holds(double level) const { return pMean > level && pUniform > level && pLeast > level; }
};

inline std::ostream& operator<<(std::ostream& out, const Agreement& a) {
    return out << "mean ratio " << a.ratio << " +- " << a.error << " (p " << a.pMean << "), " << a.cells
               << " cells: uniform p " << a.pUniform << ", least p " << a.pLeast;
}

inline Agreement agreementOf(const SeedValues& a, const SeedValues& b) {
    Agreement result;
    const MeanOfSeeds wholeA = imageOverSeeds(a), wholeB = imageOverSeeds(b);
    result.ratio = wholeA.mean != 0.0 ? wholeB.mean / wholeA.mean : 1.0;
    result.error = wholeA.mean != 0.0 ? std::sqrt(wholeA.variance + wholeB.variance) / std::fabs(wholeA.mean) : 0.0;
    result.pMean = welch(wholeA, wholeB);
    std::vector<double> bins(10, 0.0);
    double least = 1.0;
    for (std::size_t i = 0; i < a.front().size(); ++i) {
        const MeanOfSeeds x = cellOverSeeds(a, i), y = cellOverSeeds(b, i);
        const double p = welch(x, y);
        if (x.variance + y.variance <= 0.0 && p == 1.0) continue;  // nothing to be seen there
        ++result.cells;
        least = std::min(least, p);
        bins[static_cast<std::size_t>(std::min(9.0, p * 10.0))] += 1.0;
    }
    if (result.cells < 10) return result;
    double chi2 = 0.0;
    for (const double o : bins) chi2 += (o - result.cells / 10.0) * (o - result.cells / 10.0) / (result.cells / 10.0);
    result.pUniform = chiSquareTail(chi2, 9.0);
    result.pLeast = 1.0 - std::pow(1.0 - least, result.cells);
    return result;
}

}  // namespace pellucid::testing

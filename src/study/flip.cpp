// HDR-FLIP: the difference that a viewer sees when two images alternate, at the worst exposure of a range.
// [Andersson2020] P. Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020.
// [Andersson2021] P. Andersson et al., "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics 2021.
// All filters are sums of products of one-dimensional ones, so that each costs two passes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <pellucid/math/constants.h>
#include <pellucid/study/image_pair.h>
#include <pellucid/study/metrics.h>
#include <pellucid/study/separable_filter.h>

namespace pellucid {
namespace {

constexpr float kPixelsPerDegree = 67.0F;  // a 0.7 m wide display of 3840 pixels seen from 0.7 m
constexpr float kColourExponent = 0.7F;    // q_c
constexpr float kColourKnee = 0.4F;        // p_c
constexpr float kColourKneeValue = 0.95F;  // p_t
constexpr float kFeatureExponent = 0.5F;   // q_f
constexpr float kFeatureWidth = 0.082F;    // w, degrees

// ---- contrast sensitivity ([Andersson2020], spatial filtering) ------------------------------------------------------

/// One Gaussian of a channel's filter: a sqrt(pi/b) exp(-pi^2 x^2 / b), x in degrees.
struct SensitivityTerm {
    float a, b;
};

/// sum_k weight_k g_k(x) g_k(y), of total weight one.
struct SensitivityFilter {
    std::vector<Kernel> kernels;
    std::vector<float> weights;
};

[[nodiscard]] SensitivityFilter sensitivityFilter(const std::vector<SensitivityTerm>& terms) {
    constexpr float kWidestTerm = 0.04F;
    // three standard deviations of the widest term of all channels
    const int radius =
        static_cast<int>(std::ceil(3.0F * std::sqrt(kWidestTerm / (2.0F * kPi * kPi)) * kPixelsPerDegree));
    SensitivityFilter filter;
    float total = 0.0F;
    for (const SensitivityTerm& term : terms) {
        filter.kernels.push_back(makeKernel(radius, [&term](float pixels) {
            const float x = pixels / kPixelsPerDegree;
            return std::exp(-kPi * kPi * x * x / term.b);
        }));
        float sum = 0.0F;
        for (const float w : filter.kernels.back()) sum += w;
        filter.kernels.back() = normalised(std::move(filter.kernels.back()));
        filter.weights.push_back(term.a * std::sqrt(kPi / term.b) * sum * sum);
        total += filter.weights.back();
    }
    for (float& w : filter.weights) w /= total;
    return filter;
}

[[nodiscard]] Plane apply(const SensitivityFilter& filter, const Plane& in, const PlaneSize& size) {
    Plane out = convolve(in, size, filter.kernels[0], filter.kernels[0]);
    for (float& value : out) value *= filter.weights[0];
    for (std::size_t k = 1; k < filter.kernels.size(); ++k) {
        const Plane term = convolve(in, size, filter.kernels[k], filter.kernels[k]);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] += filter.weights[k] * term[i];
    }
    return out;
}

struct Filters {
    /// Achromatic, red-green, blue-yellow.
    std::array<SensitivityFilter, 3> sensitivity{sensitivityFilter({{1.0F, 0.0047F}}),
                                                 sensitivityFilter({{1.0F, 0.0053F}}),
                                                 sensitivityFilter({{34.1F, 0.04F}, {13.5F, 0.025F}})};
    /// A Gaussian and its first and second derivative: edge and point detectors.
    Kernel smooth, edge, point;

    Filters() {
        const float sigma = 0.5F * kFeatureWidth * kPixelsPerDegree;
        const int radius = static_cast<int>(std::ceil(3.0F * sigma));
        const auto gauss = [sigma](float x) { return std::exp(-x * x / (2.0F * sigma * sigma)); };
        smooth = normalised(makeKernel(radius, gauss));
        edge = normalised(makeKernel(radius, [&](float x) { return -x * gauss(x); }));
        point = normalised(makeKernel(radius, [&](float x) { return (x * x / (sigma * sigma) - 1.0F) * gauss(x); }));
    }
};

// ---- colour ------------------------------------------------------------------------------------------------------

/// CIE XYZ relative to the white of Rec.709 (D65), so that white is (1, 1, 1).
const glm::vec3 kWhite{0.9504559F, 1.0F, 1.0890578F};

[[nodiscard]] glm::vec3 toRelativeXyz(const Rgb& c) noexcept {
    return glm::vec3{0.4123908F * c.r + 0.3575843F * c.g + 0.1804808F * c.b,
                     0.2126390F * c.r + 0.7151687F * c.g + 0.0721923F * c.b,
                     0.0193308F * c.r + 0.1191948F * c.g + 0.9505322F * c.b} /
           kWhite;
}

[[nodiscard]] Rgb fromRelativeXyz(const glm::vec3& relative) noexcept {
    const glm::vec3 c = relative * kWhite;
    return {3.2409699F * c.x - 1.5373832F * c.y - 0.4986108F * c.z,
            -0.9692436F * c.x + 1.8759675F * c.y + 0.0415551F * c.z,
            0.0556301F * c.x - 0.2039770F * c.y + 1.0569715F * c.z};
}

/// The linear opponent space in which the eye's filters act.
[[nodiscard]] glm::vec3 toYCxCz(const Rgb& c) noexcept {
    const glm::vec3 xyz = toRelativeXyz(c);
    return {116.0F * xyz.y - 16.0F, 500.0F * (xyz.x - xyz.y), 200.0F * (xyz.y - xyz.z)};
}

[[nodiscard]] Rgb fromYCxCz(const glm::vec3& c) noexcept {
    const float y = (c.x + 16.0F) / 116.0F;
    return fromRelativeXyz({y + c.y / 500.0F, y, y - c.z / 200.0F});
}

/// CIELAB with the Hunt effect: chroma counts less where it is dark.
[[nodiscard]] glm::vec3 toHuntLab(const Rgb& c) noexcept {
    constexpr float kDelta = 6.0F / 29.0F;
    const auto compress = [](float t) {
        return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0F * kDelta * kDelta) + 4.0F / 29.0F;
    };
    const glm::vec3 xyz = toRelativeXyz(c);
    const float fx = compress(xyz.x), fy = compress(xyz.y), fz = compress(xyz.z);
    const float lightness = 116.0F * fy - 16.0F;
    return {lightness, 0.01F * lightness * 500.0F * (fx - fy), 0.01F * lightness * 200.0F * (fy - fz)};
}

/// HyAB distance for large colour differences, compressed by its exponent.
[[nodiscard]] float colourDistance(const glm::vec3& a, const glm::vec3& b) noexcept {
    const glm::vec3 d = a - b;
    return std::pow(std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z), kColourExponent);
}

/// Maps distances to [0, 1]: the lower part of the range takes nearly all of it.
[[nodiscard]] float redistribute(float distance) noexcept {
    static const float largest = colourDistance(toHuntLab({0.0F, 1.0F, 0.0F}), toHuntLab({0.0F, 0.0F, 1.0F}));
    const float knee = kColourKnee * largest;
    if (distance < knee) return kColourKneeValue / knee * distance;
    return kColourKneeValue + (distance - knee) / (largest - knee) * (1.0F - kColourKneeValue);
}

// ---- one exposure ------------------------------------------------------------------------------------------------

/// What FLIP compares of one displayed image: filtered colour and the strength of edges and points.
struct Percept {
    std::vector<glm::vec3> colour;
    Plane edges, points;
};

[[nodiscard]] Plane gradientLength(const Plane& grey, const PlaneSize& size, const Kernel& derivative,
                                   const Kernel& smooth) {
    Plane alongX = convolve(grey, size, derivative, smooth);
    const Plane alongY = convolve(grey, size, smooth, derivative);
    for (std::size_t i = 0; i < alongX.size(); ++i)
        alongX[i] = std::sqrt(alongX[i] * alongX[i] + alongY[i] * alongY[i]);
    return alongX;
}

[[nodiscard]] Percept perceive(const std::vector<Rgb>& displayed, const PlaneSize& size, const Filters& filters) {
    std::array<Plane, 3> opponent{Plane(displayed.size()), Plane(displayed.size()), Plane(displayed.size())};
    Plane grey(displayed.size());
    for (std::size_t i = 0; i < displayed.size(); ++i) {
        const glm::vec3 c = toYCxCz(displayed[i]);
        for (int k = 0; k < 3; ++k) opponent[static_cast<std::size_t>(k)][i] = c[k];
        grey[i] = (c.x + 16.0F) / 116.0F;
    }
    for (std::size_t k = 0; k < 3; ++k) opponent[k] = apply(filters.sensitivity[k], opponent[k], size);
    Percept percept;
    percept.colour.reserve(displayed.size());
    for (std::size_t i = 0; i < displayed.size(); ++i) {
        const Rgb seen = fromYCxCz({opponent[0][i], opponent[1][i], opponent[2][i]});
        percept.colour.push_back(toHuntLab(glm::clamp(seen, 0.0F, 1.0F)));
    }
    percept.edges = gradientLength(grey, size, filters.edge, filters.smooth);
    percept.points = gradientLength(grey, size, filters.point, filters.smooth);
    return percept;
}

/// LDR-FLIP of one pixel: colour error raised where features differ, dE = dEc^(1 - dEf).
[[nodiscard]] float flipError(const Percept& a, const Percept& b, std::size_t i) noexcept {
    const float colour = redistribute(colourDistance(a.colour[i], b.colour[i]));
    const float difference = std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
    const float feature = std::pow(difference / std::sqrt(2.0F), kFeatureExponent);
    return std::clamp(std::pow(colour, 1.0F - feature), 0.0F, 1.0F);
}

// ---- exposures ([Andersson2021]) ------------------------------------------------------------------------------------

/// The ACES curve as fitted by K. Narkowicz (2015), with its exposure of 0.6: (x (p2 x + p1)) / (x (q2 x + q1) + q0).
struct ToneCurve {
    static constexpr float p2 = 0.6F * 0.6F * 2.51F, p1 = 0.6F * 0.03F;
    static constexpr float q2 = 0.6F * 0.6F * 2.43F, q1 = 0.6F * 0.59F, q0 = 0.14F;

    [[nodiscard]] static float map(float x) noexcept {
        x = std::max(x, 0.0F);
        if (x > 1e9F) return 1.0F;  // squares would overflow; the curve has passed 1 long before
        return std::clamp(x * (p2 * x + p1) / (x * (q2 * x + q1) + q0), 0.0F, 1.0F);
    }
    /// The positive x that maps to `shown`: a quadratic equation.
    [[nodiscard]] static float inverse(float shown) noexcept {
        const float a = p2 - shown * q2, b = p1 - shown * q1, c = -shown * q0;
        return (-b + std::sqrt(b * b - 4.0F * a * c)) / (2.0F * a);
    }
};

struct Exposures {
    float start = 0.0F, stop = 0.0F;
    int count = 2;
    [[nodiscard]] float at(int i) const noexcept {
        return start + (stop - start) * static_cast<float>(i) / static_cast<float>(count - 1);
    }
};

/// From the exposure that shows the reference's maximum at 85 % to the one that shows its median there. The median is
/// that of the lit pixels when half the image is black (the paper leaves this open).
[[nodiscard]] Exposures exposuresFor(const std::vector<Rgb>& reference) {
    constexpr float kShown = 0.85F;
    std::vector<float> lit;
    lit.reserve(reference.size());
    for (const Rgb& c : reference) lit.push_back(luminance(c));
    std::sort(lit.begin(), lit.end());
    const auto medianOf = [&lit] { return 0.5F * (lit[(lit.size() - 1) / 2] + lit[lit.size() / 2]); };
    if (lit.empty() || lit.back() <= 0.0F) return {};
    if (medianOf() <= 0.0F) lit.erase(lit.begin(), std::upper_bound(lit.begin(), lit.end(), 0.0F));
    const float shown = std::log2(ToneCurve::inverse(kShown));
    Exposures exposures{shown - std::log2(lit.back()), shown - std::log2(medianOf()), 2};
    exposures.count = std::max(2, static_cast<int>(std::ceil(exposures.stop - exposures.start)));
    return exposures;
}

[[nodiscard]] std::vector<Rgb> display(const std::vector<Rgb>& image, float exposure) {
    const float factor = std::exp2(exposure);
    std::vector<Rgb> displayed;
    displayed.reserve(image.size());
    for (const Rgb& c : image)
        displayed.emplace_back(ToneCurve::map(factor * c.r), ToneCurve::map(factor * c.g),
                               ToneCurve::map(factor * c.b));
    return displayed;
}

}  // namespace

Image hdrFlipMap(const Image& reference, const Image& image) {
    const ImagePair pair(reference, image);
    const PlaneSize size{pair.width(), pair.height()};
    std::vector<Rgb> expected(size.pixels()), seen(size.pixels());
    // Pixels that do not count, or are not finite, are made equal: they must not bleed into their neighbours.
    for (std::size_t i = 0; i < size.pixels(); ++i) {
        const Rgb r{pair.reference(i, 0), pair.reference(i, 1), pair.reference(i, 2)};
        const Rgb t{pair.image(i, 0), pair.image(i, 1), pair.image(i, 2)};
        expected[i] = isFinite(r) ? r : Rgb(0.0F);
        seen[i] = pair.counts(i) && isFinite(r) && isFinite(t) ? t : expected[i];
    }
    const Filters filters;
    const Exposures exposures = exposuresFor(expected);
    Image map(size.width, size.height, {"Y"});
    for (int e = 0; e < exposures.count; ++e) {
        const Percept a = perceive(display(expected, exposures.at(e)), size, filters);
        const Percept b = perceive(display(seen, exposures.at(e)), size, filters);
        for (std::size_t i = 0; i < size.pixels(); ++i) map.at(i, 0) = std::max(map.at(i, 0), flipError(a, b, i));
    }
    return map;
}

}  // namespace pellucid

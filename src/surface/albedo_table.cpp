#include <pellucid/surface/albedo_table.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/glm.hpp>

#include <pellucid/surface/fresnel.h>
#include <pellucid/surface/microfacet.h>

namespace pellucid {

namespace {

constexpr int kCosines = 32;         ///< a curve's nodes, denser towards grazing
constexpr int kPoints = 14;          ///< per axis of the quadrature
constexpr int kSmoothCosines = 512;  ///< the smooth curve is cheap
constexpr double kMargin = 4e-4;     ///< above the quadrature's error and what lies between the nodes

struct CurvePoint {
    double s = 0.0;  ///< (1 - c)^5
    double albedo = 0.0;
};

double curve(float cosTheta, float eta) noexcept {
    return eta < 0.0F ? 1.0 : std::max(0.0, static_cast<double>(fresnelCurve(cosTheta, eta)));
}

/// The line e0 + e1 s of least mean over the hemisphere (int s 2c dc = 1/21) that no point exceeds. For a given slope
/// e1 the offset follows, and the mean is convex in e1: golden section. Slopes that would pass 1 at grazing are left
/// out.
AlbedoBound boundFrom(const std::vector<CurvePoint>& points) {
    double steepest = 1.0;
    for (const CurvePoint& p : points)
        if (p.s < 1.0) steepest = std::min(steepest, (1.0 - p.albedo) / (1.0 - p.s));
    steepest = std::max(0.0, steepest);
    const auto offset = [&](double e1) {
        double e0 = 0.0;
        for (const CurvePoint& p : points) e0 = std::max(e0, p.albedo - e1 * p.s);
        return e0;
    };
    constexpr double kGolden = 0.6180339887498949;
    double low = 0.0, high = steepest;
    for (int i = 0; i < 24; ++i) {
        const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
        (offset(a) + a / 21.0 < offset(b) + b / 21.0 ? high : low) =
            offset(a) + a / 21.0 < offset(b) + b / 21.0 ? b : a;
    }
    const double e1 = 0.5 * (low + high);
    const double e0 = std::min(offset(e1) + kMargin, 1.0 - e1);
    return {static_cast<float>(e0), static_cast<float>(e1)};
}

CurvePoint pointAt(double cosTheta, double albedo) { return {std::pow(1.0 - cosTheta, 5.0), albedo}; }

std::vector<CurvePoint> smoothCurve(float eta) {
    std::vector<CurvePoint> points;
    for (int i = 0; i <= kSmoothCosines; ++i) {
        const double c = std::pow(static_cast<double>(i) / kSmoothCosines, 2.0);
        points.push_back(pointAt(c, curve(static_cast<float>(c), eta)));
    }
    return points;
}

std::vector<CurvePoint> roughCurve(float alpha, float eta) {
    std::vector<CurvePoint> points;
    for (int i = 0; i < kCosines; ++i) {
        const double t = static_cast<double>(i) / (kCosines - 1);
        const double c = std::max(1e-4, t * t);
        points.push_back(pointAt(c, ggxAlbedo(static_cast<float>(c), alpha, eta, kPoints)));
    }
    return points;
}

AlbedoBound mix(const AlbedoBound& a, float weightA, const AlbedoBound& b, float weightB) noexcept {
    return {weightA * a.e0 + weightB * b.e0, weightA * a.e1 + weightB * b.e1};
}

}  // namespace

double ggxAlbedo(float cosTheta, float alpha, float eta, int n) {
    const glm::vec3 wo{std::sqrt(std::max(0.0F, 1.0F - cosTheta * cosTheta)), 0.0F, cosTheta};
    const float slopeO = ggxSlope(wo, alpha);
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            // Half the azimuth is enough: the facets are symmetric about the plane of incidence.
            const glm::vec2 u{(static_cast<float>(i) + 0.5F) / static_cast<float>(2 * n),
                              (static_cast<float>(j) + 0.5F) / static_cast<float>(n)};
            const glm::vec3 h = sampleGgxVisibleNormal(wo, alpha, u);
            const float cosH = std::min(1.0F, glm::dot(wo, h));
            const float cosI = 2.0F * cosH * h.z - wo.z;
            if (!(cosI > 0.0F)) continue;
            const glm::vec3 wi = 2.0F * cosH * h - wo;
            // G2 / G1(wo), the weight of a visible normal. [Heitz2018, eq. 19]
            const float weight = 2.0F * cosI * (wo.z + slopeO) * ggxVisibility(wo, wi, alpha);
            sum += static_cast<double>(weight) * curve(cosH, eta);
        }
    return sum / (n * n);
}

AlbedoTable::AlbedoTable(float eta) : smooth_(boundFrom(smoothCurve(eta))) {
    // Curves at the nodes and half-way between them; a node bounds all that lies within one step of it.
    constexpr int kCurves = 2 * kSteps - 1;
    std::array<std::vector<CurvePoint>, kCurves> curves;
    for (int i = 0; i < kCurves; ++i) {
        const float roughness = static_cast<float>(i) / static_cast<float>(kCurves - 1);
        auto& points = curves[static_cast<std::size_t>(i)];
        points = i == 0 ? smoothCurve(eta) : roughCurve(roughness * roughness, eta);
    }
    for (int node = 0; node < kSteps; ++node) {
        std::vector<CurvePoint> around;
        for (int i = std::max(0, 2 * node - 2); i <= std::min(kCurves - 1, 2 * node + 2); ++i) {
            const auto& points = curves[static_cast<std::size_t>(i)];
            around.insert(around.end(), points.begin(), points.end());
        }
        nodes_[static_cast<std::size_t>(node)] = boundFrom(around);
    }
}

AlbedoBound AlbedoTable::rough(float roughness) const noexcept {
    const float position = std::clamp(roughness, 0.0F, 1.0F) * static_cast<float>(kSteps - 1);
    const auto below = std::min(static_cast<std::size_t>(position), static_cast<std::size_t>(kSteps - 2));
    const float t = position - static_cast<float>(below);
    return mix(nodes_[below], 1.0F - t, nodes_[below + 1], t);
}

std::size_t AlbedoTables::add(float ior) {
    const auto found = std::find(iors_.begin(), iors_.end(), ior);
    if (found != iors_.end()) return static_cast<std::size_t>(found - iors_.begin());
    if (iors_.empty()) one_ = AlbedoTable(-1.0F);
    iors_.push_back(ior);
    curves_.emplace_back(ior);
    return curves_.size() - 1;
}

AlbedoBound AlbedoTables::coat(std::size_t table, float f0, float f90, float roughness, bool delta) const noexcept {
    const AlbedoTable& exact = curves_[table];
    return delta ? mix(one_.smooth(), f90 * f0, exact.smooth(), f90 * (1.0F - f0))
                 : mix(one_.rough(roughness), f90 * f0, exact.rough(roughness), f90 * (1.0F - f0));
}

}  // namespace pellucid

#include "record_radius.h"

#include <algorithm>
#include <cmath>

#include "gather_gradients.h"
#include "occlusion_hessian.h"

namespace pellucid {

namespace {

constexpr double kFarthest = 1e6;
/// Rays nearer to the horizon than 10 degrees meet the surface's own bumps. [TabellionLamorlette2004]
constexpr float kLeastCosine = 0.17364818F;
/// Tabellion's error is the distance over R / 2: with the default error of 0.25, which reaches as far as R / 4, twice R.
constexpr float kTabellionRadius = 2.0F;
/// At the default error as many records as by Ward's metric, about.
constexpr double kHessianScale = 0.5;
constexpr double kHessianPower = 0.25;
/// Of the harmonic mean distance: what few rays say of curvature is not believed farther. A record that sees hardly more than a
/// dark thing near by finds no curvature at all, and would speak its darkness everywhere.
constexpr float kMostHessian = 4.0F;
/// Of a record's width to its length.
constexpr float kMostAspect = 2.0F;
/// What the gather did not hit lies this many scene radii away.
constexpr float kSky = 100.0F;
/// Of the least radius: what is nearer counts as this in the Hessian.
constexpr float kNearestShare = 0.05F, kNearestOfScene = 1e-7F;

[[nodiscard]] double harmonicDistance(const GatherGrid& g) {
    double inverse = 0.0;
    for (const GatherCell& c : g.cells)
        if (std::isfinite(c.distance) && c.distance > 0.0F) inverse += 1.0 / static_cast<double>(c.distance);
    return inverse > 0.0 ? std::min(static_cast<double>(g.cells.size()) / inverse, kFarthest) : kFarthest;
}

[[nodiscard]] float nearestDistance(const GatherGrid& g, const Frame& frame) {
    auto nearest = static_cast<float>(kFarthest);
    for (const GatherCell& c : g.cells)
        if (glm::dot(c.direction, frame.normal) > kLeastCosine) nearest = std::min(nearest, c.distance);
    return nearest;
}

/// R_j = s S (E / (S^2 |lambda_j|))^p with S the scene's radius: the power 1/4 spreads a fixed number of records for the least
/// mean error of an extrapolation whose error is of second order. [SchwarzhauptJensenJarosz2012, section 5]
[[nodiscard]] float hessianRadius(const GatherGrid& g, const Frame& frame, const GatherOptions& options,
                                  IrradianceRecord& record) {
    const auto size = static_cast<double>(options.sceneRadius);
    const auto irradiance = static_cast<double>(average(record.irradiance));
    if (!(irradiance > 0.0)) return record.harmonicDistance;
    const TangentCurvature t = tangentCurvature(
        occlusionHessian(g, frame, std::max(kNearestShare * options.minRadius, kNearestOfScene * options.sceneRadius),
                         kSky * options.sceneRadius),
        frame);
    const auto radius = [&](double curvature) {
        const double bent = std::fabs(curvature) * size * size / irradiance;
        return bent > 0.0 ? std::min(kHessianScale * size * std::pow(bent, -kHessianPower), kFarthest) : kFarthest;
    };
    const float most = std::clamp(kMostHessian * record.harmonicDistance, options.minRadius, options.maxRadius);
    const float narrow = std::clamp(static_cast<float>(radius(t.first)), options.minRadius, most);
    const float wide = std::min(static_cast<float>(radius(t.second)), std::min(most, kMostAspect * narrow));
    const float aspect = narrow > 0.0F ? std::max(1.0F, wide / narrow) : 1.0F;
    record.squeeze = t.axis * std::sqrt(aspect * aspect - 1.0F);
    return aspect * narrow;
}

}  // namespace

void setRadius(const GatherGrid& g, const Frame& frame, const GatherOptions& options, IrradianceRecord& record) {
    record.harmonicDistance = static_cast<float>(harmonicDistance(g));
    float radius = record.harmonicDistance;
    if (options.metric == CacheMetric::Tabellion) radius = kTabellionRadius * nearestDistance(g, frame);
    if (options.metric == CacheMetric::Hessian) radius = hessianRadius(g, frame, options, record);
    const float slope = glm::length(meanSlope(record));
    if (slope > 0.0F) radius = std::min(radius, average(record.irradiance) / slope);
    record.radius = std::clamp(radius, options.minRadius, options.maxRadius);
    // A gradient that belongs to a smaller distance than the record's reach must not be carried that far. [Krivanek2006]
    if (record.radius > 0.0F && radius < record.radius)
        for (glm::vec3& t : record.translation) t *= std::max(0.0F, radius) / record.radius;
}

void setBlocked(const GatherGrid& g, const Frame& frame, float reach, IrradianceRecord& record) {
    record.blocked = 0;
    const float perStratum = static_cast<float>(kBlockedSectors) / static_cast<float>(g.azimuths);
    for (int k = 0; k < g.azimuths; ++k) {
        bool stands = false;
        for (int j = 0; j < g.elevations; ++j) {
            const GatherCell& c = g.at(j, k);
            const float cosine = glm::dot(c.direction, frame.normal), height = c.distance * cosine;
            const float across = c.distance * std::sqrt(std::max(0.0F, 1.0F - cosine * cosine));
            stands = stands || (across < reach && height <= across);
        }
        if (!stands) continue;
        const int first = static_cast<int>(std::floor(static_cast<float>(k) * perStratum)),
                  last = static_cast<int>(std::ceil(static_cast<float>(k + 1) * perStratum));
        for (int s = first; s < last; ++s) record.blocked |= 1U << (static_cast<unsigned>(s) % kBlockedSectors);
    }
}

}  // namespace pellucid

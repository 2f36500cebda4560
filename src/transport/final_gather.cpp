#include <pellucid/transport/final_gather.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <pellucid/math/constants.h>
#include <pellucid/math/frame.h>
#include <pellucid/math/hash.h>

#include "gather_gradients.h"
#include "gather_grid.h"
#include "record_radius.h"

namespace pellucid {

namespace {

/// Of the least radius: distances below it count as this in the gradient.
constexpr float kNearestShare = 0.05F;

/// The rays of one gather.
struct GatherRays {
    Walk& walk;
    const GatherPoint& point;
    const Frame& frame;
    glm::vec3 origin;

    /// What one of them finds: a direction of its stratum, the distance to what it hit and the radiance from there.
    [[nodiscard]] GatherCell trace(const GatherStrata& strata, int j, int k, Sampler sampler) const {
        GatherCell cell;
        cell.direction = frame.toWorld(strata.direction(j, k, sampler.next2D()));
        cell.distance = std::numeric_limits<float>::infinity();
        // Below the true surface no light arrives, whatever the shading normal says.
        if (glm::dot(cell.direction, point.geometricNormal) <= 0.0F) return cell;
        WalkRay ray;
        ray.ray = Ray{origin, cell.direction, std::numeric_limits<float>::infinity()};
        ray.absorption = point.absorption;
        cell.radiance = walk.gather(ray, sampler, cell.distance);
        if (!isFinite(cell.radiance)) cell.radiance = Rgb(0.0F);
        return cell;
    }
};

/// Traces the strata's rays: the first of each says where and how far, the mean of all how bright.
[[nodiscard]] GatherGrid gather(Walk& walk, const GatherPoint& point, const Frame& frame, const GatherOptions& options,
                                std::uint64_t key) {
    GatherGrid grid(options.rays);
    const GatherRays rays{walk, point, frame, offsetOrigin(point.position, point.geometricNormal)};
    std::vector<std::uint8_t> wanted;
    if (options.guide != nullptr) wanted = options.guide->rays(point.position, frame, grid);
    for (int k = 0; k < grid.azimuths; ++k)
        for (int j = 0; j < grid.elevations; ++j) {
            const std::size_t i = grid.index(j, k);
            const auto sampler = [&](std::size_t number) {
                return Sampler(options.seed, key, static_cast<std::uint32_t>(number));
            };
            GatherCell& cell = grid.cells[i];
            cell = rays.trace(grid, j, k, sampler(i));
            const std::size_t count = wanted.empty() ? 1 : wanted[i];
            for (std::size_t r = 1; r < count; ++r)
                cell.radiance +=
                    rays.trace(grid, j, k, sampler(grid.count() + GatherGuide::kMostRays * i + r)).radiance;
            cell.radiance /= static_cast<float>(count);
        }
    return grid;
}

/// E = pi / (MN) sum L, and the share of E5 in it.
void addIrradiance(const GatherGrid& grid, const Frame& frame, IrradianceRecord& record) {
    const float norm = kPi / static_cast<float>(grid.cells.size());
    Rgb grazing(0.0F);
    for (const GatherCell& cell : grid.cells) {
        const float s = 1.0F - glm::dot(cell.direction, frame.normal), s2 = s * s;
        record.irradiance += cell.radiance * norm;
        grazing += cell.radiance * (norm * s2 * s2 * s);
    }
    for (glm::length_t c = 0; c < 3; ++c)
        record.grazingShare[c] = record.irradiance[c] > 0.0F ? grazing[c] / record.irradiance[c] : 0.0F;
}

/// A draw of the irradiance's error, from three strata at a time that lie beside each other: (L1 - 2 L2 + L3) / sqrt(2) has the
/// variance of L1 + L2 + L3 where they are alike, and what changes evenly from one to the next does not count.
[[nodiscard]] float noiseOf(const GatherGrid& grid, std::uint64_t key) {
    float sum = 0.0F;
    for (int j = 0; j < grid.elevations; ++j) {
        const auto light = [&](int k) { return luminance(grid.at(j, k % grid.azimuths).radiance); };
        for (int k = 0; k < grid.azimuths; k += 3) {
            const bool positive = (hashCombine(key, grid.index(j, k)) & 1U) != 0;
            const float whole = static_cast<float>(std::min(3, grid.azimuths - k)) / 3.0F;  // the last ones borrow
            const float second = (light(k) - 2.0F * light(k + 1) + light(k + 2)) * std::sqrt(0.5F * whole);
            sum += positive ? second : -second;
        }
    }
    return sum * kPi / static_cast<float>(grid.cells.size());
}

}  // namespace

IrradianceRecord gatherRecord(Walk& walk, const GatherPoint& point, const GatherOptions& options, std::uint64_t key,
                              LightByDirection* light) {
    const Frame frame(point.unmappedNormal);
    const GatherGrid grid = gather(walk, point, frame, options, key);
    IrradianceRecord record;
    record.position = point.position;
    record.normal = point.unmappedNormal;
    addIrradiance(grid, frame, record);
    record.noise = noiseOf(grid, hashCombine(options.seed, key));
    addRotation(grid, frame, record);
    addTranslation(grid, frame, kNearestShare * options.minRadius, record);
    setRadius(grid, frame, options, record);
    setBlocked(grid, frame, options.reach * record.radius, record);
    if (light != nullptr) {
        std::vector<Rgb> radiance;
        for (const GatherCell& cell : grid.cells) radiance.push_back(cell.radiance);
        *light = packByDirection(radiance, grid.elevations, grid.azimuths, hashCombine(options.seed, key));
    }
    return record;
}

}  // namespace pellucid

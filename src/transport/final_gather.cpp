#include <pellucid/transport/final_gather.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <pellucid/math/constants.h>
#include <pellucid/math/frame.h>

namespace pellucid {

namespace {

/// Of the least radius: distances below it count as this in the gradient.
constexpr float kNearestShare = 0.05F;

struct Cell {
    Rgb radiance{0.0F};
    float distance = 0.0F;
};

/// The grid of gather rays: `elevations` x `azimuths` strata of equal cosine-weighted solid angle.
struct Grid {
    int elevations, azimuths;
    std::vector<Cell> cells;

    explicit Grid(int rays)
        : elevations(std::max(3, static_cast<int>(std::lround(std::sqrt(static_cast<double>(rays) / kPiD))))),
          azimuths(std::max(7, static_cast<int>(std::lround(kPiD * elevations)))),
          cells(static_cast<std::size_t>(elevations) * static_cast<std::size_t>(azimuths)) {}

    [[nodiscard]] Cell& at(int j, int k) noexcept {
        return cells[static_cast<std::size_t>(k) * static_cast<std::size_t>(elevations) + static_cast<std::size_t>(j)];
    }
};

[[nodiscard]] constexpr float square(float x) noexcept { return x * x; }

/// The gradient of the mean over the colour channels.
[[nodiscard]] glm::vec3 meanSlope(const IrradianceRecord& record) noexcept {
    return (record.translation[0] + record.translation[1] + record.translation[2]) * (1.0F / 3.0F);
}

/// Rotational: dE = sum_k v(phi_k + pi/2) sum_j tan(theta_j) L_jk pi/(MN).
void addRotation(Grid& g, const Frame& frame, IrradianceRecord& record) {
    const float norm = kPi / static_cast<float>(g.elevations * g.azimuths);
    // The stratum's mean of tan(theta) over s = sin^2: int sqrt(s / (1 - s)) ds = asin(sqrt s) - sqrt(s (1 - s)).
    const auto meanTan = [m = static_cast<float>(g.elevations)](int border) {
        const float s = static_cast<float>(border) / m;
        return m * (std::asin(std::sqrt(s)) - std::sqrt(s * (1.0F - s)));
    };
    for (int k = 0; k < g.azimuths; ++k) {
        const float phi = kTwoPi * (static_cast<float>(k) + 0.5F) / static_cast<float>(g.azimuths);
        const glm::vec3 v = frame.toWorld({-std::sin(phi), std::cos(phi), 0.0F});
        Rgb sum(0.0F);
        for (int j = 0; j < g.elevations; ++j) {
            sum += (meanTan(j + 1) - meanTan(j)) * g.at(j, k).radiance;
        }
        for (glm::length_t c = 0; c < 3; ++c) record.rotation[static_cast<std::size_t>(c)] += v * (sum[c] * norm);
    }
}

/// Translational: the change of occlusion across the strata's borders, in elevation and in azimuth. Occluders nearer than
/// `nearestKept` (a record never speaks farther than that from them) would give slopes that no record may use.
void addTranslation(Grid& g, const Frame& frame, float nearestKept, IrradianceRecord& record) {
    const auto m = static_cast<float>(g.elevations), n = static_cast<float>(g.azimuths);
    const auto lower = [m](int j) { return std::sqrt(static_cast<float>(j) / m); };  // sin(theta_j-)
    const auto cosine = [m](int j) {
        return std::sqrt(std::max(0.0F, 1.0F - static_cast<float>(j) / m));
    };  // cos(theta_j-)
    float noise = 0.0F;
    for (int k = 0; k < g.azimuths; ++k) {
        const int before = (k + g.azimuths - 1) % g.azimuths;
        const float phi = kTwoPi * (static_cast<float>(k) + 0.5F) / n, border = kTwoPi * static_cast<float>(k) / n;
        const glm::vec3 u = frame.toWorld({std::cos(phi), std::sin(phi), 0.0F});
        const glm::vec3 v = frame.toWorld({-std::sin(border), std::cos(border), 0.0F});
        Rgb radial(0.0F), around(0.0F);
        const auto add = [&noise](Rgb& sum, float factor, const Rgb& step) {
            sum += factor * step;
            noise += square(factor * average(step));
        };
        for (int j = 0; j < g.elevations; ++j) {
            const Cell& cell = g.at(j, k);
            if (j > 0) {
                const Cell& below = g.at(j - 1, k);
                const float nearest = std::max(nearestKept, std::min(cell.distance, below.distance));
                if (std::isfinite(nearest))
                    add(radial, (kTwoPi / n) * cosine(j) * cosine(j) * lower(j) / nearest,
                        cell.radiance - below.radiance);
            }
            const Cell& side = g.at(j, before);
            const float nearest = std::max(nearestKept, std::min(cell.distance, side.distance));
            const float sin2 = (static_cast<float>(j) + 0.5F) / m;
            if (std::isfinite(nearest))
                add(around, std::sqrt((1.0F - sin2) / sin2) * (cosine(j) - cosine(j + 1)) / nearest,
                    cell.radiance - side.radiance);
        }
        for (glm::length_t c = 0; c < 3; ++c)
            record.translation[static_cast<std::size_t>(c)] += u * radial[c] + v * around[c];
    }
    // Were every step across a border noise, the squared length would be about the sum of the squared steps: keep only what
    // exceeds it, as a positive-part James-Stein estimator does. [JamesStein1961]
    const float length2 = square(glm::length(meanSlope(record)));
    const float kept = length2 > 0.0F ? std::max(0.0F, 1.0F - noise / length2) : 0.0F;
    for (glm::vec3& t : record.translation) t *= kept;
}

/// R: harmonic mean of the distances, not above E / |grad E|, within the bounds.
void setRadius(Grid& g, const GatherOptions& options, IrradianceRecord& record) {
    double inverse = 0.0;
    for (const Cell& c : g.cells)
        if (std::isfinite(c.distance) && c.distance > 0.0F) inverse += 1.0 / static_cast<double>(c.distance);
    const double harmonic = inverse > 0.0 ? static_cast<double>(g.cells.size()) / inverse : 1e6;
    record.harmonicDistance = static_cast<float>(std::min(harmonic, 1e6));
    float radius = record.harmonicDistance;
    const float slope = glm::length(meanSlope(record));
    if (slope > 0.0F) radius = std::min(radius, average(record.irradiance) / slope);
    record.radius = std::clamp(radius, options.minRadius, options.maxRadius);
    // A gradient that belongs to a smaller distance than the record's reach must not be carried that far. [Krivanek2006]
    if (record.radius > 0.0F && radius < record.radius)
        for (glm::vec3& t : record.translation) t *= std::max(0.0F, radius) / record.radius;
}

}  // namespace

IrradianceRecord gatherRecord(Walk& walk, const GatherPoint& point, const GatherOptions& options, std::uint64_t key) {
    Grid grid(options.rays);
    const Frame frame(point.normal);
    IrradianceRecord record;
    record.position = point.position;
    record.normal = point.normal;
    const glm::vec3 origin = offsetOrigin(point.position, point.geometricNormal);
    const float norm = kPi / static_cast<float>(grid.elevations * grid.azimuths);
    Rgb grazing(0.0F);
    for (int k = 0; k < grid.azimuths; ++k)
        for (int j = 0; j < grid.elevations; ++j) {
            Sampler sampler(options.seed, key, static_cast<std::uint32_t>(k * grid.elevations + j));
            const glm::vec2 jitter = sampler.next2D();
            const float sin2 = (static_cast<float>(j) + jitter.x) / static_cast<float>(grid.elevations);
            const float phi = kTwoPi * (static_cast<float>(k) + jitter.y) / static_cast<float>(grid.azimuths);
            const float sine = std::sqrt(sin2), cosine = std::sqrt(std::max(0.0F, 1.0F - sin2));
            WalkRay ray;
            ray.ray = Ray{origin, frame.toWorld({sine * std::cos(phi), sine * std::sin(phi), cosine}),
                          std::numeric_limits<float>::infinity()};
            ray.absorption = point.absorption;
            Cell& cell = grid.at(j, k);
            // Below the true surface no light arrives, whatever the shading normal says.
            if (glm::dot(ray.ray.direction, point.geometricNormal) > 0.0F)
                cell.radiance = walk.gather(ray, sampler, cell.distance);
            else
                cell.distance = std::numeric_limits<float>::infinity();
            if (!isFinite(cell.radiance)) cell.radiance = Rgb(0.0F);
            const float s = 1.0F - cosine, s2 = s * s;
            record.irradiance += cell.radiance * norm;
            grazing += cell.radiance * (norm * s2 * s2 * s);
        }
    for (glm::length_t c = 0; c < 3; ++c)
        record.grazingShare[c] = record.irradiance[c] > 0.0F ? grazing[c] / record.irradiance[c] : 0.0F;
    addRotation(grid, frame, record);
    addTranslation(grid, frame, kNearestShare * options.minRadius, record);
    setRadius(grid, options, record);
    return record;
}

}  // namespace pellucid

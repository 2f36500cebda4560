#include "caustic_choice.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <pellucid/transport/caster_tally.h>

namespace pellucid {

namespace {

/// Where the two ways cross in the sweep of docs/benchmarks.md.
constexpr float kLeastRoughness = 0.25F;
constexpr double kLargeLamp = 0.2;  ///< sr

/// What a material takes up: its bounds and its area, scene units.
struct Extent {
    Bounds bounds;
    double area = 0.0;
};

[[nodiscard]] std::vector<Extent> extents(const Scene& scene) {
    const SceneDescription& d = scene.description();
    std::vector<Extent> of(d.materials.size());
    for (std::uint32_t g = 0; g < d.geometries.size(); ++g) {
        const Mesh& mesh = d.meshes[d.geometries[g].mesh];
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto corners = scene.corners(g, t);
            Extent& e = of[mesh.material];
            for (const glm::vec3& c : corners) e.bounds.extend(c);
            e.area +=
                0.5 * static_cast<double>(glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])));
        }
    }
    return of;
}

[[nodiscard]] bool isRoughMetal(const Material& m) noexcept {
    return m.metallic >= 1.0F && m.roughness >= kLeastRoughness && !m.metallicRoughnessTexture;
}

/// Of a lamp as seen from the middle of a caster, as if it faced it.
[[nodiscard]] double solidAngle(const Extent& lamp, const Extent& caster) noexcept {
    const double distance =
        std::max(static_cast<double>(glm::length(lamp.bounds.centre() - caster.bounds.centre())), 1e-9);
    return lamp.area / (distance * distance);
}

}  // namespace

std::optional<std::string> causticsLeftToEyePaths(const Scene& scene) {
    const SceneDescription& d = scene.description();
    std::vector<bool> used(d.materials.size(), false);
    for (const Geometry& g : d.geometries) used[d.meshes[g.mesh].material] = true;
    std::vector<std::size_t> casters;
    float smoothest = 1.0F;
    for (std::uint32_t m = 0; m < d.materials.size(); ++m) {
        if (!used[m] || (scene.surfaces().possibleKinds(m) & kSpecular) == kNoLobe) continue;
        if (!isRoughMetal(d.materials[m])) return std::nullopt;
        casters.push_back(m);
        smoothest = std::min(smoothest, d.materials[m].roughness);
    }
    if (casters.empty()) return std::nullopt;
    const std::vector<Extent> of = extents(scene);
    double largest = 0.0;
    const CasterTally tally(scene);
    for (const TalliedLamp& lamp : tally.lamps()) {
        if (lamp.kind == LightKind::Environment || lamp.source == TalliedLamp::kUnknown) return std::nullopt;
        if (lamp.kind != LightKind::Triangle) continue;  // of no size
        for (const std::size_t c : casters) largest = std::max(largest, solidAngle(of[lamp.source], of[c]));
    }
    if (largest > kLargeLamp) return std::nullopt;
    return fmt::format(
        "all that casts is metal of roughness {:.2g} or more (limit {:.2g}), and no lamp is larger than {:.2g} sr "
        "(limit {:.2g}) from there: next-event estimation at the metal shows it sharper",
        smoothest, kLeastRoughness, largest, kLargeLamp);
}

}  // namespace pellucid

#include <pellucid/transport/caster_aim.h>

#include <algorithm>
#include <cmath>

#include <pellucid/math/bounds.h>
#include <pellucid/math/sampler.h>
#include <pellucid/transport/caster_tally.h>

#include "light_path.h"

namespace pellucid {

namespace {

/// A step, of all pairs of a lamp and a caster together, but at least so many of each: a guide has to see one lamp among a hundred.
constexpr std::uint32_t kTries = 40'000, kFewestTries = 1'000;
constexpr std::size_t kMostLamps = 256;  ///< more are aimed as one
constexpr std::size_t kMostPairs = 400;  ///< of a lamp and a caster
constexpr float kStep = 0.4F;            ///< of a sphere's radius
constexpr std::uint64_t kAimPass = 0x61696dULL;

struct Sphere {
    glm::vec3 centre{0.0F};
    float radius = 0.0F;

    [[nodiscard]] bool meets(const Ray& ray, float scaled) const noexcept {
        const glm::vec3 to = centre - ray.origin;
        const float along = glm::dot(to, ray.direction), distance2 = glm::dot(to, to), r2 = scaled * scaled;
        if (distance2 <= r2) return true;
        if (along <= 0.0F) return false;
        const glm::vec3 miss = to - ray.direction * along;
        return glm::dot(miss, miss) <= r2;
    }
};

/// Of the geometries that cast, the smallest first.
[[nodiscard]] std::vector<Sphere> castersOf(const Scene& scene) {
    const SceneDescription& description = scene.description();
    std::vector<bool> casts(description.materials.size(), false);
    for (std::uint32_t m = 0; m < casts.size(); ++m)
        casts[m] = (scene.surfaces().possibleKinds(m) & kSpecular) != kNoLobe;
    std::vector<Sphere> spheres;
    for (std::uint32_t g = 0; g < description.geometries.size(); ++g) {
        const Mesh& mesh = description.meshes[description.geometries[g].mesh];
        if (!casts[mesh.material]) continue;
        Bounds bounds;
        for (std::uint32_t p = 0; p < mesh.triangles.size(); ++p)
            for (const glm::vec3& corner : scene.corners(g, p)) bounds.extend(corner);
        const Sphere sphere{0.5F * (bounds.lower + bounds.upper), bounds.radius()};
        if (sphere.radius > 0.0F) spheres.push_back(sphere);
    }
    std::stable_sort(spheres.begin(), spheres.end(),
                     [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; });
    if (spheres.size() > kMostAimed) spheres.resize(kMostAimed);
    return spheres;
}

struct Starts {
    std::vector<UsefulEmission> list;
    std::vector<std::uint32_t> lights;  ///< of each
};

/// The lights of each lamp, as a tally groups them: nobody knows yet which lamp shines on a caster.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> lampsOf(const Scene& scene) {
    std::vector<std::vector<std::uint32_t>> lamps;
    const CasterTally tally(scene);
    for (const TalliedLamp& lamp : tally.lamps()) lamps.push_back(lamp.lights);
    if (lamps.size() <= kMostLamps) return lamps;
    for (std::size_t i = 1; i < lamps.size(); ++i) lamps[0].insert(lamps[0].end(), lamps[i].begin(), lamps[i].end());
    lamps.resize(1);
    return lamps;
}

/// Starts of one lamp whose rays meet the caster's sphere.
[[nodiscard]] Starts aim(const Scene& scene, const std::vector<std::uint32_t>& lamp, const Sphere& caster,
                         std::uint32_t tries, std::uint64_t seed, std::uint64_t& pass, const Workers& workers) {
    Starts useful;
    for (float radius = 2.0F * scene.radius(); radius > caster.radius;) {
        radius = std::max(caster.radius, kStep * radius);
        const EmissionGuide guide(scene.lights(), lamp, std::move(useful.list));
        auto chunks = light_path::inChunks<Starts>(tries, workers, [&](std::uint32_t index, Starts& out) {
            Sampler sampler(seed, pass, index);
            const auto start = guide.sample(sampler);
            if (!start || !caster.meets(start->emission.ray, radius)) return;
            UsefulEmission origin = start->origin;
            origin.weight = luminance(start->emission.flux);
            origin.landed = caster.centre;
            if (!(origin.weight > 0.0F)) return;
            out.list.push_back(origin);
            out.lights.push_back(start->emission.light);
        });
        ++pass;
        useful = {};
        light_path::gather(useful.list, chunks, &Starts::list);
        light_path::gather(useful.lights, chunks, &Starts::lights);
        if (useful.list.empty()) break;
    }
    return useful;
}

/// The same starts as a guide over all lights numbers them, with a sum of weights of 1.
void renumber(Starts& starts, const EmissionGuide& from, const EmissionGuide& to) {
    double sum = 0.0;
    for (const UsefulEmission& e : starts.list) sum += static_cast<double>(e.weight);
    for (std::size_t i = 0; i < starts.list.size(); ++i) {
        const auto [a, b] = from.choosing(starts.lights[i]);
        const auto [c, d] = to.choosing(starts.lights[i]);
        float& u = starts.list[i].u[0];
        const double within = b > a ? std::clamp((static_cast<double>(u) - a) / (b - a), 0.0, 1.0) : 0.5;
        u = std::min(static_cast<float>(c + (d - c) * within), 0x1.fffffep-1F);
        starts.list[i].weight = static_cast<float>(static_cast<double>(starts.list[i].weight) / sum);
    }
}

}  // namespace

std::vector<UsefulEmission> aimAtCasters(const Scene& scene, std::uint64_t seed, const Workers& workers) {
    const std::vector<std::vector<std::uint32_t>> lamps = lampsOf(scene);
    if (lamps.empty()) return {};
    std::vector<Sphere> casters = castersOf(scene);
    casters.resize(std::min(casters.size(), std::max<std::size_t>(1, kMostPairs / lamps.size())));
    const std::size_t pairs = std::max<std::size_t>(1, casters.size() * lamps.size());
    const std::uint32_t tries = std::max(kFewestTries, kTries / static_cast<std::uint32_t>(pairs));
    const EmissionGuide ofAll(scene.lights(), {});
    std::vector<UsefulEmission> all;
    std::uint64_t pass = kAimPass;
    for (const Sphere& caster : casters)
        for (const std::vector<std::uint32_t>& lamp : lamps) {
            Starts starts = aim(scene, lamp, caster, tries, seed, pass, workers);
            renumber(starts, EmissionGuide(scene.lights(), lamp, {}), ofAll);
            all.insert(all.end(), starts.list.begin(), starts.list.end());
        }
    return all;
}

}  // namespace pellucid

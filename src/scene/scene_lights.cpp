// The lamps of a scene: punctual ones from their description, emissive triangles from the materials of the meshes.
#include <algorithm>
#include <cmath>
#include <utility>

#include "scene_impl.h"

namespace pellucid {

void Scene::Impl::addPunctual(Lights::Parts& parts) const {
    const double s = normalisation.scale();
    const auto area = static_cast<float>(s * s);
    for (const PunctualLight& light : description.lights) {
        const glm::vec3 position((light.position - normalisation.centre) * s);
        const glm::vec3 direction(light.direction);
        switch (light.kind) {
            case PunctualKind::Point:
                parts.points.push_back({position, light.intensity * area});
                break;
            case PunctualKind::Spot:
                parts.spots.push_back({position, direction, light.intensity * area,
                                       static_cast<float>(std::cos(light.innerCone)),
                                       static_cast<float>(std::cos(light.outerCone))});
                break;
            case PunctualKind::Directional:
                parts.directionals.push_back({direction, light.intensity});
                break;
        }
    }
}

void Scene::Impl::addEmissive(Lights::Parts& parts) const {
    for (std::uint32_t g = 0; g < description.geometries.size(); ++g) {
        const Mesh& mesh = description.meshes[description.geometries[g].mesh];
        const Material& material = description.materials[mesh.material];
        if (maxComponent(material.emission) <= 0.0F) continue;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            EmissiveTriangle e;
            const auto c = corners(g, i);
            for (int k = 0; k < 3; ++k) e.corner[k] = c[static_cast<std::size_t>(k)];
            const glm::vec3 cross = glm::cross(c[1] - c[0], c[2] - c[0]);
            const float length = glm::length(cross);
            if (!(length > 0.0F)) continue;
            e.area = 0.5F * length;
            e.normal = cross / (placements[g].mirrored ? -length : length);
            e.twoSided = material.doubleSided;
            e.geometry = g;
            e.primitive = i;
            e.meanRadiance = material.emission;
            if (material.emissiveTexture) {
                constexpr int kSteps = 8;
                Rgb sum(0.0F);
                int samples = 0;
                for (int y = 0; y < kSteps; ++y)
                    for (int x = 0; x + y < kSteps; ++x, ++samples)
                        sum += surfaces->emittedRadiance(surfacePoint({g, i, (static_cast<float>(x) + 0.33F) / kSteps,
                                                                       (static_cast<float>(y) + 0.33F) / kSteps, 0.0F}),
                                                         e.normal);
                // Never zero: between the samples the texture may still shine.
                e.meanRadiance = glm::max(sum / static_cast<float>(samples), material.emission * 1e-3F);
            }
            parts.triangles.push_back(e);
        }
    }
}

void Scene::Impl::buildLights() {
    Lights::Parts parts;
    addPunctual(parts);
    addEmissive(parts);
    parts.environment = environment.get();
    parts.sceneCentre = accel->bounds().centre();
    parts.sceneRadius = accel->bounds().radius() * 1.0001F;
    parts.geometries = static_cast<std::uint32_t>(description.geometries.size());
    lights = std::make_unique<Lights>(
        std::move(parts),
        [](const void* scene, std::uint32_t geometry, std::uint32_t primitive, const glm::vec2& barycentric,
           const glm::vec3& wo) {
            const auto* self = static_cast<const Impl*>(scene);
            const SurfacePoint point = self->surfacePoint({geometry, primitive, barycentric.x, barycentric.y, 0.0F});
            // A path that comes this way by itself meets a lamp of alpha only in this share of its tries.
            const float coverage = self->hasAlpha[point.material] ? self->surfaces->coverage(point) : 1.0F;
            return self->surfaces->emittedRadiance(point, wo) * coverage;
        },
        this);
}

}  // namespace pellucid

// Bodies of the same glass that touch: the two faces between them coincide, and are no interface.
#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <utility>

#include "scene_impl.h"

namespace pellucid {

namespace {

/// Whether light crosses from one body to the other as within one.
[[nodiscard]] bool sameGlass(const Material& a, const Material& b) noexcept {
    return a.ior == b.ior && a.dispersion == b.dispersion && a.absorption == b.absorption && a.transmission >= 1.0F &&
           b.transmission >= 1.0F;
}

}  // namespace

/// Finds pairs of triangles of volume glass with the same three corners that face each other.
void Scene::Impl::mergeCoincidentGlass() {
    using Key = std::array<float, 9>;
    std::map<Key, std::pair<std::uint32_t, std::uint32_t>> open;
    merged.resize(description.geometries.size());
    for (std::uint32_t g = 0; g < description.geometries.size(); ++g) {
        const Mesh& mesh = description.meshes[description.geometries[g].mesh];
        const Material& material = description.materials[mesh.material];
        if (!(material.transmission > 0.0F && material.thickness > 0.0F)) continue;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            auto c = corners(g, i);
            std::sort(c.begin(), c.end(), [](const glm::vec3& a, const glm::vec3& b) {
                return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
            });
            const Key key{c[0].x, c[0].y, c[0].z, c[1].x, c[1].y, c[1].z, c[2].x, c[2].y, c[2].z};
            const auto [it, fresh] = open.try_emplace(key, g, i);
            if (fresh) continue;
            const auto [g2, i2] = it->second;
            const Material& other = description.materials[description.meshes[description.geometries[g2].mesh].material];
            const glm::vec3 n = surfacePoint({g, i, 0.3F, 0.3F, 0.0F}).geometricNormal,
                            n2 = surfacePoint({g2, i2, 0.3F, 0.3F, 0.0F}).geometricNormal;
            if (glm::dot(n, n2) >= 0.0F || !sameGlass(material, other)) continue;
            for (const auto& [geometry, primitive] : {std::pair(g, i), std::pair(g2, i2)}) {
                auto& flags = merged[geometry];
                flags.resize(description.meshes[description.geometries[geometry].mesh].triangles.size(), false);
                flags[primitive] = true;
            }
            anyMerged = true;
            open.erase(it);
        }
    }
}

}  // namespace pellucid

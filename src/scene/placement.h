/// Where things stand in normalised space: the scene is centred and scaled by a power of two, so that its radius is about 1 and
/// nothing else depends on world units.
#pragma once

#include <array>
#include <cstdint>

#include <glm/glm.hpp>

#include <pellucid/geometry/mesh.h>
#include <pellucid/scene/description.h>
#include <pellucid/scene/scene.h>

namespace pellucid {

/// How a geometry stands in the normalised scene.
struct Placement {
    glm::mat4 toScene{1.0F};
    glm::mat3 normalToScene{1.0F};
    bool mirrored = false;  ///< negative determinant: the winding turns over
    bool baked = false;     ///< the mesh's own vertices stand in the scene already
};

/// Throws Error{BadInput} for a scene without extent.
[[nodiscard]] Normalisation normalise(const SceneDescription& description);
[[nodiscard]] glm::dmat4 normalisedTransform(const Normalisation& n, const glm::dmat4& toWorld);
[[nodiscard]] Placement place(const Normalisation& n, const Geometry& geometry);
using Corners = std::array<glm::vec3, 3>;
/// Of a triangle of the mesh that is placed so, as it winds.
[[nodiscard]] Corners cornersIn(const Placement& placement, const Mesh& mesh, std::uint32_t primitive) noexcept;
/// A mesh that stands in one place only is moved there once and for all.
void bake(Placement& placement, Mesh& mesh);

}  // namespace pellucid

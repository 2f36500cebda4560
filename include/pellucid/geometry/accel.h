/// Ray queries over all geometries. The only room that sees Embree: robust mode, invalid rays are refused before Embree
/// sees them (its Debian build aborts on them).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <pellucid/geometry/mesh.h>
#include <pellucid/math/bounds.h>
#include <pellucid/math/ray.h>

namespace pellucid {

struct RawHit {
    std::uint32_t geometry = 0, primitive = 0;
    float u = 0.0F, v = 0.0F;  ///< barycentric weights of the second and third corner
    float t = 0.0F;            ///< distance along the ray, scene units
};

class Accel {
public:
    /// `toScene` of each geometry maps mesh space to normalised scene space. Geometries are flattened while all triangles
    /// stay below a limit; meshes placed many times become Embree instances above it.
    Accel(std::span<const Mesh> meshes, std::span<const std::uint32_t> meshOfGeometry,
          std::span<const glm::mat4> toScene);
    ~Accel();

    /// False when nothing is hit in (0, ray.tMax), or when the ray is not finite.
    [[nodiscard]] bool intersect(const Ray& ray, RawHit& hit) const noexcept;
    /// Whether anything is hit in (0, ray.tMax).
    [[nodiscard]] bool occluded(const Ray& ray) const noexcept;
    [[nodiscard]] const Bounds& bounds() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid

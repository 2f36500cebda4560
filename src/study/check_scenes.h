/// Scenes for the checks, made in memory: a builder that turns shapes and materials into a SceneDescription.
#pragma once

#include <functional>

#include <pellucid/scene/description.h>

namespace pellucid::check {

/// An exact Lambertian: no coat (specular factor 0, metallic 0).
[[nodiscard]] Material lambert(float reflectance, float emission = 0.0F);
/// Emits and reflects nothing.
[[nodiscard]] Material lamp(float radiance, bool twoSided = false);
/// Metal of this reflectance at normal incidence, F90 = 1; 1 is a perfect mirror at every angle.
[[nodiscard]] Material mirror(float reflectance, float roughness = 0.0F);
/// A closed body of this ior; `absorption` in 1/m.
[[nodiscard]] Material glass(float ior, float absorption = 0.0F, float roughness = 0.0F);

/// A point of a parametric surface. The normal (unit) decides the side that counts as the front.
struct SurfaceSpot {
    glm::dvec3 position{0.0}, normal{0.0, 0.0, 1.0};
};
using ParametricSurface = std::function<SurfaceSpot(double u, double v)>;

/// Of glass, say: right angle at the origin, legs of length 1 along x and z, extruded along y to both sides.
[[nodiscard]] Mesh rightAngledPrism(float halfLength);

class SceneBuilder {
public:
    std::uint32_t add(const Material& material);

    /// The parallelogram corner + [0,1] u + [0,1] v; its front is where u x v points.
    void quad(const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v, const Material& material);
    /// A square of this half width around `centre`, front along `normal`.
    void square(const glm::dvec3& centre, const glm::dvec3& normal, double halfWidth, const Material& material);
    void box(const glm::dvec3& lower, const glm::dvec3& upper, const Material& material, bool inward = false);
    /// A grid of nu x nv cells over [0,1]^2. `smooth` keeps the normals for shading; else faces are flat. Returns its area.
    double surface(int nu, int nv, const ParametricSurface& shape, const Material& material, bool smooth);
    /// A tessellated sphere with 2 x `rings` columns. Returns its area.
    double sphere(const glm::dvec3& centre, double radius, int rings, const Material& material, bool smooth,
                  bool inward = false);
    void mesh(Mesh mesh, const Material& material);

    void point(const glm::dvec3& position, double intensity);
    void sun(const glm::dvec3& direction, double irradiance);

    /// An orthographic camera that looks at `target` against `normal` from `distance`; the image is `width` wide.
    void view(const glm::dvec3& target, const glm::dvec3& normal, double width, double distance);
    /// A perspective camera.
    void perspective(const glm::dvec3& eye, const glm::dvec3& target, double verticalFov);

    [[nodiscard]] SceneDescription& description() noexcept { return description_; }

private:
    SceneDescription description_;
};

/// Total area of a mesh's triangles.
[[nodiscard]] double meshArea(const Mesh& mesh);

/// The whole scene (geometry, cameras, lights, absorption) times `scale`, then moved: what must not change the image.
[[nodiscard]] SceneDescription transformed(SceneDescription scene, double scale, const glm::dvec3& move);

/// An equirectangular environment with radiance `f` of the direction.
[[nodiscard]] EnvironmentDescription environmentMap(int width, int height,
                                                    const std::function<double(const glm::dvec3&)>& f);

}  // namespace pellucid::check

/// The scene: one immutable aggregate in normalised space, built once from a description. Answers intersection,
/// occlusion, surface attributes and light queries; the only thing that transport sees of the world.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pellucid/base/log.h>
#include <pellucid/base/parallel.h>
#include <pellucid/geometry/accel.h>
#include <pellucid/math/bounds.h>
#include <pellucid/scene/camera.h>
#include <pellucid/scene/description.h>
#include <pellucid/scene/environment.h>
#include <pellucid/scene/lights.h>
#include <pellucid/surface/bsdf.h>
#include <pellucid/surface/surface_point.h>

namespace pellucid {

/// normalised = (metres - centre) * 2^exponent: an exact scaling to a radius of about 1.
struct Normalisation {
    glm::dvec3 centre{0.0};
    int exponent = 0;
    [[nodiscard]] double scale() const noexcept;  ///< 2^exponent
};

struct SceneOptions {
    LobeRules lobeRules;
    bool requireLight = true;  ///< a scene without any light is an error
};

/// A hit with its full surface attributes.
struct SurfaceHit {
    SurfacePoint point;
    float distance = 0.0F;
    /// Probability that a ray which meets the surface here does not pass it, (0, 1]: alpha.
    float coverage = 1.0F;
};

class Scene {
public:
    Scene(SceneDescription description, std::optional<EnvironmentDescription> environment, const SceneOptions& options,
          const Workers& workers, const LogSink& log = {});
    ~Scene();
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    /// Nearest surface along the ray; alpha (mask, blend) is resolved by `coin` keyed uniform numbers in [0,1): a covered
    /// surface is passed with probability 1 - coverage. Counts no rays: callers count.
    [[nodiscard]] std::optional<SurfaceHit> intersect(const Ray& ray, float coin) const noexcept;
    /// Whether some surface has holes, so that intersect() looks at its coin.
    [[nodiscard]] bool hasHoles() const noexcept;

    /// Transmittance by alpha between the ray's origin and tMax: 0 blocked by anything opaque (glass blocks too).
    [[nodiscard]] float visibility(const Ray& ray) const noexcept;

    /// The corners of a triangle, as they stand in the normalised scene.
    [[nodiscard]] std::array<glm::vec3, 3> corners(std::uint32_t geometry, std::uint32_t primitive) const noexcept;

    [[nodiscard]] const SurfaceModel& surfaces() const noexcept;
    [[nodiscard]] const Lights& lights() const noexcept;
    [[nodiscard]] const Environment* environment() const noexcept;  ///< null: none
    [[nodiscard]] const SceneDescription& description() const noexcept;
    [[nodiscard]] const Bounds& bounds() const noexcept;  ///< normalised space
    [[nodiscard]] float radius() const noexcept { return bounds().radius(); }
    [[nodiscard]] const Normalisation& normalisation() const noexcept;
    [[nodiscard]] std::uint64_t triangles() const noexcept;  ///< with instances counted each
    [[nodiscard]] const std::string& hash() const noexcept;  ///< of file, environment and options
    /// Of geometry, materials, lights and environment as they stand: cameras, names and how the file says it do not matter.
    /// Worked out at each call.
    [[nodiscard]] std::string lightHash() const;
    /// Kinds of lobes anywhere in the scene.
    [[nodiscard]] LobeKinds lobeKinds() const noexcept;

    /// The camera by name or index ("": the first, or the one made to frame the scene), for an image of this size
    /// (0: 512 wide by the camera's aspect; one of them 0: by the aspect).
    [[nodiscard]] Camera camera(const std::string& nameOrIndex, int width, int height, double aperture = 0.0,
                                double focus = 1.0) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid

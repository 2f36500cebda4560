/// What a Scene holds. Built once; afterwards all of it is only read.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <pellucid/scene/scene.h>

#include "placement.h"

namespace pellucid {

struct Scene::Impl {
    SceneDescription description;
    Normalisation normalisation;
    std::vector<Placement> placements;
    std::unique_ptr<Accel> accel;
    std::unique_ptr<SurfaceModel> surfaces;
    std::unique_ptr<Environment> environment;
    std::unique_ptr<Lights> lights;
    std::vector<bool> hasAlpha;  ///< by material
    bool anyAlpha = false;
    /// By geometry and primitive: one of two faces of the same glass that coincide. Rays pass: there is no interface.
    std::vector<std::vector<bool>> merged;
    bool anyMerged = false;
    std::uint64_t triangleCount = 0;
    LobeKinds kinds = kNoLobe;
    std::string hash, environmentHash;

    [[nodiscard]] SurfacePoint surfacePoint(const RawHit& hit) const noexcept;
    [[nodiscard]] std::array<glm::vec3, 3> corners(std::uint32_t geometry, std::uint32_t primitive) const noexcept;
    void addPunctual(Lights::Parts& parts) const;
    void addEmissive(Lights::Parts& parts) const;
    void buildLights();
    void scaleMaterials();
    void placeGeometry();
    void buildSurfaces(const LobeRules& rules);
    void buildEnvironment(const EnvironmentDescription& sky, const LogSink& log);
    void mergeCoincidentGlass();
    [[nodiscard]] bool isMerged(const SurfacePoint& p) const noexcept {
        return anyMerged && !merged[p.geometry].empty() && merged[p.geometry][p.primitive];
    }
};

/// A camera that frames the whole scene from the front, a little from the right and above.
[[nodiscard]] CameraSpec framingCamera(const Normalisation& n, const Bounds& bounds);

}  // namespace pellucid

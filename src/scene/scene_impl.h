/// What a Scene holds. Built once; afterwards all of it is only read.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <pellucid/scene/scene.h>

#include "coincident_faces.h"
#include "placement.h"

namespace pellucid {

/// A face with holes, then what lies behind them: one of the two, both, or neither where two bodies of the same glass touch.
struct FacesMet {
    std::array<SurfacePoint, 2> face;
    int count = 0;
    void add(const SurfacePoint& p) noexcept { face[static_cast<std::size_t>(count++)] = p; }
};

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
    CoincidentFaces coincident;
    std::uint64_t triangleCount = 0;
    LobeKinds kinds = kNoLobe;
    std::string hash, environmentHash;

    [[nodiscard]] SurfacePoint surfacePoint(const RawHit& hit) const noexcept;
    [[nodiscard]] Corners corners(std::uint32_t geometry, std::uint32_t primitive) const noexcept;
    void addPunctual(Lights::Parts& parts) const;
    void addEmissive(Lights::Parts& parts) const;
    void buildLights();
    void scaleMaterials();
    void placeGeometry();
    void buildSurfaces(const LobeRules& rules);
    void buildEnvironment(const EnvironmentDescription& sky, const LogSink& log);
    void findCoincidentFaces(const LogSink& log);
    /// Whether a ray that hits this surface may go on, or may meet another one in the same place.
    [[nodiscard]] bool isAlone(const SurfacePoint& p) const noexcept {
        return !hasAlpha[p.material] && !coincident.shares({p.geometry, p.primitive});
    }
    /// What a ray that hits `p` meets there, in order.
    [[nodiscard]] FacesMet meet(const SurfacePoint& p) const noexcept;
    void addGlass(const SurfacePoint& p, FacesMet& met) const noexcept;
};

/// A camera that frames the whole scene from the front, a little from the right and above.
[[nodiscard]] CameraSpec framingCamera(const Normalisation& n, const Bounds& bounds);

}  // namespace pellucid

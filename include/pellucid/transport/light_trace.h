/// Light tracing for exactly the class E X S+ L: caustics that the camera sees directly. Each photon that arrives at a
/// non-casting surface over S lobes alone is connected to the lens. Unbiased; sees point lights; blind to caustics that are
/// themselves seen in a mirror or through glass.
#pragma once

#include <cstdint>
#include <vector>

#include <pellucid/base/parallel.h>
#include <pellucid/scene/scene.h>
#include <pellucid/transport/path_classes.h>
#include <pellucid/transport/photon_trace.h>

namespace pellucid {

struct LightSplat {
    std::uint32_t pixel = 0;
    Rgb radiance{0.0F};  ///< W m^-2 sr^-1, already divided by the number of paths of the pass
    PathString path;     ///< from the eye
};

/// Light over S lobes alone that arrived at a D lobe: which texel, and how it stands to the shading normal.
struct CausticArrival {
    std::uint32_t geometry = 0, primitive = 0;
    glm::vec2 barycentric{0.0F};
    bool backSide = false;
    float cosine = 0.0F;
    Rgb flux{0.0F};  ///< W under the shading normal, already divided by the number of paths of the pass
};

struct LightPass {
    std::vector<LightSplat> splats;        ///< in the order of the paths
    std::vector<CausticArrival> arrivals;  ///< with `looked` only
    /// Then also what the receivers of those throw on casters in turn, where it arrives: L S+ D S+ D.
    std::vector<CausticArrival> bounced;
    std::vector<UsefulEmission> useful;
    std::uint64_t rays = 0, emitted = 0;
    EnergyBalance energy;  ///< of the pass, scene units
};

/// `looked`: keep arrivals; those at places that the camera looks at are useful, too, not only those that it sees directly.
[[nodiscard]] LightPass traceLightPaths(const Scene& scene, const Camera& camera, const EmissionGuide& guide,
                                        const PhotonPassKey& key, const Workers& workers,
                                        const VisibleCells* looked = nullptr);

}  // namespace pellucid

/// The photon passes. Whole paths only, a fixed number of them; photons stand in the order of their paths, so that the
/// list is the same at any number of threads.
#pragma once

#include <cstdint>
#include <vector>

#include <pellucid/base/parallel.h>
#include <pellucid/scene/scene.h>
#include <pellucid/transport/caster_tally.h>
#include <pellucid/transport/emission_guide.h>
#include <pellucid/transport/energy.h>
#include <pellucid/transport/photon.h>
#include <pellucid/transport/radiance_map.h>
#include <pellucid/transport/visible_cells.h>

namespace pellucid {

struct PhotonPassKey {
    std::uint64_t seed = 0;
    std::uint64_t pass = 0;       ///< a different one for each pass of a render
    std::uint32_t paths = 0;      ///< emitted in this pass
    std::uint32_t originsOf = 0;  ///< so many of them tell where their photons came from; wants a tally
};

struct CausticPass {
    PhotonList photons;  ///< L S+ D
    std::vector<UsefulEmission> useful;
    std::vector<PhotonOrigin> origins;  ///< of the photons of the first paths, where that is asked for
    std::uint64_t rays = 0, emitted = 0;
    EnergyBalance energy;  ///< of the pass, scene units
};

struct GlobalPass {
    std::vector<GlobalPhoton> photons;
    std::uint64_t rays = 0, emitted = 0;
    EnergyBalance energy;  ///< of the pass, scene units
};

/// What progressive photon mapping shows beside the caustics.
struct OtherPass {
    PhotonList photons;
    std::uint64_t rays = 0, emitted = 0;
    EnergyBalance energy;  ///< of the pass, scene units
};

/// L S+ D photons by guided emission. `visible`: photons outside of it are dropped, and not useful (null: all are). `tally`
/// counts what became of the paths (null: nobody asks).
[[nodiscard]] CausticPass traceCausticPhotons(const Scene& scene, const EmissionGuide& guide, const PhotonPassKey& key,
                                              const VisibleCells* visible, const Workers& workers,
                                              CasterTally* tally = nullptr);

/// All photons that arrive at D vertices, lights by power.
[[nodiscard]] GlobalPass traceGlobalPhotons(const Scene& scene, const PhotonPassKey& key, const Workers& workers);

/// Of the same paths those photons that came neither directly nor over S alone, where the camera looks.
[[nodiscard]] OtherPass traceOtherPhotons(const Scene& scene, const PhotonPassKey& key, const VisibleCells& visible,
                                          const Workers& workers);

}  // namespace pellucid

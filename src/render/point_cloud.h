/// What a render has stored in space, as PLY point clouds that Blender and MeshLab open: cache records and caustic photons, in
/// the metres and axes of the scene file (y up).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <pellucid/scene/scene.h>
#include <pellucid/transport/irradiance_cache.h>
#include <pellucid/transport/photon.h>

namespace pellucid {

/// Binary little-endian PLY with float properties x y z nx ny nz irradiance_red/green/blue (W m^-2) radius (m), and red green
/// blue (uchar) to look at.
[[nodiscard]] std::string recordsPly(const std::vector<IrradianceRecord>& records, const Normalisation& scene);

/// As recordsPly, with wi_x wi_y wi_z (unit, to where the photon came from) and flux_red/green/blue (W) in place of
/// irradiance and radius.
[[nodiscard]] std::string photonsPly(const PhotonList& photons, const Normalisation& scene);

/// `records.ply` and `caustic-photons.ply` in a folder, which is made if need be. Throws Error{CannotFinish}.
void writePointClouds(const std::filesystem::path& folder, const std::vector<IrradianceRecord>& records,
                      const PhotonList& photons, const Normalisation& scene);

}  // namespace pellucid

/// What a render has stored in space, as PLY point clouds that Blender and MeshLab open: cache records, caustic photons and
/// the places of the global map, in the metres and axes of the scene file (y up).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <pellucid/scene/scene.h>
#include <pellucid/transport/irradiance_cache.h>
#include <pellucid/transport/photon.h>
#include <pellucid/transport/radiance_map.h>

namespace pellucid {

/// Binary little-endian PLY with float properties x y z nx ny nz irradiance_red/green/blue (W m^-2) radius (m), and red green
/// blue (uchar) to look at.
[[nodiscard]] std::string recordsPly(const std::vector<IrradianceRecord>& records, const Normalisation& scene);

/// As recordsPly, with wi_x wi_y wi_z (unit, to where the photon came from) and flux_red/green/blue (W) in place of
/// irradiance and radius.
[[nodiscard]] std::string photonsPly(const PhotonList& photons, const Normalisation& scene);

/// As recordsPly, of the places at which the global map answers gather rays; the radius is that of their estimate.
[[nodiscard]] std::string placesPly(const std::vector<RadianceMap::Place>& places, const Normalisation& scene);

/// What the indirect side has stored.
struct StoredPoints {
    std::vector<IrradianceRecord> records;
    std::vector<RadianceMap::Place> places;  ///< of the global map; empty where there is none
};

/// `records.ply`, `caustic-photons.ply` and, where there is a global map, `global-map.ply` in a folder, which is made if need be. Throws Error{CannotFinish}.
void writePointClouds(const std::filesystem::path& folder, const StoredPoints& points, const PhotonList& photons,
                      const Normalisation& scene);

}  // namespace pellucid

/// What a scene file says, in metres, before normalisation: the hand-over from io/ to scene/. Plain data, already checked
/// (finite numbers, indices in range, no empty meshes).
#pragma once

#include <string>
#include <vector>

#include <pellucid/geometry/mesh.h>
#include <pellucid/math/image.h>
#include <pellucid/scene/camera.h>
#include <pellucid/surface/material.h>

namespace pellucid {

enum class PunctualKind { Point, Spot, Directional };

/// KHR_lights_punctual. The light sits at `position` and points along `direction` (unit; spot and directional).
struct PunctualLight {
    std::string name;
    PunctualKind kind = PunctualKind::Point;
    glm::dvec3 position{0.0};
    glm::dvec3 direction{0.0, 0.0, -1.0};
    Rgb intensity{1.0F};  ///< W/sr for point and spot, W/m^2 for directional (colour x intensity)
    double innerCone = 0.0, outerCone = 0.7853981633974483;  ///< half angles, radians
};

struct SceneDescription {
    std::string name;  ///< the file's name without folders
    std::vector<Mesh> meshes;
    std::vector<Geometry> geometries;
    std::vector<Material> materials;  ///< never empty: the default material stands where none is named
    std::vector<CameraSpec> cameras;
    std::vector<PunctualLight> lights;
    std::vector<std::string> extensionsUsed, extensionsIgnored;
    std::vector<std::string> warnings;  ///< one line each
    std::string contentHash;            ///< hex digest of the file and of every file that it names
    std::size_t droppedTriangles = 0;   ///< degenerate ones
};

/// Light from infinity, given by the user: a constant, or an equirectangular map (RGB, y up; scene/environment.h has the
/// mapping). Radiance, W m^-2 sr^-1.
struct EnvironmentDescription {
    Rgb constant{0.0F};
    Image map;                     ///< empty: constant
    std::size_t mendedTexels = 0;  ///< NaN, infinite or negative ones, set to 0
    std::string contentHash;
};

}  // namespace pellucid

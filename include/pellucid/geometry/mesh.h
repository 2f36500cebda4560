/// Triangle meshes in their own space, and the geometries (mesh + transform) that place them in the scene.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace pellucid {

/// All attribute arrays are empty or as long as `positions`; indices are checked by whoever fills the mesh.
struct Mesh {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;   ///< unit; empty: flat shading
    std::vector<glm::vec4> tangents;  ///< xyz unit, w = handedness +-1; empty: derived from uv where needed
    std::vector<glm::vec2> uv0, uv1;  ///< glTF convention: (0,0) is the image's upper left corner
    std::vector<glm::vec4> colors;    ///< linear, multiplies the base colour
    std::vector<glm::uvec3> triangles;
    std::uint32_t material = 0;  ///< index into the scene's materials
};

/// One placement of a mesh. `toWorld` is affine and invertible, in metres; under a negative determinant, which turns the
/// winding over, Scene keeps the front on the side of the mirrored normals.
struct Geometry {
    std::uint32_t mesh = 0;
    glm::dmat4 toWorld{1.0};
};

}  // namespace pellucid

/// A walk written down vertex by vertex, for `render --debug-sample`: what was hit, and what the path carried and had
/// gathered when it came there.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include <pellucid/math/rgb.h>
#include <pellucid/surface/bsdf.h>
#include <pellucid/transport/path_classes.h>

namespace pellucid {

struct TracedVertex {
    bool hit = true;           ///< false: the ray left the scene
    glm::vec3 position{0.0F};  ///< scene units; the direction where nothing was hit
    glm::vec3 normal{0.0F};    ///< shading normal
    float distance = 0.0F;     ///< from the vertex before, scene units
    std::uint32_t geometry = 0, primitive = 0, material = 0;
    LobeKinds kinds = kNoLobe;
    bool backSide = false;
    Wave wave;               ///< at which it scatters
    Rgb throughput{1.0F};    ///< on arrival
    LayeredRadiance before;  ///< gathered before this vertex
};

using WalkTrace = std::vector<TracedVertex>;

}  // namespace pellucid

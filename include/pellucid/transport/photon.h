/// A stored photon: where flux arrived, from where, on which surface.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include <pellucid/math/rgb.h>

namespace pellucid {

struct Photon {
    glm::vec3 position{0.0F};
    glm::vec3 wi{0.0F};           ///< to where it came from, unit
    glm::vec3 normal{0.0F};       ///< geometric, on wi's side
    Rgb flux{0.0F};               ///< W, already divided by the number of emitted paths
    float etendueDensity = 0.0F;  ///< of its emission by an unguided pass: Lights::etendueDensity()
};

using PhotonList = std::vector<Photon>;

}  // namespace pellucid

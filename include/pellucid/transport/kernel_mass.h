/// How much of a kernel lies on the surface around its middle: 1 in the open, one half at the edge of a table or the foot of a
/// wall, where a density estimate loses the other half. Dividing by it mends that boundary bias to first order. [Silverman1986]
/// Found by probes: places in the disc that can be reached along the surface and have surface of the same side under them.
#pragma once

#include <cstdint>

#include <pellucid/scene/scene.h>
#include <pellucid/transport/photon_kernel.h>

namespace pellucid {

/// Whether a surface of the same side lies within `depth` under `start`: its normal and `normal` have at least this cosine.
[[nodiscard]] bool surfaceUnder(const Scene& scene, const glm::vec3& start, const glm::vec3& normal, float depth,
                                float leastCosine) noexcept;

/// `turn` in [0,1) turns the places around the normal. Adds its rays to `rays`. At least one tenth.
[[nodiscard]] float kernelMass(const Scene& scene, const glm::vec3& point, const glm::vec3& normal, float radius,
                               PhotonKernel kernel, float turn, std::uint64_t& rays) noexcept;

}  // namespace pellucid

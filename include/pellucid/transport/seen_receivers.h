/// What an eye path a pixel sees of the receivers in mirrors and through glass: it walks over S lobes alone, and wherever it
/// stands at a D lobe after at least one of them, that place is seen. [algorithms: E S+ D]
#pragma once

#include <cstdint>
#include <vector>

#include <pellucid/base/parallel.h>
#include <pellucid/scene/scene.h>

namespace pellucid {

struct SeenReceiver {
    std::uint32_t pixel = 0;
    std::uint32_t geometry = 0, primitive = 0;
    glm::vec2 barycentric{0.0F};
    bool backSide = false;
    Rgb weight{0.0F};  ///< throughput x rho / pi x T(wo)
    DiffuseLobe lobe;
};

struct SeenReceivers {
    std::vector<SeenReceiver> places;  ///< in the order of the pixels
    std::uint64_t rays = 0;
};

[[nodiscard]] SeenReceivers lookOverSpecular(const Scene& scene, const Camera& camera, std::uint64_t seed,
                                             std::uint32_t pass, const Workers& workers);

}  // namespace pellucid

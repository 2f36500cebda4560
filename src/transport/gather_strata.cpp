#include <pellucid/transport/gather_strata.h>

#include <algorithm>
#include <cmath>

#include <pellucid/math/constants.h>

namespace pellucid {

glm::vec3 GatherStrata::direction(int j, int k, const glm::vec2& within) const noexcept {
    const float sin2 = (static_cast<float>(j) + within.x) / static_cast<float>(elevations);
    const float phi = kTwoPi * (static_cast<float>(k) + within.y) / static_cast<float>(azimuths);
    const float sine = std::sqrt(sin2), cosine = std::sqrt(std::max(0.0F, 1.0F - sin2));
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

std::size_t GatherStrata::containing(const glm::vec3& local) const noexcept {
    const float sin2 = local.x * local.x + local.y * local.y;
    const float phi = std::atan2(local.y, local.x), turn = (phi < 0.0F ? phi + kTwoPi : phi) / kTwoPi;
    const int j = std::min(elevations - 1, static_cast<int>(sin2 * static_cast<float>(elevations)));
    const int k = std::min(azimuths - 1, static_cast<int>(turn * static_cast<float>(azimuths)));
    return index(j, k);
}

}  // namespace pellucid

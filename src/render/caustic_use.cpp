#include "caustic_use.h"

#include <algorithm>
#include <bit>
#include <tuple>

namespace pellucid {

namespace {

[[nodiscard]] bool before(const glm::vec3& a, const glm::vec3& b) noexcept {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

}  // namespace

/// A map has its own order of photons; their places, which it keeps bit by bit, tell which is which.
void CausticUse::count(const CausticMap& map) {
    std::vector<glm::vec3> used = map.used();
    std::sort(used.begin(), used.end(), before);
    counts_.assign(tally_.lamps().size() * tally_.casters().size(), {});
    for (const PhotonOrigin& origin : origins_) {
        const bool summed = std::binary_search(used.begin(), used.end(), origin.position, before);
        for (std::uint64_t rest = origin.casters; rest != 0; rest &= rest - 1) {
            Count& c =
                counts_[origin.lamp * tally_.casters().size() + static_cast<std::size_t>(std::countr_zero(rest))];
            ++c.stored;
            if (summed) ++c.used;
        }
    }
    std::vector<PhotonOrigin>().swap(origins_);
}

void CausticUse::tell(std::vector<CausticLink>& links) const {
    if (counts_.empty()) return;
    for (CausticLink& link : links) {
        const Count& c = counts_[link.lampIndex * tally_.casters().size() + link.casterIndex];
        link.watched = true;
        link.stored = c.stored;
        link.used = c.used;
    }
}

}  // namespace pellucid

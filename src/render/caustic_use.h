/// Which photons of the first iteration a pixel's kernel has summed, by the lamp that sent them and the casters that they met:
/// the last column of "why is there no caustic?". Useful photons lie near what the camera sees; used ones were seen.
#pragma once

#include <cstdint>
#include <vector>

#include <pellucid/render/render.h>
#include <pellucid/transport/caster_tally.h>
#include <pellucid/transport/caustic_map.h>

namespace pellucid {

class CausticUse {
public:
    explicit CausticUse(const Scene& scene) : tally_(scene) {}

    /// The first paths of a pass, so that a large one takes no more memory to be asked.
    static constexpr std::uint32_t kWatchedPaths = 1U << 18U;

    [[nodiscard]] CasterTally& tally() noexcept { return tally_; }
    void stored(std::vector<PhotonOrigin> origins) noexcept { origins_ = std::move(origins); }
    /// After the look-ups: counts by pair, and forgets the photons.
    void count(const CausticMap& map);
    /// Writes the counts into their pairs. Nothing before count().
    void tell(std::vector<CausticLink>& links) const;

private:
    struct Count {
        std::uint64_t stored = 0, used = 0;
    };
    CasterTally tally_;
    std::vector<PhotonOrigin> origins_;
    std::vector<Count> counts_;  ///< by lamp, then by caster
};

}  // namespace pellucid

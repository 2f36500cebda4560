/// "Why is there no caustic?": for every lamp and caster what the pilot's photons did, and the reason where nothing arrives.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include <pellucid/render/render.h>
#include <pellucid/transport/caster_tally.h>

namespace pellucid {

/// The reason where nothing is known.
inline constexpr std::string_view kNoPilotPath = "no pilot path began at this lamp";

/// One row a pair, those that matter most first: useful photons, then hits, then the power of the lamp. `receivers`: pixels
/// whose path finds a diffuse surface.
[[nodiscard]] std::vector<CausticLink> causticLinks(const Scene& scene, const CasterTally& tally,
                                                    std::size_t receivers);

/// At most `rows` of them; the last one sums the rest.
[[nodiscard]] std::vector<CausticLink> shortened(const std::vector<CausticLink>& links, std::size_t rows);

}  // namespace pellucid

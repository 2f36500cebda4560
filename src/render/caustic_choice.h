/// Whether caustics are better left to eye paths than to photons. One bounce at rough metal is what next-event estimation
/// reaches from the metal itself: such caustics it shows without a kernel's blur. Behind glass it sees no lamp, over smooth
/// metal it meets none, and what large lamps cast is so even that wide kernels are the better.
#pragma once

#include <optional>
#include <string>

#include <pellucid/scene/scene.h>

namespace pellucid {

/// The reason, with its numbers, to leave all caustics of the scene to eye paths; none: photons.
[[nodiscard]] std::optional<std::string> causticsLeftToEyePaths(const Scene& scene);

}  // namespace pellucid

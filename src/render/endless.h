/// Rooms without an answer: closed, and with nothing in them that absorbs. Light that enters never leaves, so there is no
/// steady state; paths are ended by chance, and what a picture shows grows with their allowed length.
#pragma once

#include <optional>
#include <string>

#include <pellucid/base/parallel.h>
#include <pellucid/scene/scene.h>

namespace pellucid {

/// What to tell about such a scene; empty for every other. A pilot of a few paths from the camera decides, and only where
/// some material reflects everything.
[[nodiscard]] std::optional<std::string> endlessRemark(const Scene& scene, const Camera& camera);

}  // namespace pellucid

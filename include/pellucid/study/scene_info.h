/// What a scene holds, for `info`: as JSON and for people.
#pragma once

#include <string>

#include <pellucid/scene/scene.h>

namespace pellucid {

[[nodiscard]] std::string infoJson(const Scene& scene, const std::string& file);
[[nodiscard]] std::string infoText(const Scene& scene, const std::string& file);

}  // namespace pellucid

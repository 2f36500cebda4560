/// The page docs/options.md: the table of parameters (render/settings.h) for people. `pellucid options` prints it, and a
/// test compares the page that stands in docs/ with it.
#pragma once

#include <string>

namespace pellucid {

[[nodiscard]] std::string settingsMarkdown();

}  // namespace pellucid

/// "Did you mean ...?": the known name that a mistyped one is nearest to, for error messages.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace pellucid {

/// Number of insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b` (optimal string
/// alignment, a restricted Damerau-Levenshtein distance).
[[nodiscard]] std::size_t editDistance(std::string_view a, std::string_view b);

/// The candidate at the least distance from `name`; the part after a candidate's dot counts as a name too, so that
/// "alhpa" finds "photon.alpha". The first of equals; empty without candidates.
[[nodiscard]] std::string_view nearestName(std::string_view name, std::span<const std::string_view> candidates);

}  // namespace pellucid

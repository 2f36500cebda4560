/// Pairs of triangles whose boxes overlap: both sets are halved together until few are left.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <pellucid/math/bounds.h>

namespace pellucid {

/// Calls visit(i, j) once for each i of `first` and j of `second` with boxes[i] and boxes[j] overlapping, in an order that
/// depends on nothing else. False when somewhere more boxes than could be looked at lie in one place: some pairs are missing.
bool forOverlappingPairs(std::span<const Bounds> boxes, const std::vector<std::uint32_t>& first,
                         const std::vector<std::uint32_t>& second,
                         const std::function<void(std::uint32_t, std::uint32_t)>& visit);

}  // namespace pellucid

/// The numbers that keep the random numbers of the passes apart: each is added to the number of the iteration.
#pragma once

#include <cstdint>

namespace pellucid {

constexpr std::uint64_t kCausticPass = 1ULL << 40U, kGlobalPass = 2ULL << 40U, kLightPass = 3ULL << 40U,
                        kCachePass = 4ULL << 40U, kBidirectionalPass = 5ULL << 40U, kOtherPass = 6ULL << 40U,
                        kRefinedPass = 7ULL << 40U;

}  // namespace pellucid

/// The largest resident memory of this process since a moment, for figures of one run among many.
#pragma once

#include <cstdint>

namespace pellucid {

/// Begins anew where the system allows it (Linux); else the peak stays that of the whole process.
void resetPeakMemory() noexcept;
/// 0 where the system does not tell.
[[nodiscard]] std::uint64_t peakMemoryBytes() noexcept;

}  // namespace pellucid

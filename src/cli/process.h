/// What a command asks of the operating system.
#pragma once

#include <cstdint>

namespace pellucid {

/// From now on the first SIGINT or SIGTERM only sets a flag; a second one ends the program as usual.
void catchInterrupts();
[[nodiscard]] bool interruptAsked() noexcept;

/// Largest resident memory so far.
[[nodiscard]] std::uint64_t peakRssBytes() noexcept;

}  // namespace pellucid

/// What a command asks of the operating system.
#pragma once

#include <cstdint>

namespace pellucid {

/// From now on SIGINT and SIGTERM end the program at once with status 130. Nothing half done is left under a final name:
/// files are written aside and renamed.
void exitOnInterrupts();

/// From now on a file that reaches the limit on its size is an error like a full disk, not the end of the program.
void failOnFullFiles();

/// From now on the first SIGINT or SIGTERM only sets a flag; a second one ends the program at once.
void catchInterrupts();
[[nodiscard]] bool interruptAsked() noexcept;

/// Seconds since this process was made, before its libraries were loaded; 0 where the system does not tell.
[[nodiscard]] double processAge();

/// Largest resident memory so far.
[[nodiscard]] std::uint64_t peakRssBytes() noexcept;

}  // namespace pellucid

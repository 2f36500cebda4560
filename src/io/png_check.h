/// Whether a PNG is whole, chunk by chunk with their check sums. Damaged files are told of before the decoder sees
/// them: libpng, as OpenImageIO sets it up, prints its complaints to standard error, which is not the library's to use.
#pragma once

#include <cstddef>
#include <span>

namespace pellucid {

[[nodiscard]] bool isPng(std::span<const std::byte> bytes) noexcept;

/// From the signature to IEND; what comes after does not count.
[[nodiscard]] bool isWholePng(std::span<const std::byte> bytes) noexcept;

}  // namespace pellucid

/// Integer hashes for keyed random numbers and for ordering that does not depend on threads.
#pragma once

#include <cstdint>

namespace pellucid {

/// 64-bit finaliser of SplitMix (Stafford's variant 13).
[[nodiscard]] constexpr std::uint64_t hash64(std::uint64_t x) noexcept {
    x ^= x >> 30U;
    x *= 0xbf58476d1ce4e5b9ULL;
    x ^= x >> 27U;
    x *= 0x94d049bb133111ebULL;
    x ^= x >> 31U;
    return x;
}

[[nodiscard]] constexpr std::uint64_t hashCombine(std::uint64_t a, std::uint64_t b) noexcept {
    return hash64(a + 0x9e3779b97f4a7c15ULL + hash64(b + 0x632be59bd9b4e019ULL));
}

}  // namespace pellucid

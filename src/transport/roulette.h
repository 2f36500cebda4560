/// Russian roulette, as all paths play it: one that survives is worth the inverse of its chance, so nothing is lost on average.
#pragma once

#include <algorithm>

namespace pellucid {

/// A path's chance to go on, at most 1, from what its throughput asks for. Beyond 64 vertices no path goes on for certain, so
/// that closed rooms of albedo 1 end.
[[nodiscard]] inline float survival(float wanted, int vertices) noexcept {
    constexpr int kCertainVertices = 64;
    constexpr float kSurvivalBeyond = 0.9995F;
    const float chance = std::min(1.0F, wanted);
    return vertices > kCertainVertices ? std::min(chance, kSurvivalBeyond) : chance;
}

/// Along smooth chains from the eye whose branches are all followed roulette is mild, at so many surfaces and no more: beyond, branches
/// that total reflection keeps inside for thousands of bounces would be followed more often than by chance.
inline constexpr int kMostParting = 8;

}  // namespace pellucid

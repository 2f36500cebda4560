/// Independent uniform numbers, apart from the renderer's low-discrepancy ones: what the theory of Monte Carlo assumes.
#pragma once

#include <cstdint>

#include <pellucid/math/hash.h>

namespace pellucid::check {

class Independent {
public:
    explicit Independent(std::uint64_t seed) noexcept : key_(hash64(seed + 0x9e3779b97f4a7c15ULL)) {}
    /// In [0, 1).
    [[nodiscard]] double next() noexcept {
        return static_cast<double>(hash64(key_ + 0x9e3779b97f4a7c15ULL * ++count_) >> 11U) * 0x1p-53;
    }

private:
    std::uint64_t key_, count_ = 0;
};

}  // namespace pellucid::check

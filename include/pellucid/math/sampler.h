/// Numbers keyed by (seed, stream, index, dimension): no state is shared between threads, so the same key
/// gives the same number in any order. A stream is a pixel (index = sample) or a photon pass (index = photon path).
/// The default: padded two-dimensional Sobol points with hash-based Owen scrambling and an Owen-scrambled index
/// [Burley2020]. The others show what that is worth; all are unbiased.
#pragma once

#include <bit>
#include <cstdint>

#include <glm/glm.hpp>

#include <pellucid/math/hash.h>

namespace pellucid {

/// Independent: hashed. Stratified: each block of 16 indices has one jittered number in each of 4 x 4 (16) strata. Halton:
/// a prime base a dimension with Owen-scrambled digits, hashed numbers beyond the last prime. [Owen1995]
enum class SamplerKind : std::uint8_t { Sobol, Independent, Stratified, Halton };

class Sampler {
public:
    Sampler(std::uint64_t seed, std::uint64_t stream, std::uint32_t index,
            SamplerKind kind = SamplerKind::Sobol) noexcept
        : key_(hashCombine(seed, stream)), index_(index), kind_(kind) {}

    /// A point of a (0,2)-sequence in [0,1)^2.
    [[nodiscard]] glm::vec2 next2D() noexcept {
        if (kind_ != SamplerKind::Sobol) return other2D();
        const std::uint64_t seed = hash64(key_ + 0x9e3779b97f4a7c15ULL * ++dimension_);
        const auto low = static_cast<std::uint32_t>(seed), high = static_cast<std::uint32_t>(seed >> 32U);
        const std::uint32_t index = reverse(laineKarras(reverse(index_), low ^ (high << 7U)));
        return {toFloat(reverse(laineKarras(index, low))), toFloat(reverse(laineKarras(pascal(index), high)))};
    }

    [[nodiscard]] float next1D() noexcept {
        if (kind_ != SamplerKind::Sobol) return other1D();
        const std::uint64_t seed = hash64(key_ + 0x9e3779b97f4a7c15ULL * ++dimension_);
        const auto low = static_cast<std::uint32_t>(seed), high = static_cast<std::uint32_t>(seed >> 32U);
        const std::uint32_t index = reverse(laineKarras(reverse(index_), high));
        return toFloat(reverse(laineKarras(index, low)));
    }

    /// The `part`-th of `parts` that this sample splits into: together they are the sequence's next ones in every dimension.
    [[nodiscard]] Sampler split(std::uint32_t part, std::uint32_t parts) const noexcept {
        Sampler one = *this;
        one.index_ = index_ * parts + part;
        return one;
    }

    /// Goes to a fixed dimension, so that a decision keeps its numbers whatever was drawn before it.
    void setDimension(std::uint64_t dimension) noexcept { dimension_ = dimension; }

private:
    [[nodiscard]] glm::vec2 other2D() noexcept;
    [[nodiscard]] float other1D() noexcept;

    [[nodiscard]] static constexpr std::uint32_t reverse(std::uint32_t x) noexcept {
        x = __builtin_bswap32(x);
        x = ((x & 0x0f0f0f0fU) << 4U) | ((x >> 4U) & 0x0f0f0f0fU);
        x = ((x & 0x33333333U) << 2U) | ((x >> 2U) & 0x33333333U);
        return ((x & 0x55555555U) << 1U) | ((x >> 1U) & 0x55555555U);
    }

    /// Owen scrambling of a number whose bits stand in reverse (lowest bit = most significant digit).
    [[nodiscard]] static constexpr std::uint32_t laineKarras(std::uint32_t x, std::uint32_t seed) noexcept {
        x ^= x * 0x3d20adeaU;
        x += seed;
        x *= (seed >> 16U) | 1U;
        x ^= x * 0x05526c56U;
        x ^= x * 0x53a22864U;
        return x;
    }

    /// The second Sobol dimension, bits in reverse: its generator is Pascal's triangle modulo 2, a superset sum over bits.
    [[nodiscard]] static constexpr std::uint32_t pascal(std::uint32_t x) noexcept {
        x ^= (x & 0xaaaaaaaaU) >> 1U;
        x ^= (x & 0xccccccccU) >> 2U;
        x ^= (x & 0xf0f0f0f0U) >> 4U;
        x ^= (x & 0xff00ff00U) >> 8U;
        x ^= (x & 0xffff0000U) >> 16U;
        return x;
    }

    [[nodiscard]] static constexpr float toFloat(std::uint32_t x) noexcept {
        return static_cast<float>(x >> 8U) * 0x1p-24F;
    }

    std::uint64_t key_;
    std::uint32_t index_;
    std::uint64_t dimension_ = 0;
    SamplerKind kind_;
};

}  // namespace pellucid

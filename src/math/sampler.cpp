// The samplers beside the default one: for showing what it is worth, not for speed.
#include <pellucid/math/sampler.h>

#include <algorithm>
#include <array>

namespace pellucid {

namespace {

constexpr std::size_t kPrimes = 256;
constexpr std::uint32_t kStrata = 16, kSide = 4;

constexpr std::array<std::uint32_t, kPrimes> firstPrimes() {
    std::array<std::uint32_t, kPrimes> primes{};
    std::size_t count = 0;
    for (std::uint32_t n = 2; count < kPrimes; ++n) {
        bool prime = true;
        for (std::size_t i = 0; i < count && primes[i] * primes[i] <= n; ++i) prime = prime && n % primes[i] != 0;
        if (prime) primes[count++] = n;
    }
    return primes;
}
constexpr std::array<std::uint32_t, kPrimes> kPrime = firstPrimes();

[[nodiscard]] float unit(std::uint64_t bits) noexcept { return static_cast<float>(bits >> 40U) * 0x1p-24F; }
[[nodiscard]] float below1(double x) noexcept { return std::min(static_cast<float>(x), 0x1.fffffep-1F); }

/// A permutation of 0..15: steps that are one to one on four bits, driven by the seed's.
[[nodiscard]] std::uint32_t permuted(std::uint32_t i, std::uint64_t seed) noexcept {
    for (int round = 0; round < 3; ++round, seed >>= 12U) {
        i ^= static_cast<std::uint32_t>(seed) & 15U;
        i = (i * (static_cast<std::uint32_t>(seed >> 4U) | 1U)) & 15U;
        i ^= i >> 2U;
        i = (i + static_cast<std::uint32_t>(seed >> 8U)) & 15U;
    }
    return i;
}

/// Radical inverse with nested random digit permutations d -> a d + c mod base, drawn for each prefix. [Owen1995]
[[nodiscard]] float scrambledRadicalInverse(std::uint32_t index, std::uint32_t base, std::uint64_t seed) noexcept {
    double value = 0.0, digitSize = 1.0;
    std::uint64_t prefix = seed;
    while (digitSize > 0x1p-25) {
        const std::uint64_t h = hash64(prefix);
        const std::uint64_t digit = index % base, a = 1 + (h & 0xffffffffU) % (base - 1), c = (h >> 32U) % base;
        index /= base;
        digitSize /= base;
        value += static_cast<double>((a * digit + c) % base) * digitSize;
        prefix = hashCombine(prefix, digit);
    }
    return below1(value);
}

}  // namespace

glm::vec2 Sampler::other2D() noexcept {
    const std::uint64_t dimension = ++dimension_, seed = hash64(key_ + 0x9e3779b97f4a7c15ULL * dimension);
    if (kind_ == SamplerKind::Halton && 2 * dimension + 1 < kPrimes)
        return {scrambledRadicalInverse(index_, kPrime[2 * dimension], seed),
                scrambledRadicalInverse(index_, kPrime[2 * dimension + 1], seed ^ 1U)};
    const std::uint64_t first = hashCombine(seed, index_), second = hash64(first);
    if (kind_ != SamplerKind::Stratified) return {unit(first), unit(second)};
    const std::uint32_t cell = permuted(index_ % kStrata, hashCombine(~seed, index_ / kStrata));
    return {below1((cell % kSide + static_cast<double>(unit(first))) / kSide),
            below1((cell / kSide + static_cast<double>(unit(second))) / kSide)};
}

float Sampler::other1D() noexcept {
    const std::uint64_t dimension = ++dimension_, seed = hash64(key_ + 0x9e3779b97f4a7c15ULL * dimension);
    if (kind_ == SamplerKind::Halton && 2 * dimension < kPrimes)
        return scrambledRadicalInverse(index_, kPrime[2 * dimension], seed);
    const std::uint64_t number = hashCombine(seed, index_);
    if (kind_ != SamplerKind::Stratified) return unit(number);
    const std::uint32_t cell = permuted(index_ % kStrata, hashCombine(~seed, index_ / kStrata));
    return below1((cell + static_cast<double>(unit(number))) / kStrata);
}

}  // namespace pellucid

/// What a photon map keeps of a photon beside its position: eight bytes. Power as three mantissas under one exponent, rounded by
/// a coin so that its mean is exact however many photons have the same power; direction and normal as points of an octahedron
/// [Meyer2010], eight bits an axis: within a degree, for the lobe's transmittance and for telling surfaces apart.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

#include <pellucid/math/hash.h>
#include <pellucid/math/rgb.h>

namespace pellucid {

/// A unit vector on an octahedron that is folded flat.
class OctahedralVector {
public:
    OctahedralVector() = default;
    explicit OctahedralVector(const glm::vec3& v) noexcept {
        const float sum = std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
        glm::vec2 p = sum > 0.0F ? glm::vec2(v) / sum : glm::vec2(0.0F);
        if (v.z < 0.0F) p = fold(p);
        x_ = quantised(p.x);
        y_ = quantised(p.y);
    }

    /// In its direction, of a length between 0.57 and 1.
    [[nodiscard]] glm::vec3 direction() const noexcept {
        const glm::vec2 p(static_cast<float>(x_) * kStep, static_cast<float>(y_) * kStep);
        const float z = 1.0F - std::fabs(p.x) - std::fabs(p.y);
        return {z < 0.0F ? fold(p) : p, z};
    }
    [[nodiscard]] glm::vec3 unit() const noexcept { return glm::normalize(direction()); }
    bool operator==(const OctahedralVector&) const = default;

private:
    static constexpr float kStep = 1.0F / 127.0F;
    [[nodiscard]] static glm::vec2 fold(const glm::vec2& p) noexcept {
        return {std::copysign(1.0F - std::fabs(p.y), p.x), std::copysign(1.0F - std::fabs(p.x), p.y)};
    }
    [[nodiscard]] static std::int8_t quantised(float v) noexcept {
        return static_cast<std::int8_t>(std::lround(std::clamp(v, -1.0F, 1.0F) * 127.0F));
    }
    std::int8_t x_ = 0, y_ = 0;
};

/// Power of three colours; each is one of two neighbours of what it was, with the exact mean over the coin.
class PackedFlux {
public:
    PackedFlux() = default;
    PackedFlux(const Rgb& flux, std::uint64_t coin) noexcept {
        const float largest = std::max({flux.r, flux.g, flux.b});
        if (!(largest > 0.0F)) return;
        const int above = std::ilogb(largest) + 1;
        const bool next = std::ldexp(largest, -above) * kSteps > kLargest;  // the coin must not ask for a step too many
        const int exponent = std::clamp(next ? above + 1 : above, 1 - kBias, 254 - kBias);
        exponent_ = static_cast<std::uint8_t>(exponent + kBias);
        const float scale = std::ldexp(kSteps, -exponent);
        std::uint64_t bits = hash64(coin);
        for (glm::length_t c = 0; c < 3; ++c, bits >>= 21U) {
            const float u = static_cast<float>(bits & 0x1fffffU) * 0x1p-21F;
            mantissa_[c] = static_cast<std::uint8_t>(std::min(kLargest, std::max(0.0F, flux[c]) * scale + u));
        }
    }

    [[nodiscard]] Rgb value() const noexcept {
        const float scale = std::bit_cast<float>(static_cast<std::uint32_t>(exponent_) << 23U) / kSteps;
        return {static_cast<float>(mantissa_[0]) * scale, static_cast<float>(mantissa_[1]) * scale,
                static_cast<float>(mantissa_[2]) * scale};
    }

private:
    static constexpr int kBias = 127;
    static constexpr float kSteps = 256.0F, kLargest = 255.0F;  ///< powers of two are exact
    std::uint8_t mantissa_[3] = {}, exponent_ = 0;
};

struct PackedPhoton {
    PackedFlux flux;
    OctahedralVector wi, normal;
};
static_assert(sizeof(PackedPhoton) == 8);

}  // namespace pellucid

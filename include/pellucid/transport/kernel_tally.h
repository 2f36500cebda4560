/// What one look-up met, cell by cell of its disc: eight cells of equal area, the four quadrants of the tangent plane inside
/// and outside of half the area. Even light fills them alike; whether it did is a chi^2 test. [Lin2020]
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/glm.hpp>

#include <pellucid/math/frame.h>

namespace pellucid {

struct KernelTally {
    static constexpr std::size_t kCells = 8;

    std::uint32_t photons = 0;
    std::array<float, kCells> flux{};  ///< luminance
    float squares = 0.0F;              ///< of the photons' luminance, all cells

    /// `part`: (d/r)^2.
    void add(const Frame& frame, const glm::vec3& offset, float part, float luminance) noexcept {
        const std::size_t quadrant =
            (glm::dot(offset, frame.tangent) < 0.0F ? 2U : 0U) + (glm::dot(offset, frame.bitangent) < 0.0F ? 1U : 0U);
        ++photons;
        flux[quadrant + (part < 0.5F ? 0U : 4U)] += luminance;
        squares += luminance * luminance;
    }
    void add(const KernelTally& other) noexcept {
        photons += other.photons;
        squares += other.squares;
        for (std::size_t c = 0; c < kCells; ++c) flux[c] += other.flux[c];
    }

    /// How many photons of equal power would be as noisy.
    [[nodiscard]] double equalPhotons() const noexcept {
        const double sum = total();
        return squares > 0.0F ? sum * sum / static_cast<double>(squares) : 0.0;
    }
    /// Sum over cells of (flux - expected)^2 / variance: chi^2 with kCells - 1 degrees of freedom where light is even, also of
    /// photons of unequal power, as the variance of a cell's flux is the sum of squares that it expects.
    [[nodiscard]] double chiSquare() const noexcept {
        if (!(squares > 0.0F)) return 0.0;
        const double mean = total() / kCells;
        double sum = 0.0;
        for (const float f : flux) sum += (static_cast<double>(f) - mean) * (static_cast<double>(f) - mean);
        return sum * kCells / static_cast<double>(squares);
    }

private:
    [[nodiscard]] double total() const noexcept {
        double sum = 0.0;
        for (const float f : flux) sum += static_cast<double>(f);
        return sum;
    }
};

/// What an eye path's look-ups met in each map.
struct PhotonTally {
    KernelTally caustic, other;
};

}  // namespace pellucid

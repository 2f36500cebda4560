#include <pellucid/transport/light_by_direction.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include <pellucid/math/constants.h>

#include "packed_photon.h"

namespace pellucid {

namespace {

constexpr int kM = LightByDirection::kElevations, kN = LightByDirection::kAzimuths;
static_assert(sizeof(PackedFlux) == sizeof(std::uint32_t));

/// The integral of the direction over a bin is (A_j C_k, A_j S_k, Z_j): a normal's dot product with it is that of the cosine.
struct Bins {
    std::array<float, kM> across{}, up{}, solidAngle{};
    std::array<float, kN> c{}, s{};

    Bins() noexcept {
        const float dPhi = kTwoPi / kN;
        for (int j = 0; j < kM; ++j) {
            const auto i = static_cast<std::size_t>(j);
            const float s0 = static_cast<float>(j) / kM, s1 = static_cast<float>(j + 1) / kM;  // sin^2 theta
            // int sin^2 theta dtheta = (theta - sin theta cos theta) / 2
            const auto whole = [](float sin2) {
                return 0.5F * (std::asin(std::sqrt(sin2)) - std::sqrt(sin2 * (1.0F - sin2)));
            };
            across[i] = whole(s1) - whole(s0);
            up[i] = 0.5F * (s1 - s0) * dPhi;
            solidAngle[i] = (std::sqrt(1.0F - s0) - std::sqrt(1.0F - s1)) * dPhi;
        }
        for (int k = 0; k < kN; ++k) {
            const auto i = static_cast<std::size_t>(k);
            const float from = dPhi * static_cast<float>(k), to = from + dPhi;
            c[i] = std::sin(to) - std::sin(from);
            s[i] = std::cos(from) - std::cos(to);
        }
    }
};

[[nodiscard]] const Bins& bins() noexcept {
    static const Bins kBins;
    return kBins;
}

/// How much of stratum `i` of `fine` lies in bin `j` of `coarse`, as a share of the bin.
[[nodiscard]] float overlap(int i, int fine, int j, int coarse) noexcept {
    const float a0 = static_cast<float>(i) / static_cast<float>(fine),
                a1 = static_cast<float>(i + 1) / static_cast<float>(fine),
                b0 = static_cast<float>(j) / static_cast<float>(coarse),
                b1 = static_cast<float>(j + 1) / static_cast<float>(coarse);
    return std::max(0.0F, std::min(a1, b1) - std::max(a0, b0)) * static_cast<float>(coarse);
}

}  // namespace

LightByDirection packByDirection(const std::vector<Rgb>& radiance, int elevations, int azimuths, std::uint64_t coin) {
    LightByDirection light;
    for (int k = 0; k < kN; ++k)
        for (int j = 0; j < kM; ++j) {
            Rgb mean(0.0F);
            for (int gk = k * azimuths / kN; gk < azimuths && gk * kN < (k + 1) * azimuths; ++gk)
                for (int gj = j * elevations / kM; gj < elevations && gj * kM < (j + 1) * elevations; ++gj)
                    mean += radiance[static_cast<std::size_t>(gk * elevations + gj)] *
                            (overlap(gk, azimuths, k, kN) * overlap(gj, elevations, j, kM));
            const auto i = static_cast<std::size_t>(k * kM + j);
            light.bins[i] = std::bit_cast<std::uint32_t>(PackedFlux(mean, hashCombine(coin, i)));
        }
    return light;
}

bool isSound(const LightByDirection& light) noexcept {
    return std::all_of(light.bins.begin(), light.bins.end(),
                       [](std::uint32_t bin) { return isFinite(std::bit_cast<PackedFlux>(bin).value()); });
}

/// E(m) = pi (1 + n.m) / 2 times the mean of L under the cosines to m: sum L max(0, m.v) / sum max(0, m.v), v the integral of the
/// direction over a bin. The factor is that of even light over the part of the hemisphere that m sees.
TurnedLight turnLight(const LightByDirection& light, const glm::vec3& mapped) noexcept {
    const Bins& b = bins();
    Rgb turned(0.0F), own(0.0F), grazing(0.0F);
    float seen = 0.0F;
    for (std::size_t k = 0; k < kN; ++k) {
        const float along = mapped.x * b.c[k] + mapped.y * b.s[k];
        for (std::size_t j = 0; j < kM; ++j) {
            const Rgb radiance = std::bit_cast<PackedFlux>(light.bins[k * kM + j]).value();
            own += b.up[j] * radiance;
            const float cosine = b.across[j] * along + mapped.z * b.up[j];
            if (!(cosine > 0.0F)) continue;
            const float s = std::max(0.0F, 1.0F - cosine / b.solidAngle[j]), s2 = s * s;
            seen += cosine;
            turned += cosine * radiance;
            grazing += (cosine * s2 * s2 * s) * radiance;
        }
    }
    TurnedLight result;
    if (!(seen > 0.0F)) return {Rgb(0.0F), Rgb(0.0F)};
    const float even = 0.5F * kPi * std::max(0.0F, 1.0F + mapped.z) / seen;
    for (glm::length_t c = 0; c < 3; ++c) {
        result.ratio[c] = own[c] > 0.0F ? even * turned[c] / own[c] : 0.0F;
        result.grazingShare[c] = turned[c] > 0.0F ? grazing[c] / turned[c] : 0.0F;
    }
    return result;
}

}  // namespace pellucid

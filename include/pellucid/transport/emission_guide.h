/// Emission guiding: photons start where useful ones have started before. The five numbers that make an emission are drawn
/// from a density learnt by binary trees over the primary sample space of each light, always mixed with the unguided
/// density, so that nothing is missed; weights are exact. [Grittmann2018]
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <pellucid/math/sampler.h>
#include <pellucid/scene/lights.h>

namespace pellucid {

/// Where a useful photon began, and its weight: flux that it carried over the density it was drawn with.
struct UsefulEmission {
    std::uint32_t light = 0;
    std::array<float, 4> u{};  ///< position, direction
    float weight = 0.0F;
};

struct GuidedEmission {
    EmissionSample emission;   ///< flux is that of one emitted path, guided density included
    UsefulEmission origin;     ///< weight: inverse density (to be multiplied with the flux that arrives, relative to emission.flux)
};

class EmissionGuide {
public:
    /// Without useful emissions the guide is the unguided density: lights by power, uniform numbers.
    EmissionGuide(const Lights& lights, const std::vector<UsefulEmission>& useful);

    /// Uses the sampler's next four dimensions.
    [[nodiscard]] std::optional<GuidedEmission> sample(Sampler& sampler) const noexcept;

    [[nodiscard]] std::size_t cells() const noexcept;

private:
    struct Node {
        std::int32_t axis = -1;      ///< -1: leaf
        std::uint32_t left = 0;      ///< right = left + 1
        float leftShare = 0.5F;
    };
    struct Tree {
        std::vector<Node> nodes;
    };
    [[nodiscard]] static float density(const Tree& tree, const std::array<float, 4>& u) noexcept;
    static void warp(const Tree& tree, std::array<float, 4>& u) noexcept;
    static void build(Tree& tree, std::uint32_t node, std::vector<UsefulEmission>& items, std::size_t begin, std::size_t end,
                      std::array<float, 4> lower, std::array<float, 4> upper, int depth);

    const Lights& lights_;
    std::vector<double> lightCdf_;         ///< guided choice of light, with its unguided share mixed in
    std::vector<Tree> trees_;              ///< by light; no nodes: uniform
    float uniformShare_ = 1.0F;
};

}  // namespace pellucid

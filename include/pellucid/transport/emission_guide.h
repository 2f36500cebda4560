/// Emission guiding: photons start where useful ones have started before. The five numbers that make an emission (which light,
/// where on it, in which direction) are drawn from a density learnt by a binary tree over this primary sample space, always
/// mixed with the unguided density, so that nothing is missed; weights are exact. Lights stand in their order, so that the
/// triangles of a lamp are neighbours and share what is learnt. [Grittmann2018]
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <pellucid/math/sampler.h>
#include <pellucid/scene/lights.h>

namespace pellucid {

/// Light, position (2), direction (2), each in [0,1).
using EmissionNumbers5 = std::array<float, 5>;

/// Where a useful photon began, and its weight: flux that it carried over the density it was drawn with.
struct UsefulEmission {
    EmissionNumbers5 u{};
    float weight = 0.0F;
    glm::vec3 landed{0.0F};  ///< where it was first of use
    float density = 1.0F;    ///< it was drawn with, against no guide
};

struct GuidedEmission {
    EmissionSample emission;  ///< flux is that of one emitted path, guided density included
    /// Its weight is the inverse density: to be multiplied with the flux that arrives, relative to emission.flux.
    UsefulEmission origin;
};

class EmissionGuide {
public:
    /// Without useful emissions the guide is the unguided density: lights by power, uniform numbers. `equalShare` of the
    /// choice of light goes to each lamp alike (all emissive triangles together count as one): a weak one is found too.
    EmissionGuide(const Lights& lights, std::vector<UsefulEmission> useful, double equalShare = kEqualShare);
    /// Some of the lights alone, by power.
    EmissionGuide(const Lights& lights, const std::vector<std::uint32_t>& only, std::vector<UsefulEmission> useful);

    /// Uses the sampler's next four dimensions.
    [[nodiscard]] std::optional<GuidedEmission> sample(Sampler& sampler) const noexcept;

    /// The part of the first number that chooses this light.
    [[nodiscard]] std::array<double, 2> choosing(std::uint32_t light) const noexcept {
        return {light > 0 ? lightCdf_[light - 1] : 0.0, lightCdf_[light]};
    }

    [[nodiscard]] std::size_t cells() const noexcept { return (nodes_.size() + 1) / 2; }

    static constexpr double kEqualShare = 0.1;

private:
    struct Node {
        std::int32_t axis = -1;  ///< -1: leaf
        std::uint32_t left = 0;  ///< right = left + 1
        float leftShare = 0.5F;
    };
    [[nodiscard]] float density(const EmissionNumbers5& u) const noexcept;
    void warp(EmissionNumbers5& u) const noexcept;
    void learn(std::vector<UsefulEmission> useful);
    void build(std::uint32_t node, std::vector<UsefulEmission>& items, std::size_t begin, std::size_t end,
               const EmissionNumbers5& lower, const EmissionNumbers5& upper, int depth);

    const Lights& lights_;
    std::vector<double> lightCdf_;  ///< of the unguided choice of light
    std::vector<Node> nodes_;       ///< none: uniform
    float uniformShare_ = 1.0F;
};

}  // namespace pellucid

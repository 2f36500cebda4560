/// Which light to sample from a shading point: a few lights by an estimate of what each sends there, many by the tree
/// with the lights at infinity beside it. Private to the room.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include <pellucid/scene/lights.h>

#include "light_list.h"
#include "light_tree.h"

namespace pellucid {

class LightChoice {
public:
    LightChoice() = default;
    /// Keeps a pointer to `parts`; `entries` lists the finite lights before those at infinity.
    LightChoice(const Lights::Parts& parts, const std::vector<LightEntry>& entries);

    /// `normal` zero: no horizon. A light that cannot reach the point (below the horizon, behind a one-sided lamp,
    /// outside of a cone) has probability 0, every other one a positive one.
    [[nodiscard]] std::optional<LightPick> choose(const glm::vec3& point, const glm::vec3& normal,
                                                  double u) const noexcept;
    [[nodiscard]] float pmf(std::uint32_t light, const glm::vec3& point, const glm::vec3& normal) const noexcept;

private:
    /// What the estimates need of one light, side by side in memory.
    struct Candidate {
        LightKind kind;
        std::uint32_t index;
        float strength;  ///< peak W/sr, or W/m^2 from infinity, relative to the strongest light: no overflow
    };
    struct Weights;

    [[nodiscard]] float weight(const Candidate& candidate, const glm::vec3& point,
                               const glm::vec3& normal) const noexcept;
    [[nodiscard]] Weights weigh(const glm::vec3& point, const glm::vec3& normal) const noexcept;
    /// Share of the lights at infinity (the flat list) where a tree stands beside them.
    [[nodiscard]] float flatShare(float flatSum, const glm::vec3& point, const glm::vec3& normal) const noexcept;

    const Lights::Parts* parts_ = nullptr;
    std::uint32_t firstFlat_ = 0;  ///< light number of flat_[0]; those before it are in the tree
    std::vector<Candidate> flat_;
    LightTree tree_;
};

}  // namespace pellucid

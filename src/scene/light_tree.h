/// A binary tree over many finite lights, walked from the root with probabilities in proportion to what each child may
/// send to the shading point: strength, distance, orientation. [ContyEstevezKulla2018] A child gets probability 0 only
/// where none of its lights can reach the point, so the estimate stays unbiased. Bounds alone know little of a node whose
/// lights face every way, such as half of a glowing ball: what it sends on the mean in a direction is kept beside them, by
/// the spherical harmonics of the cosine up to order two [RamamoorthiHanrahan2001]. Private to the room.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include <pellucid/math/bounds.h>

namespace pellucid {

/// Where one light is, how strong (peak W/sr) and in which directions it shines: within `spread` + `emission`
/// (radians) of `axis`, or of its opposite when two-sided. Full within `spread`, falling like a cosine beyond it.
struct LightBounds {
    Bounds box;
    glm::vec3 axis{0.0F, 0.0F, 1.0F};
    double spread = 0.0, emission = 0.0;
    double strength = 0.0;
    bool twoSided = false;
};

/// Share of full strength that lights send in direction w on the mean: constant + linear . w + w' quadratic w.
/// max(0, n . w) = 1/4 + n . w / 2 + 5/32 (3 (n . w)^2 - 1) + ..., |n . w| = 1/2 + 5/16 (3 (n . w)^2 - 1) + ...
struct MeanEmission {
    float constant = 0.0F;
    glm::vec3 linear{0.0F};
    glm::vec3 diagonal{0.0F}, across{0.0F};  ///< of the quadratic form: xx yy zz, xy yz zx

    [[nodiscard]] static MeanEmission of(const LightBounds& light) noexcept;
    /// Strengths weigh; they are those of `this` and of `other`.
    void join(double strength, const MeanEmission& other, double otherStrength) noexcept;
    [[nodiscard]] float towards(const glm::vec3& w) const noexcept {
        return constant + glm::dot(linear, w) + glm::dot(diagonal, w * w) +
               2.0F * (across.x * w.x * w.y + across.y * w.y * w.z + across.z * w.z * w.x);
    }
};

class LightTree {
public:
    struct Choice {
        std::uint32_t light = 0;  ///< index into the lights given to the constructor
        double pmf = 0.0;
        double left = 0.0;  ///< of its number, uniform again
    };

    LightTree() = default;
    explicit LightTree(std::span<const LightBounds> lights);

    [[nodiscard]] bool empty() const noexcept { return nodes_.empty(); }
    /// `normal` zero: no surface, no horizon. `u` in [0,1). Empty: no light reaches the point, or the walk
    /// came upon a node of which that proved true only there.
    [[nodiscard]] std::optional<Choice> choose(const glm::vec3& point, const glm::vec3& normal,
                                               double u) const noexcept;
    /// The probability with which choose() returns `light`.
    [[nodiscard]] double pmf(std::uint32_t light, const glm::vec3& point, const glm::vec3& normal) const noexcept;
    /// Bound-like estimate of the irradiance at the point from all lights; 0 only where none reaches it.
    [[nodiscard]] float importance(const glm::vec3& point, const glm::vec3& normal) const noexcept;

private:
    struct Node {
        glm::vec3 centre{0.0F};
        float radius = 0.0F;
        glm::vec3 axis{0.0F, 0.0F, 1.0F};
        float strength = 0.0F;
        float cosSpread = 1.0F, sinSpread = 0.0F, cosEmission = 0.0F;
        std::uint32_t second = 0;  ///< the second child (the first stands next to its parent), or the light of a leaf
        std::uint32_t parent = 0;
        bool leaf = false, twoSided = false;
        MeanEmission mean;
    };
    struct Builder;

    [[nodiscard]] static float importance(const Node& node, const glm::vec3& point, const glm::vec3& normal) noexcept;

    std::vector<Node> nodes_;  ///< root first
    std::vector<std::uint32_t> leafOf_;
};

}  // namespace pellucid

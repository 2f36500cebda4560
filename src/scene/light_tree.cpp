#include "light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <pellucid/math/constants.h>

namespace pellucid {

namespace {

constexpr int kBins = 12;
constexpr int kMaxUnbalancedDepth = 48;  ///< below it ranges are halved, so that the depth stays near 48 + log2 n
constexpr float kLeastMean = 0.25F;      ///< of full emission, for a node as large as its distance
constexpr double kSlack = 1e-4;          ///< radians added to joined cones against rounding: bounds must hold

/// The smallest cone around two cones of half angles `a.spread`, `b.spread`. [ContyEstevezKulla2018]
void joinCones(LightBounds& a, const LightBounds& b) noexcept {
    glm::dvec3 axisA(a.axis), axisB(b.axis);
    if (a.twoSided && b.twoSided && glm::dot(axisA, axisB) < 0.0) axisB = -axisB;
    const double between = std::acos(std::clamp(glm::dot(axisA, axisB), -1.0, 1.0));
    if (between + b.spread <= a.spread) return;
    if (between + a.spread <= b.spread) {
        a.axis = glm::vec3(axisB);
        a.spread = b.spread;
        return;
    }
    const double joined = 0.5 * (a.spread + between + b.spread) + kSlack;
    const glm::dvec3 across = axisB - glm::dot(axisA, axisB) * axisA;
    const double length = glm::length(across);
    if (joined >= kPiD || length < 1e-9) {
        a.spread = length < 1e-9 && between < 1.0 ? std::max(a.spread, b.spread) + kSlack : kPiD;
        return;
    }
    const double turn = joined - a.spread;
    a.axis = glm::vec3(glm::normalize(std::cos(turn) * axisA + std::sin(turn) * across / length));
    a.spread = joined;
}

void join(LightBounds& a, const LightBounds& b) noexcept {
    if (!(b.strength > 0.0)) return;
    if (!(a.strength > 0.0)) {
        a = b;
        return;
    }
    joinCones(a, b);
    a.box.extend(b.box);
    a.emission = std::max(a.emission, b.emission);
    a.strength += b.strength;
    a.twoSided = a.twoSided || b.twoSided;
}

/// Strength times size times the measure of directions: the surface area orientation heuristic, with the squared
/// diagonal for the area, which does not vanish for lights in a row. [ContyEstevezKulla2018]
double cost(const LightBounds& b) noexcept {
    const double o = b.spread, w = std::min(o + b.emission, kPiD);
    const double directions =
        2.0 * kPiD * (1.0 - std::cos(o)) +
        0.5 * kPiD * (2.0 * w * std::sin(o) - std::cos(o - 2.0 * w) - 2.0 * o * std::sin(o) + std::cos(o));
    const glm::dvec3 diagonal(b.box.diagonal());
    return b.strength * directions * glm::dot(diagonal, diagonal);
}

/// cos(max(0, a - b)) by the sines and cosines of a and b in [0, pi].
float cosineOfDifference(float sinA, float cosA, float sinB, float cosB) noexcept {
    return cosA >= cosB ? 1.0F : cosA * cosB + sinA * sinB;
}
float sineOfDifference(float sinA, float cosA, float sinB, float cosB) noexcept {
    return cosA >= cosB ? 0.0F : std::max(0.0F, sinA * cosB - cosA * sinB);
}
float otherOf(float x) noexcept { return std::sqrt(std::max(0.0F, 1.0F - x * x)); }

}  // namespace

MeanEmission MeanEmission::of(const LightBounds& light) noexcept {
    if (light.spread > 0.0 || light.emission < 0.49 * kPiD)
        return {1.0F, {}, {}, {}};  // no Lambert emitter: the bounds tell all
    const glm::vec3& n = light.axis;
    MeanEmission mean;
    const float square = light.twoSided ? 15.0F / 16.0F : 15.0F / 32.0F;
    mean.constant = light.twoSided ? 3.0F / 16.0F : 3.0F / 32.0F;
    if (!light.twoSided) mean.linear = 0.5F * n;
    mean.diagonal = square * n * n;
    mean.across = square * glm::vec3(n.x * n.y, n.y * n.z, n.z * n.x);
    return mean;
}

void MeanEmission::join(double strength, const MeanEmission& other, double otherStrength) noexcept {
    const double total = strength + otherStrength;
    const auto share = static_cast<float>(total > 0.0 ? otherStrength / total : 0.0), rest = 1.0F - share;
    constant = rest * constant + share * other.constant;
    linear = rest * linear + share * other.linear;
    diagonal = rest * diagonal + share * other.diagonal;
    across = rest * across + share * other.across;
}

struct LightTree::Builder {
    std::span<const LightBounds> lights;
    std::vector<std::uint32_t> order;
    LightTree& tree;

    struct Split {
        int axis = -1;
        float position = 0.0F;
        double cost = std::numeric_limits<double>::infinity();
    };

    /// The cheapest of the planes between bins along the three axes; wide boxes prefer their long side.
    [[nodiscard]] Split findSplit(std::size_t begin, std::size_t end, const Bounds& centres) const {
        Split best;
        const glm::vec3 extent = centres.diagonal();
        const float longest = std::max(extent.x, std::max(extent.y, extent.z));
        for (int axis = 0; axis < 3; ++axis) {
            if (!(extent[axis] > 0.0F)) continue;
            std::array<LightBounds, kBins> bins{};
            const float scale = static_cast<float>(kBins) / extent[axis];
            for (std::size_t i = begin; i < end; ++i) {
                const LightBounds& light = lights[order[i]];
                const auto bin = static_cast<int>((light.box.centre()[axis] - centres.lower[axis]) * scale);
                join(bins[static_cast<std::size_t>(std::clamp(bin, 0, kBins - 1))], light);
            }
            std::array<double, kBins> below{};
            LightBounds sum;
            for (std::size_t k = 0; k + 1 < kBins; ++k) {
                join(sum, bins[k]);
                below[k] = sum.strength > 0.0 ? cost(sum) : std::numeric_limits<double>::infinity();
            }
            sum = LightBounds{};
            for (std::size_t k = kBins - 1; k > 0; --k) {
                join(sum, bins[k]);
                if (!(sum.strength > 0.0)) continue;
                const double total = static_cast<double>(longest / extent[axis]) * (below[k - 1] + cost(sum));
                if (total < best.cost) best = {axis, centres.lower[axis] + static_cast<float>(k) / scale, total};
            }
        }
        return best;
    }

    /// Parts [begin, end) in two that are not empty, and returns where the second begins.
    [[nodiscard]] std::size_t part(std::size_t begin, std::size_t end, int depth) {
        Bounds centres;
        for (std::size_t i = begin; i < end; ++i) centres.extend(lights[order[i]].box.centre());
        const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
        if (depth < kMaxUnbalancedDepth) {
            const Split split = findSplit(begin, end, centres);
            if (split.axis >= 0) {
                const auto middle = std::partition(at(begin), at(end), [&](std::uint32_t light) {
                    return lights[light].box.centre()[split.axis] < split.position;
                });
                if (middle != at(begin) && middle != at(end)) return static_cast<std::size_t>(middle - order.begin());
            }
        }
        const glm::vec3 extent = centres.diagonal();
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
        const std::size_t middle = begin + (end - begin) / 2;
        std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
            const float x = lights[a].box.centre()[axis], y = lights[b].box.centre()[axis];
            return x != y ? x < y : a < b;
        });
        return middle;
    }

    /// Writes the subtree of [begin, end) and returns its bounds.
    LightBounds build(std::size_t begin, std::size_t end, std::uint32_t parent, int depth) {
        const auto self = static_cast<std::uint32_t>(tree.nodes_.size());
        tree.nodes_.emplace_back();
        LightBounds bounds;
        MeanEmission mean;
        std::uint32_t second = 0;
        const bool leaf = end - begin == 1;
        if (leaf) {
            second = order[begin];
            bounds = lights[second];
            mean = MeanEmission::of(bounds);
            tree.leafOf_[second] = self;
        } else {
            const std::size_t middle = part(begin, end, depth);
            bounds = build(begin, middle, self, depth + 1);
            second = static_cast<std::uint32_t>(tree.nodes_.size());
            const LightBounds other = build(middle, end, self, depth + 1);
            mean = tree.nodes_[self + 1].mean;
            mean.join(bounds.strength, tree.nodes_[second].mean, other.strength);
            join(bounds, other);
        }
        Node& node = tree.nodes_[self];
        node.centre = bounds.box.centre();
        node.radius = bounds.box.radius() * (1.0F + 1e-5F);
        node.axis = bounds.axis;
        node.strength = static_cast<float>(bounds.strength);
        node.cosSpread = static_cast<float>(std::cos(bounds.spread));
        node.sinSpread = static_cast<float>(std::sin(bounds.spread));
        node.cosEmission = static_cast<float>(std::cos(bounds.emission));
        node.second = second;
        node.parent = parent;
        node.leaf = leaf;
        node.twoSided = bounds.twoSided;
        node.mean = mean;
        return bounds;
    }
};

LightTree::LightTree(std::span<const LightBounds> lights) : leafOf_(lights.size()) {
    if (lights.empty()) return;
    nodes_.reserve(2 * lights.size());
    Builder builder{lights, std::vector<std::uint32_t>(lights.size()), *this};
    std::iota(builder.order.begin(), builder.order.end(), 0U);
    builder.build(0, lights.size(), 0, 0);
}

/// Strength cos(theta') cos(theta_i') / d^2 with both angles lessened by what the node's size and spread may take off
/// them. [ContyEstevezKulla2018] The distance is softened, d^2 + r^2 / 4, rather than clamped: among ten
/// thousand lights around the point the deviation of the estimate falls to between a third and three quarters.
float LightTree::importance(const Node& node, const glm::vec3& point, const glm::vec3& normal) noexcept {
    const glm::vec3 to = node.centre - point;
    const float distance2 = glm::dot(to, to), radius2 = node.radius * node.radius;
    const float softened2 = distance2 + 0.25F * radius2;
    if (distance2 <= radius2) return softened2 > 0.0F ? node.strength / softened2 : 0.0F;

    const float distance = std::sqrt(distance2);
    const glm::vec3 wi = to / distance;
    const float sinSize = node.radius / distance, cosSize = otherOf(sinSize);
    float cosAxis = -glm::dot(node.axis, wi);
    if (node.twoSided) cosAxis = std::fabs(cosAxis);
    const float sinAxis = otherOf(cosAxis);
    const float cosBeyond = cosineOfDifference(sinAxis, cosAxis, node.sinSpread, node.cosSpread);
    const float sinBeyond = sineOfDifference(sinAxis, cosAxis, node.sinSpread, node.cosSpread);
    const float cosEmitted = cosineOfDifference(sinBeyond, cosBeyond, sinSize, cosSize);
    if (cosEmitted <= node.cosEmission) return 0.0F;

    float cosReceived = 1.0F;
    if (normal != glm::vec3(0.0F)) {
        const float cosNormal = glm::dot(normal, wi);
        cosReceived = cosineOfDifference(otherOf(cosNormal), cosNormal, sinSize, cosSize);
        if (cosReceived <= 0.0F) return 0.0F;
    }
    // A leaf's bound is exact enough; the closer a large node, the less its mean over far directions says.
    const float emitted =
        node.leaf ? cosEmitted : std::min(cosEmitted, std::max(node.mean.towards(-wi), kLeastMean * sinSize));
    return node.strength * std::max(emitted, 0.01F) * cosReceived / softened2;
}

float LightTree::importance(const glm::vec3& point, const glm::vec3& normal) const noexcept {
    return empty() ? 0.0F : importance(nodes_[0], point, normal);
}

std::optional<LightTree::Choice> LightTree::choose(const glm::vec3& point, const glm::vec3& normal,
                                                   double u) const noexcept {
    if (empty()) return std::nullopt;
    std::uint32_t at = 0;
    double pmf = 1.0;
    while (!nodes_[at].leaf) {
        const auto a = static_cast<double>(importance(nodes_[at + 1], point, normal));
        const auto b = static_cast<double>(importance(nodes_[nodes_[at].second], point, normal));
        if (!(a + b > 0.0)) return std::nullopt;
        const double first = a / (a + b);
        if (u < first) {
            u /= first;
            pmf *= first;
            at = at + 1;
        } else {
            const double rest = b / (a + b);
            u = std::clamp((u - first) / rest, 0.0, kLargestBelowOne);
            pmf *= rest;
            at = nodes_[at].second;
        }
    }
    if (!(pmf > 0.0)) return std::nullopt;
    return Choice{nodes_[at].second, pmf, u};
}

double LightTree::pmf(std::uint32_t light, const glm::vec3& point, const glm::vec3& normal) const noexcept {
    double pmf = 1.0;
    for (std::uint32_t at = leafOf_[light]; at != 0 && pmf > 0.0; at = nodes_[at].parent) {
        const Node& parent = nodes_[nodes_[at].parent];
        const std::uint32_t sibling = at == nodes_[at].parent + 1 ? parent.second : nodes_[at].parent + 1;
        const auto self = static_cast<double>(importance(nodes_[at], point, normal));
        const auto other = static_cast<double>(importance(nodes_[sibling], point, normal));
        pmf = self > 0.0 ? pmf * self / (self + other) : 0.0;
    }
    return pmf;
}

}  // namespace pellucid

/// Photons in Morton order under nanoflann's kd-trees, searched by accumulating inside the result set: no list of neighbours
/// is ever made. The rejects (side, plane distance) happen inside the search.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <nanoflann.hpp>

#include <pellucid/base/parallel.h>
#include <pellucid/math/bounds.h>

namespace pellucid {

/// Interleaves the lower 21 bits of x, y, z.
[[nodiscard]] inline std::uint64_t mortonCode(std::uint64_t x, std::uint64_t y, std::uint64_t z) noexcept {
    const auto spread = [](std::uint64_t v) {
        v &= 0x1fffffU;
        v = (v | v << 32U) & 0x1f00000000ffffULL;
        v = (v | v << 16U) & 0x1f0000ff0000ffULL;
        v = (v | v << 8U) & 0x100f00f00f00f00fULL;
        v = (v | v << 4U) & 0x10c30c30c30c30c3ULL;
        return (v | v << 2U) & 0x1249249249249249ULL;
    };
    return spread(x) | spread(y) << 1U | spread(z) << 2U;
}

/// Which item stands where along the curve.
struct MortonKey {
    std::uint64_t code = 0;
    std::uint32_t index = 0;
};

/// Sorts by code; equal codes keep their order. Eleven bits at a time, lowest first; digits that are all alike cost nothing.
inline void radixSort(std::vector<MortonKey>& keys) {
    constexpr unsigned kBits = 11, kDigits = 1U << kBits;
    std::vector<MortonKey> other(keys.size());
    for (unsigned shift = 0; shift < 63; shift += kBits) {
        std::vector<std::uint32_t> start(kDigits + 1, 0);
        const auto digit = [shift](const MortonKey& k) { return (k.code >> shift) & (kDigits - 1); };
        for (const MortonKey& k : keys) ++start[digit(k) + 1];
        if (std::find(start.begin(), start.end(), keys.size()) != start.end()) continue;
        std::partial_sum(start.begin(), start.end(), start.begin());
        for (const MortonKey& k : keys) other[start[digit(k)]++] = k;
        keys.swap(other);
    }
}

/// Sorts `items` (each with a `position`) along the Morton curve of their bounds; equal codes keep their order.
template <class Item>
void sortAlongMortonCurve(std::vector<Item>& items) {
    Bounds bounds;
    for (const Item& i : items) bounds.extend(i.position);
    const glm::dvec3 size = glm::max(glm::dvec3(bounds.diagonal()), glm::dvec3(1e-30));
    std::vector<MortonKey> order(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
        const glm::dvec3 q = (glm::dvec3(items[i].position) - glm::dvec3(bounds.lower)) / size * 2097151.0;
        order[i] = {mortonCode(static_cast<std::uint64_t>(q.x), static_cast<std::uint64_t>(q.y),
                               static_cast<std::uint64_t>(q.z)),
                    static_cast<std::uint32_t>(i)};
    }
    radixSort(order);
    std::vector<Item> sorted;
    sorted.reserve(items.size());
    for (const MortonKey& k : order) sorted.push_back(items[k.index]);
    items = std::move(sorted);
}

/// Part of a result set that keeps the nearest items within a bound: a max-heap of (distance^2, index).
template <int Most>
struct NearestHeap {
    int wanted;  ///< at most `Most`
    float radius2;
    int found = 0;
    std::array<std::pair<float, std::uint32_t>, static_cast<std::size_t>(Most)> heap{};

    void init() noexcept {}
    [[nodiscard]] std::size_t size() const noexcept { return static_cast<std::size_t>(found); }
    [[nodiscard]] bool full() const noexcept { return true; }
    [[nodiscard]] float worstDist() const noexcept { return radius2; }
    /// `distance2` lies below radius2.
    void keep(float distance2, std::uint32_t index) noexcept {
        const auto begin = heap.begin();
        if (found == wanted) {
            std::pop_heap(begin, begin + found);
            --found;
        }
        heap[static_cast<std::size_t>(found++)] = {distance2, index};
        std::push_heap(begin, begin + found);
        if (found == wanted) radius2 = heap[0].first;
    }
};

/// A kd-tree over items with a `position`. With `workers` (null: one thread) many items get several trees, each over a stretch
/// of their order, that are built at the same time: for items along the Morton curve few of them come near a point. How many
/// depends on the number of items alone. Once it is built it does not need them.
///
/// nanoflann builds the trees. The search over their nodes is our own: positions stand in the order of the leaves, axis by
/// axis, so that a leaf's distances are a few vector instructions.
template <class Item>
class PointTree {
public:
    explicit PointTree(const std::vector<Item>& items, const Workers* workers = nullptr)
        : order_(items.size()), position_{padded(items.size()), padded(items.size()), padded(items.size())} {
        const std::size_t count =
            workers == nullptr ? 1 : std::clamp<std::size_t>(items.size() / kItemsPerPart, 1, kMostParts);
        for (std::size_t i = 0; i < count && !items.empty(); ++i)
            parts_.push_back(std::make_unique<Part>(items, items.size() * i / count, items.size() * (i + 1) / count));
        if (workers == nullptr)
            for (const auto& part : parts_) build(*part);
        else
            workers->forEach(parts_.size(), 1, [&](std::size_t i) { build(*parts_[i]); });
    }

    /// Runs the search of `result` (nanoflann's result-set interface: addPoint, worstDist): nearer leaves first.
    template <class ResultSet>
    void search(const glm::vec3& point, ResultSet& result) const {
        for (const auto& part : parts_) {
            const glm::vec3 away = glm::max(glm::max(part->bounds.lower - point, point - part->bounds.upper), 0.0F);
            const glm::vec3 away2 = away * away;
            const float distance2 = away2.x + away2.y + away2.z;
            if (distance2 < result.worstDist()) visit(*part, part->tree.root_node, point, distance2, away2, result);
        }
    }

    /// The numbers of the items in the order of the leaves.
    [[nodiscard]] const std::vector<std::uint32_t>& order() const noexcept { return order_; }
    [[nodiscard]] glm::vec3 position(std::size_t place) const noexcept {
        return {position_[0][place], position_[1][place], position_[2][place]};
    }
    /// From here on a search tells items by their place in that order, for who has put them so.
    void tellPlaces() { order_ = {}; }

private:
    static constexpr std::size_t kLeafSize = 16, kItemsPerPart = 1U << 15U, kMostParts = 16;
    struct Adaptor {
        const std::vector<Item>& items;
        std::size_t begin, end;
        [[nodiscard]] std::size_t kdtree_get_point_count() const { return end - begin; }
        [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
            return items[begin + i].position[static_cast<glm::length_t>(axis)];
        }
        template <class Box>
        bool kdtree_get_bbox(Box&) const {
            return false;
        }
    };
    using Tree =
        nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Adaptor>, Adaptor, 3, std::uint32_t>;
    using Node = typename Tree::Node;
    struct Part {
        Adaptor adaptor;
        std::size_t begin;
        Tree tree;
        Bounds bounds;

        Part(const std::vector<Item>& items, std::size_t first, std::size_t end)
            : adaptor{items, first, end},
              begin(first),
              tree(3, adaptor, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {}
    };

    /// A leaf is always read as a whole one.
    [[nodiscard]] static std::vector<float> padded(std::size_t count) {
        return std::vector<float>(count + kLeafSize, std::numeric_limits<float>::infinity());
    }

    void build(Part& part) {
        part.tree.buildIndex();
        for (std::size_t i = 0; i < part.tree.vAcc.size(); ++i) {
            const std::size_t place = part.begin + i, number = part.begin + part.tree.vAcc[i];
            const glm::vec3& p = part.adaptor.items[number].position;
            part.bounds.extend(p);
            order_[place] = static_cast<std::uint32_t>(number);
            for (glm::length_t axis = 0; axis < 3; ++axis) position_[static_cast<std::size_t>(axis)][place] = p[axis];
        }
        part.tree.vAcc = {};
    }

    /// `away2`: squares of the distances to the node's box along the axes, their sum `distance2`. [AryaMount1993]
    template <class ResultSet>
    void visit(const Part& part, const Node* node, const glm::vec3& point, float distance2, glm::vec3 away2,
               ResultSet& result) const {
        while (node->child1 != nullptr) {
            const auto& cut = node->node_type.sub;
            const auto axis = static_cast<glm::length_t>(cut.divfeat);
            const float fromLow = point[axis] - cut.divlow, fromHigh = point[axis] - cut.divhigh;
            const bool low = fromLow + fromHigh < 0.0F;
            visit(part, low ? node->child1 : node->child2, point, distance2, away2, result);
            const float gap = low ? fromHigh : fromLow, gap2 = gap * gap;
            distance2 += gap2 - away2[axis];
            if (!(distance2 <= result.worstDist())) return;
            away2[axis] = gap2;
            node = low ? node->child2 : node->child1;
        }
        readLeaf(part.begin + node->node_type.lr.left, part.begin + node->node_type.lr.right, point, result);
    }

    template <class ResultSet>
    void readLeaf(std::size_t begin, std::size_t end, const glm::vec3& point, ResultSet& result) const {
        const float *x = &position_[0][begin], *y = &position_[1][begin], *z = &position_[2][begin];
        std::array<float, kLeafSize> distance2;
        for (std::size_t i = 0; i < kLeafSize; ++i) {
            const float dx = point.x - x[i], dy = point.y - y[i], dz = point.z - z[i];
            distance2[i] = dx * dx + dy * dy + dz * dz;
        }
        for (std::size_t i = 0; begin + i < end; ++i)
            if (distance2[i] < result.worstDist())
                result.addPoint(distance2[i],
                                order_.empty() ? static_cast<std::uint32_t>(begin + i) : order_[begin + i]);
    }

    std::vector<std::unique_ptr<Part>> parts_;
    std::vector<std::uint32_t> order_;
    std::array<std::vector<float>, 3> position_;  ///< by axis, in the order of the leaves
};

}  // namespace pellucid

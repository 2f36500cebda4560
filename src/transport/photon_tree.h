/// Photons in Morton order under a nanoflann kd-tree, searched by accumulating inside the result set: no list of
/// neighbours is ever made. The rejects (side, plane distance) happen inside the search.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
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

/// Sorts `items` (each with a `position`) along the Morton curve of their bounds; equal codes keep their order.
template <class Item>
void sortAlongMortonCurve(std::vector<Item>& items) {
    Bounds bounds;
    for (const Item& i : items) bounds.extend(i.position);
    const glm::dvec3 size = glm::max(glm::dvec3(bounds.diagonal()), glm::dvec3(1e-30));
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
        const glm::dvec3 q = (glm::dvec3(items[i].position) - glm::dvec3(bounds.lower)) / size * 2097151.0;
        order[i] = {mortonCode(static_cast<std::uint64_t>(q.x), static_cast<std::uint64_t>(q.y),
                               static_cast<std::uint64_t>(q.z)),
                    static_cast<std::uint32_t>(i)};
    }
    std::sort(order.begin(), order.end());
    std::vector<Item> sorted;
    sorted.reserve(items.size());
    for (const auto& [code, index] : order) sorted.push_back(items[index]);
    items = std::move(sorted);
}

/// A position alone.
struct PointSite {
    glm::vec3 position{0.0F};
    template <class Item>
    explicit PointSite(const Item& item) : position(item.position) {}
};

/// A kd-tree over items with a `position`. The items must stay where they are.
template <class Item>
class PointTree {
public:
    explicit PointTree(const std::vector<Item>& items)
        : adaptor_{items}, tree_(3, adaptor_, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {
        if (!items.empty()) tree_.buildIndex();
    }

    /// Runs the search of `result` (nanoflann's result-set interface: addPoint, worstDist, full, size, init).
    template <class ResultSet>
    void search(const glm::vec3& point, ResultSet& result) const {
        if (adaptor_.items.empty()) return;
        tree_.findNeighbors(result, &point.x, nanoflann::SearchParams(0, 0.0F, false));
    }

private:
    static constexpr std::size_t kLeafSize = 16;
    struct Adaptor {
        const std::vector<Item>& items;
        [[nodiscard]] std::size_t kdtree_get_point_count() const { return items.size(); }
        [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
            return items[i].position[static_cast<glm::length_t>(axis)];
        }
        template <class Box>
        bool kdtree_get_bbox(Box&) const {
            return false;
        }
    };
    Adaptor adaptor_;
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Adaptor>, Adaptor, 3, std::uint32_t> tree_;
};

}  // namespace pellucid

#include "face_pairs.h"

#include <algorithm>

namespace pellucid {

namespace {

/// Products of sets up to the first are compared one by one; larger than the second and inseparable, they are given up.
constexpr std::size_t kFewPairs = 1024, kMostPairs = std::size_t{1} << 24U;

struct Search {
    using Set = std::vector<std::uint32_t>;
    std::span<const Bounds> boxes;
    const std::function<void(std::uint32_t, std::uint32_t)>& visit;
    bool complete = true;

    [[nodiscard]] Bounds around(const Set& set) const noexcept {
        Bounds b;
        for (const std::uint32_t i : set) b.extend(boxes[i]);
        return b;
    }

    [[nodiscard]] Set within(const Set& set, int axis, float low, float high) const {
        Set kept;
        for (const std::uint32_t i : set)
            if (boxes[i].lower[axis] <= high && boxes[i].upper[axis] >= low) kept.push_back(i);
        return kept;
    }

    /// `cell` is half open; a pair is visited in the cell that holds the lower corner of what both boxes cover.
    void compare(const Set& first, const Set& second, const Bounds& cell) {
        if (first.size() * second.size() > kMostPairs) {
            complete = false;
            return;
        }
        for (const std::uint32_t i : first)
            for (const std::uint32_t j : second) {
                if (i == j || !overlap(boxes[i], boxes[j])) continue;
                const glm::vec3 corner = glm::max(boxes[i].lower, boxes[j].lower);
                if (glm::all(glm::greaterThanEqual(corner, cell.lower)) && glm::all(glm::lessThan(corner, cell.upper)))
                    visit(i, j);
            }
    }

    void run(const Set& first, const Set& second, const Bounds& cell) {
        if (first.empty() || second.empty()) return;
        if (first.size() * second.size() <= kFewPairs) return compare(first, second, cell);
        const Bounds a = around(first), b = around(second);
        const glm::vec3 low = glm::max(glm::max(a.lower, b.lower), cell.lower),
                        high = glm::min(glm::min(a.upper, b.upper), cell.upper), size = high - low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const float middle = 0.5F * (low[axis] + high[axis]);
        const Set a1 = within(first, axis, low[axis], middle), a2 = within(first, axis, middle, high[axis]),
                  b1 = within(second, axis, low[axis], middle), b2 = within(second, axis, middle, high[axis]);
        const std::size_t before = first.size() + second.size(), after = a1.size() + a2.size() + b1.size() + b2.size();
        const bool halves = middle > low[axis] && middle < high[axis] && 4 * after <= 5 * before;
        if (!halves) return compare(first, second, cell);
        Bounds below = cell, above = cell;
        below.upper[axis] = above.lower[axis] = middle;
        run(a1, b1, below);
        run(a2, b2, above);
    }
};

}  // namespace

bool forOverlappingPairs(std::span<const Bounds> boxes, const std::vector<std::uint32_t>& first,
                         const std::vector<std::uint32_t>& second,
                         const std::function<void(std::uint32_t, std::uint32_t)>& visit) {
    Search search{boxes, visit};
    Bounds everywhere;
    std::swap(everywhere.lower, everywhere.upper);
    search.run(first, second, everywhere);
    return search.complete;
}

}  // namespace pellucid

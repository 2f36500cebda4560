/// Overlapping boxes found by halving against every pair looked at; and faces in one place against all that a scene has.
#include <cstdint>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "../../src/scene/face_pairs.h"

namespace pellucid {
namespace {

using Pairs = std::multiset<std::pair<std::uint32_t, std::uint32_t>>;

[[nodiscard]] std::vector<Bounds> randomBoxes(std::size_t count, float size, unsigned seed) {
    std::mt19937 numbers(seed);
    std::uniform_real_distribution<float> place(-1.0F, 1.0F), extent(0.0F, size);
    std::vector<Bounds> boxes(count);
    for (Bounds& b : boxes) {
        const glm::vec3 low(place(numbers), place(numbers), place(numbers));
        b.extend(low);
        // Many are flat, some stand on one plane or share corners: what halving must not count twice.
        b.extend(low + glm::vec3(extent(numbers), numbers() % 3 == 0 ? 0.0F : extent(numbers), extent(numbers)));
        if (numbers() % 4 == 0) b.lower.y = b.upper.y = 0.25F;
        if (numbers() % 8 == 0) b.lower = b.upper = glm::vec3(0.5F);
    }
    return boxes;
}

void expectAllPairsOnce(const std::vector<Bounds>& boxes, std::size_t firsts) {
    std::vector<std::uint32_t> first(firsts), all(boxes.size());
    std::iota(first.begin(), first.end(), 0U);
    std::iota(all.begin(), all.end(), 0U);
    Pairs expected, found;
    for (const std::uint32_t i : first)
        for (const std::uint32_t j : all)
            if (i != j && overlap(boxes[i], boxes[j])) expected.emplace(i, j);
    EXPECT_TRUE(forOverlappingPairs(boxes, first, all, [&](std::uint32_t i, std::uint32_t j) { found.emplace(i, j); }));
    EXPECT_EQ(found, expected);
    EXPECT_FALSE(expected.empty());
}

TEST(FacePairs, FindsWhatComparingAllFinds) {
    expectAllPairsOnce(randomBoxes(60, 0.5F, 1), 20);
    expectAllPairsOnce(randomBoxes(3000, 0.05F, 2), 500);
    expectAllPairsOnce(randomBoxes(3000, 0.2F, 3), 3000);
    expectAllPairsOnce(randomBoxes(800, 3.0F, 4), 700);
}

TEST(FacePairs, GivesUpOnTooManyInOnePlaceAndSaysSo) {
    const std::vector<Bounds> boxes(20'000, Bounds{glm::vec3(0.0F), glm::vec3(1.0F)});
    std::vector<std::uint32_t> all(boxes.size());
    std::iota(all.begin(), all.end(), 0U);
    EXPECT_FALSE(forOverlappingPairs(boxes, all, all, [](std::uint32_t, std::uint32_t) {}));
}

}  // namespace
}  // namespace pellucid

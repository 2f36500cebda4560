/// The sizes of the cache's generations: every source of its bias lessens from one to the next, and what was set by name stays.
#include <gtest/gtest.h>

#include <pellucid/render/plan.h>

namespace pellucid {
namespace {

TEST(Generations, EverySourceOfBiasLessens) {
    Plan plan;
    plan.globalPaths = 1000;
    for (std::uint32_t g = 0; g < 3; ++g) {
        const GenerationSize now = plan.generation(g), next = plan.generation(g + 1);
        EXPECT_GT(next.globalPaths, now.globalPaths);
        EXPECT_LT(next.cacheError, now.cacheError);
        EXPECT_LT(next.minSpacing, now.minSpacing) << "else corners keep the bias of the first one";
        EXPECT_GE(next.gatherRays, now.gatherRays);
    }
    EXPECT_LT(plan.generation(8).minSpacing, 0.5F) << "less than a pixel";
    EXPECT_GT(plan.generation(1'000).minSpacing, 0.0F);
    EXPECT_LE(plan.generation(1'000).gatherRays, 512);
}

TEST(Generations, WhatWasSetByNameStays) {
    Plan plan;
    plan.globalPaths = 1000;
    plan.growPhotons = plan.growRays = plan.shrinkSpacing = false;
    const GenerationSize first = plan.generation(0), late = plan.generation(6);
    EXPECT_EQ(late.globalPaths, first.globalPaths);
    EXPECT_EQ(late.gatherRays, first.gatherRays);
    EXPECT_EQ(late.minSpacing, first.minSpacing);
    EXPECT_LT(late.cacheError, first.cacheError);
}

}  // namespace
}  // namespace pellucid

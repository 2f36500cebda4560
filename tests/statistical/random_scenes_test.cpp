/// A few scenes drawn at random; tests/slow has more of them.
#include "lottery.h"

namespace pellucid {
namespace {

class RandomScenes : public ::testing::TestWithParam<int> {};

TEST_P(RandomScenes, EveryMethodHasTheSameLight) { testing::expectOneLight(GetParam(), 1); }
TEST_P(RandomScenes, FurnacesAreEven) { testing::expectEvenFurnace(GetParam(), 1); }

INSTANTIATE_TEST_SUITE_P(Few, RandomScenes, ::testing::Range(0, 2));

}  // namespace
}  // namespace pellucid

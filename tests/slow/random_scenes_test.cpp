/// Scenes drawn at random, more of them than the default tests have.
#include "../statistical/lottery.h"

namespace pellucid {
namespace {

class RandomScenes : public ::testing::TestWithParam<int> {};

TEST_P(RandomScenes, EveryMethodHasTheSameLight) { testing::expectOneLight(GetParam(), 2); }
TEST_P(RandomScenes, FurnacesAreEven) { testing::expectEvenFurnace(GetParam(), 2); }

INSTANTIATE_TEST_SUITE_P(Many, RandomScenes, ::testing::Range(2, 14));

}  // namespace
}  // namespace pellucid

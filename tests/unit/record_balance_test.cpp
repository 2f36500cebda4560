/// Rays parted between records and eye: against a search of the best share.
#include "../../src/render/record_balance.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace pellucid {
namespace {

/// Of the image, when the records have been made again with so many times as many rays.
double noise2(const RecordBalance& b, double factor) {
    const double made = factor * b.recordRays, eyes = b.eyeRays + b.raysLeft - (factor > 1.0 ? made : 0.0);
    return b.recordNoise2 / factor + b.eyeNoise2 * b.eyeRays / eyes;
}

TEST(RecordBalance, FindsTheLeastNoise) {
    for (const double eyeNoise2 : {1e-4, 1e-3, 4e-3})
        for (const double left : {5e5, 2e6, 1e7}) {
            const RecordBalance b{0.01, eyeNoise2, 1e5, 2e5, left};
            const double found = std::max(1.0, raysOfBetterRecords(b) / b.recordRays);
            double least = noise2(b, 1.0);
            for (double f = 1.0; f <= std::min(8.0, left / b.recordRays); f *= 1.01)
                least = std::min(least, noise2(b, f));
            if (found > 1.0) {
                EXPECT_LT(noise2(b, found), 1.001 * least) << eyeNoise2 << ", " << left;
            } else {
                EXPECT_GT(least, 0.84 * noise2(b, 1.0)) << eyeNoise2 << ", " << left;
            }
        }
}

TEST(RecordBalance, LeavesRecordsThatAreGoodEnough) {
    EXPECT_EQ(raysOfBetterRecords({1e-5, 1e-3, 1e5, 2e5, 1e6}), 0.0) << "the eye's noise is nearly all";
    EXPECT_EQ(raysOfBetterRecords({0.01, 1e-3, 1e5, 2e5, 5e4}), 0.0) << "no time for it";
    EXPECT_EQ(raysOfBetterRecords({0.0, 1e-3, 1e5, 2e5, 1e6}), 0.0) << "no noise is known";
    EXPECT_EQ(raysOfBetterRecords({0.01, 1.0, 0.0, 0.0, 0.0}), 0.0) << "nothing is known";
}

TEST(RecordBalance, NeverAsksForMoreThanIsLeft) {
    for (const double left : {1.5e5, 3e5, 1e6, 1e8}) {
        const double rays = raysOfBetterRecords({1.0, 1e-6, 1e5, 2e5, left});
        EXPECT_LE(rays, std::min(left, 8e5));
    }
}

}  // namespace
}  // namespace pellucid

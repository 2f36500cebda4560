/// base/parallel: ranges cover what they must, exactly N threads work, exceptions come back, nesting ends.
#include <pellucid/base/error.h>
#include <pellucid/base/parallel.h>

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <limits>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace pellucid {
namespace {

/// Half of the smallest normal number, computed where the compiler cannot fold it.
float halfOfSmallestNormal() {
    volatile float smallest = std::numeric_limits<float>::min();
    return smallest * 0.5F;
}

class WorkersTest : public testing::TestWithParam<int> {
protected:
    const Workers workers{GetParam()};
};

TEST_P(WorkersTest, ReportsItsThreads) { EXPECT_EQ(workers.threads(), GetParam()); }

TEST_P(WorkersTest, RangesCoverEveryIndexOnceAndBeginAtMultiplesOfGrain) {
    for (const std::size_t count : {0U, 1U, 7U, 64U, 1000U}) {
        for (const std::size_t grain : {1U, 7U, 64U, 5000U}) {
            std::vector<int> visits(count, 0);
            std::atomic<bool> wellFormed{true};
            workers.forRanges(count, grain, [&](std::size_t begin, std::size_t end) {
                if (begin % grain != 0 || begin >= end || end - begin > grain || end > count) wellFormed = false;
                for (std::size_t i = begin; i < end; ++i) ++visits[i];
            });
            EXPECT_TRUE(wellFormed) << count << " by " << grain;
            EXPECT_EQ(visits, std::vector<int>(count, 1)) << count << " by " << grain;
        }
    }
}

TEST_P(WorkersTest, ForEachWritesTheSameWhateverTheThreads) {
    constexpr std::size_t kCount = 10007;
    std::vector<std::uint64_t> squares(kCount);
    workers.forEach(kCount, 16, [&](std::size_t i) { squares[i] = i * i; });
    for (std::size_t i = 0; i < kCount; ++i) ASSERT_EQ(squares[i], i * i);
}

/// As many bodies as threads wait for each other: only N threads at once can end this, the caller among them.
TEST_P(WorkersTest, ExactlyThatManyThreadsWorkTheCallerAmongThem) {
    const int threads = GetParam();
    std::mutex mutex;
    std::condition_variable allThere;
    std::set<std::thread::id> ids;
    std::atomic<int> inside{0};
    std::atomic<int> most{0};
    workers.forRanges(static_cast<std::size_t>(threads) * 4, 1, [&](std::size_t, std::size_t) {
        const int now = ++inside;
        for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
        }
        {
            std::unique_lock lock(mutex);
            ids.insert(std::this_thread::get_id());
            allThere.notify_all();
            allThere.wait_for(lock, std::chrono::seconds(20),
                              [&] { return ids.size() == static_cast<std::size_t>(threads); });
        }
        --inside;
    });
    EXPECT_EQ(ids.size(), static_cast<std::size_t>(threads));
    EXPECT_EQ(ids.count(std::this_thread::get_id()), 1U);
    EXPECT_LE(most, threads);
}

TEST_P(WorkersTest, RethrowsAnExceptionAndWorksAfterwards) {
    const auto failing = [&] {
        workers.forEach(1000, 1, [](std::size_t i) {
            if (i == 500) throw std::runtime_error("index 500");
        });
    };
    for (int round = 0; round < 20; ++round) {
        try {
            failing();
            FAIL() << "no exception";
        } catch (const std::runtime_error& error) {
            EXPECT_STREQ(error.what(), "index 500");
        }
    }
    std::atomic<int> visits{0};
    workers.forEach(100, 1, [&](std::size_t) { ++visits; });
    EXPECT_EQ(visits, 100);
}

TEST_P(WorkersTest, NestedCallsEndAndCoverEverything) {
    const Workers others(3);
    std::atomic<int> visits{0};
    workers.forEach(20, 1, [&](std::size_t) {
        workers.forEach(20, 1, [&](std::size_t) { others.forEach(5, 1, [&](std::size_t) { ++visits; }); });
    });
    EXPECT_EQ(visits, 20 * 20 * 5);
}

/// A body that holds a lock over a nested call must not be handed another outer body by the scheduler.
TEST_P(WorkersTest, ANestedCallUnderALockDoesNotReenter) {
    std::mutex mutex;
    int total = 0;
    workers.forEach(64, 1, [&](std::size_t) {
        const std::lock_guard lock(mutex);
        std::atomic<int> inner{0};
        workers.forEach(16, 1, [&](std::size_t) { ++inner; });
        total += inner;
    });
    EXPECT_EQ(total, 64 * 16);
}

TEST_P(WorkersTest, TakesCallsFromSeveralThreads) {
    std::vector<std::atomic<int>> visits(3);
    {
        std::vector<std::jthread> callers;
        for (auto& mine : visits) {
            callers.emplace_back([this, &mine] {
                for (int round = 0; round < 20; ++round) workers.forEach(50, 3, [&](std::size_t) { ++mine; });
            });
        }
    }
    for (const auto& mine : visits) EXPECT_EQ(mine, 1000);
}

#if defined(__x86_64__)
TEST_P(WorkersTest, FlushesDenormalsInBodiesAndRestoresTheCaller) {
    ASSERT_GT(halfOfSmallestNormal(), 0.0F);
    std::vector<float> results(64, 1.0F);
    workers.forEach(results.size(), 1, [&](std::size_t i) { results[i] = halfOfSmallestNormal(); });
    EXPECT_EQ(results, std::vector<float>(64, 0.0F));
    EXPECT_GT(halfOfSmallestNormal(), 0.0F);
}

TEST(FlushDenormals, HoldsOnTheCallingThread) {
    std::jthread([] {
        flushDenormalsOnThisThread();
        EXPECT_EQ(halfOfSmallestNormal(), 0.0F);
    });
    EXPECT_GT(halfOfSmallestNormal(), 0.0F);
}
#endif

INSTANTIATE_TEST_SUITE_P(Threads, WorkersTest, testing::Values(1, 2, 8));

TEST(Workers, ZeroMeansTheMachines) { EXPECT_GE(Workers(0).threads(), 1); }

TEST(Workers, RefusesAnImpossibleNumberOfThreads) {
    EXPECT_THROW(Workers(-1), Error);
    EXPECT_THROW(Workers(1 << 20), Error);
}

TEST(Workers, ASmallPoolDoesNotHoldBackALargeOne) {
    const Workers small(1);
    const Workers large(6);
    std::mutex mutex;
    std::condition_variable allThere;
    std::set<std::thread::id> ids;
    large.forRanges(24, 1, [&](std::size_t, std::size_t) {
        std::unique_lock lock(mutex);
        ids.insert(std::this_thread::get_id());
        allThere.notify_all();
        allThere.wait_for(lock, std::chrono::seconds(20), [&] { return ids.size() == 6; });
    });
    EXPECT_EQ(ids.size(), 6U);
}

}  // namespace
}  // namespace pellucid

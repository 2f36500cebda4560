/// Workers over one of two schedulers: a TBB arena, or plain std::jthreads under PELLUCID_STD_THREADS (for
/// ThreadSanitizer, which cannot see into Debian's TBB). Both cut [0, count) into the same ranges, so a body cannot
/// tell them apart. Around each range stands FloatingPointMode: denormals flushed inside, the thread as it was after.
#include <pellucid/base/parallel.h>

#include <pellucid/base/error.h>

#include <algorithm>
#include <string>
#include <thread>

#ifdef PELLUCID_STD_THREADS
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <vector>
#else
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <mutex>
#include <set>
#endif

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace pellucid {
namespace {

constexpr int kMostThreads = 1024;

#if defined(__x86_64__)
constexpr unsigned kFlushDenormals = 0x8040U;  // MXCSR: flush-to-zero (bit 15), denormals-are-zero (bit 6)
#ifdef PELLUCID_FP_TRAPS
constexpr unsigned kInvalidMask = 0x0080U;  // MXCSR: while bit 7 is clear, invalid operations trap
#endif

/// While it lives, denormals are flushed on this thread and, under PELLUCID_FP_TRAPS, invalid operations trap. The
/// scheduler's threads are shared with other libraries, so the old mode comes back afterwards.
class FloatingPointMode {
public:
    FloatingPointMode() noexcept : saved_(_mm_getcsr()) {
#ifdef PELLUCID_FP_TRAPS
        _mm_setcsr((saved_ | kFlushDenormals) & ~kInvalidMask);
#else
        _mm_setcsr(saved_ | kFlushDenormals);
#endif
    }
    ~FloatingPointMode() { _mm_setcsr(saved_); }
    FloatingPointMode(const FloatingPointMode&) = delete;
    FloatingPointMode& operator=(const FloatingPointMode&) = delete;

private:
    unsigned saved_;
};
#else
struct FloatingPointMode {
    FloatingPointMode() noexcept {}
};
#endif

using RangeBody = std::function<void(std::size_t, std::size_t)>;

/// One call of forRanges: chunk c is [c grain, min((c + 1) grain, count)).
struct Ranges {
    std::size_t count, grain;
    const RangeBody& body;

    [[nodiscard]] std::size_t chunks() const noexcept { return count / grain + (count % grain != 0 ? 1 : 0); }

    void run(std::size_t chunk) const {
        const FloatingPointMode mode;
        const std::size_t begin = chunk * grain;
        body(begin, begin + std::min(grain, count - begin));
    }

    void runAll() const {
        for (std::size_t chunk = 0, end = chunks(); chunk < end; ++chunk) run(chunk);
    }
};

int machineThreads() noexcept {
#ifdef PELLUCID_STD_THREADS
    return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
#else
    return std::max(1, tbb::info::default_concurrency());
#endif
}

int checkedThreads(int threads) {
    if (threads < 0 || threads > kMostThreads) {
        throw Error(ErrorKind::Usage, std::to_string(threads) + " threads asked for", "--threads",
                    "give 0 (all of the machine's) to " + std::to_string(kMostThreads));
    }
    return threads == 0 ? machineThreads() : threads;
}

}  // namespace

#ifdef PELLUCID_STD_THREADS

/// threads - 1 jthreads that sleep until a job stands. One job runs at a time; a call from inside a body runs on the
/// calling thread alone, because the others may all be waiting for that very body.
struct Workers::Impl {
    explicit Impl(int threads) {
        helpers_.reserve(static_cast<std::size_t>(threads) - 1);
        for (int i = 1; i < threads; ++i) helpers_.emplace_back([this](const std::stop_token& stop) { help(stop); });
    }

    void run(const Ranges& ranges) {
        if (insideBody_) return ranges.runAll();
        const std::lock_guard oneCaller(callers_);
        Job job{ranges, ranges.chunks(), {}, {}, {}};
        {
            const std::lock_guard lock(mutex_);
            current_ = &job;
            ++jobNumber_;
            busy_ = helpers_.size();
        }
        wake_.notify_all();
        work(job);
        std::unique_lock lock(mutex_);
        finished_.wait(lock, [this] { return busy_ == 0; });
        current_ = nullptr;
        if (job.failure) std::rethrow_exception(job.failure);
    }

private:
    struct Job {
        const Ranges& ranges;
        std::size_t chunks;
        std::atomic<std::size_t> next;
        std::atomic<bool> failed;
        std::exception_ptr failure;
    };

    void work(Job& job) {
        insideBody_ = true;
        try {
            for (std::size_t chunk = job.next++; chunk < job.chunks && !job.failed; chunk = job.next++) {
                job.ranges.run(chunk);
            }
        } catch (...) {
            if (!job.failed.exchange(true)) job.failure = std::current_exception();
        }
        insideBody_ = false;
    }

    void help(const std::stop_token& stop) {
        std::uint64_t done = 0;
        std::unique_lock lock(mutex_);
        while (wake_.wait(lock, stop, [&] { return jobNumber_ != done; })) {
            done = jobNumber_;
            Job& job = *current_;
            lock.unlock();
            work(job);
            lock.lock();
            if (--busy_ == 0) finished_.notify_one();
        }
    }

    static thread_local bool insideBody_;

    std::mutex callers_;  ///< held by the one thread whose job runs
    std::mutex mutex_;    ///< guards current_, jobNumber_ and busy_
    std::condition_variable_any wake_;
    std::condition_variable finished_;
    Job* current_ = nullptr;
    std::uint64_t jobNumber_ = 0;
    std::size_t busy_ = 0;
    std::vector<std::jthread> helpers_;  ///< last: joined before what they use is gone
};

thread_local bool Workers::Impl::insideBody_ = false;

#else

namespace {

/// TBB never runs more threads than the process-wide limit, by default the number of cores. While Workers live, the
/// limit is the most that any of them asks for (of several tbb::global_controls the smallest would hold, so there is
/// one, replaced as Workers come and go).
class ProcessLimit {
public:
    explicit ProcessLimit(int threads) {
        const std::lock_guard lock(shared().mutex);
        mine_ = shared().asked.insert(threads);
        apply();
    }
    ~ProcessLimit() {
        const std::lock_guard lock(shared().mutex);
        shared().asked.erase(mine_);
        apply();
    }
    ProcessLimit(const ProcessLimit&) = delete;
    ProcessLimit& operator=(const ProcessLimit&) = delete;

private:
    struct Shared {
        std::mutex mutex;
        std::multiset<int> asked;
        std::unique_ptr<tbb::global_control> control;
    };
    static Shared& shared() {
        static Shared instance;
        return instance;
    }
    static void apply() {
        Shared& s = shared();
        s.control.reset();
        if (s.asked.empty()) return;
        const int limit = std::max(*s.asked.rbegin(), machineThreads());
        s.control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                          static_cast<std::size_t>(limit));
    }
    std::multiset<int>::iterator mine_;
};

}  // namespace

/// An arena with one slot for the caller and threads - 1 for TBB's workers.
struct Workers::Impl {
    explicit Impl(int threads) : limit_(threads), arena_(threads) {}

    void run(const Ranges& ranges) {
        // Isolation: a thread that waits for a nested call takes no outer range meanwhile, whose body might need a
        // lock or a thread-local that the waiting body holds.
        const auto chunk = [&ranges](const tbb::blocked_range<std::size_t>& part) {
            for (std::size_t c = part.begin(); c != part.end(); ++c) ranges.run(c);
        };
        const auto loop = [&] {
            tbb::parallel_for(tbb::blocked_range<std::size_t>(0, ranges.chunks()), chunk, tbb::simple_partitioner());
        };
        arena_.execute([&] { tbb::this_task_arena::isolate(loop); });
    }

private:
    ProcessLimit limit_;
    tbb::task_arena arena_;
};

#endif

Workers::Workers(int threads) : threads_(checkedThreads(threads)), impl_(std::make_unique<Impl>(threads_)) {}

Workers::~Workers() = default;

void Workers::forRanges(std::size_t count, std::size_t grain, const RangeBody& body) const {
    if (count == 0) return;
    const Ranges ranges{count, std::max<std::size_t>(grain, 1), body};
    if (threads_ == 1 || ranges.chunks() == 1) {
        ranges.runAll();
    } else {
        impl_->run(ranges);
    }
}

void flushDenormalsOnThisThread() noexcept {
#if defined(__x86_64__)
    _mm_setcsr(_mm_getcsr() | kFlushDenormals);
#endif
}

}  // namespace pellucid

#include "process.h"

#include <atomic>
#include <csignal>

#include <sys/resource.h>
#include <unistd.h>

namespace pellucid {
namespace {

// A signal handler can reach nothing but static storage.
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not take a lock");

constexpr int kInterruptedStatus = 130;

extern "C" void leave(int) { _exit(kInterruptedStatus); }

extern "C" void onInterrupt(int) {
    if (interrupted.exchange(true, std::memory_order_relaxed)) leave(0);  // the second time: at once
}

void handleInterrupts(void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

void exitOnInterrupts() { handleInterrupts(leave); }

void failOnFullFiles() { std::signal(SIGXFSZ, SIG_IGN); }

void catchInterrupts() { handleInterrupts(onInterrupt); }

bool interruptAsked() noexcept { return interrupted.load(std::memory_order_relaxed); }

std::uint64_t peakRssBytes() noexcept {
    rusage usage{};
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024U;  // Linux counts in KiB
}

}  // namespace pellucid

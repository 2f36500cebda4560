#include "process.h"

#include <atomic>
#include <csignal>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>

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

/// Field 22 of /proc/self/stat: ticks after the machine was started. [proc(5)]
double processAge() {
    constexpr double kLongestStart = 1.0;  // an older process has been something else before, or another clock counts
    constexpr int kFieldsBetween = 19;     // after the name in parentheses, which may hold anything
    std::ifstream file("/proc/self/stat");
    std::string text;
    std::getline(file, text);
    const std::size_t name = text.rfind(')');
    if (name == std::string::npos) return 0.0;
    std::istringstream fields(text.substr(name + 1));
    std::string skipped;
    for (int i = 0; i < kFieldsBetween; ++i) fields >> skipped;
    double ticks = 0.0;
    timespec now{};
    if (!(fields >> ticks) || clock_gettime(CLOCK_BOOTTIME, &now) != 0) return 0.0;
    const double seconds = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    const double age = seconds - ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
    return age > 0.0 && age < kLongestStart ? age : 0.0;
}

std::uint64_t peakRssBytes() noexcept {
    rusage usage{};
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024U;  // Linux counts in KiB
}

}  // namespace pellucid

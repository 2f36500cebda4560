#include "peak_memory.h"

#include <cstdio>
#include <memory>

namespace pellucid {
namespace {

struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

}  // namespace

void resetPeakMemory() noexcept {
    if (const File file{std::fopen("/proc/self/clear_refs", "w")}) std::fputs("5", file.get());  // see proc(5)
}

std::uint64_t peakMemoryBytes() noexcept {
    const File file{std::fopen("/proc/self/status", "r")};
    if (!file) return 0;
    char line[256];
    unsigned long long kibibytes = 0;
    while (std::fgets(line, sizeof line, file.get()) != nullptr)
        if (std::sscanf(line, "VmHWM: %llu", &kibibytes) == 1) return kibibytes * 1024U;
    return 0;
}

}  // namespace pellucid

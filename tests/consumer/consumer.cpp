/// Uses a header-only piece and a compiled one, through the installed headers and the installed library.
#include <pellucid/base/error.h>
#include <pellucid/base/parallel.h>

#include <atomic>
#include <cstdio>

int main() {
    const pellucid::Workers workers(2);
    std::atomic<int> sum{0};
    workers.forEach(101, 8, [&](std::size_t i) { sum += static_cast<int>(i); });
    if (sum != 5050) return 1;
    try {
        const pellucid::Workers impossible(-1);
    } catch (const pellucid::Error& error) {
        std::printf("%s\n", error.what());
        return 0;
    }
    return 2;
}

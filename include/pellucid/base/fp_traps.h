/// Floating-point traps for the dev build. Under PELLUCID_FP_TRAPS an invalid operation (the birth of a NaN) inside a
/// Workers body ends the program at the instruction that made it. Libraries that compute with infinities on purpose,
/// Embree above all, are called under a TrapsMasked guard. Without the option the guard is empty and costs nothing.
#pragma once

#if defined(PELLUCID_FP_TRAPS) && defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace pellucid {

#if defined(PELLUCID_FP_TRAPS) && defined(__x86_64__)
/// While it lives, no operation traps on this thread; the exceptions raised meanwhile are forgotten at its end.
class TrapsMasked {
public:
    TrapsMasked() noexcept : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | kAllMasks); }
    ~TrapsMasked() { _mm_setcsr(saved_); }
    TrapsMasked(const TrapsMasked&) = delete;
    TrapsMasked& operator=(const TrapsMasked&) = delete;

private:
    static constexpr unsigned kAllMasks = 0x1F80U;  // MXCSR bits 7 to 12
    unsigned saved_;
};
#else
struct TrapsMasked {
    TrapsMasked() noexcept {}
    ~TrapsMasked() {}  // user-provided, so that an unused guard is no unused variable
    TrapsMasked(const TrapsMasked&) = delete;
    TrapsMasked& operator=(const TrapsMasked&) = delete;
};
#endif

}  // namespace pellucid

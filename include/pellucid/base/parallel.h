/// Workers: a fixed number of threads that run index ranges. The only room that sees TBB. Results must not depend on
/// the number of threads: a body writes only to places that its indices own. Denormals are flushed on every thread.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace pellucid {

class Workers {
public:
    /// 0 threads: as many as the machine has.
    explicit Workers(int threads = 0);
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    [[nodiscard]] int threads() const noexcept { return threads_; }

    /// Calls body(begin, end) on disjoint ranges that cover [0, count); a range is at most `grain` long (grain >= 1)
    /// and begins at a multiple of it. The first exception thrown by a body is rethrown here.
    void forRanges(std::size_t count, std::size_t grain,
                   const std::function<void(std::size_t, std::size_t)>& body) const;

    /// Calls body(i) for every i in [0, count).
    template <class Body>
    void forEach(std::size_t count, std::size_t grain, Body&& body) const {
        forRanges(count, grain, [&body](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) body(i);
        });
    }

private:
    struct Impl;
    int threads_;
    std::unique_ptr<Impl> impl_;
};

/// Sets flush-to-zero and denormals-are-zero on the calling thread (x86; elsewhere does nothing).
void flushDenormalsOnThisThread() noexcept;

}  // namespace pellucid

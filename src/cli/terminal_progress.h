/// Progress of a render on standard error: a bar with rate and time left on a terminal, else a plain line now and then.
#pragma once

#include <functional>

#include <pellucid/base/progress.h>

namespace pellucid {

class TerminalProgress {
public:
    explicit TerminalProgress(bool quiet);
    /// Takes the bar away.
    ~TerminalProgress();
    TerminalProgress(const TerminalProgress&) = delete;
    TerminalProgress& operator=(const TerminalProgress&) = delete;

    void report(const ProgressReport& report);
    /// Takes the bar away until the next report, so that a line can be printed.
    void clear();

private:
    void drawBar(const ProgressReport& report);
    void printLine(const ProgressReport& report);

    bool quiet_, terminal_, drawn_ = false;
    double nextSeconds_;  ///< of the render's clock: when to print again
    double interval_;
};

}  // namespace pellucid

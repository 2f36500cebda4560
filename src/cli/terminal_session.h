/// What a command that renders shows and hears while it runs: a progress bar, messages that do not tear it, and the wish to stop.
#pragma once

#include <string_view>

#include <pellucid/base/log.h>
#include <pellucid/base/progress.h>

#include "process.h"
#include "terminal.h"
#include "terminal_progress.h"

namespace pellucid {

class TerminalSession {
public:
    /// From now on an interruption is a wish (process.h, catchInterrupts()).
    explicit TerminalSession(bool quiet) : bar_(quiet), print_(terminalLog(quiet)) { catchInterrupts(); }

    /// Both refer to the session.
    [[nodiscard]] Progress progress() {
        Progress progress;
        progress.report = [this](const ProgressReport& report) { bar_.report(report); };
        progress.interrupted = interruptAsked;
        return progress;
    }
    [[nodiscard]] LogSink log() {
        return [this](LogLevel level, std::string_view message) {
            bar_.clear();
            logTo(print_, level, message);
        };
    }
    /// Takes the bar away before a result is printed.
    void clear() { bar_.clear(); }

private:
    TerminalProgress bar_;
    LogSink print_;
};

}  // namespace pellucid

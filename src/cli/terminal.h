/// The only place that writes to the terminal beside results: warnings, errors and progress, all on standard error.
#pragma once

#include <string>

#include <pellucid/base/error.h>
#include <pellucid/base/log.h>

namespace pellucid {

/// `pellucid: error: WHAT (WHERE): MEND`, on one line whatever the texts hold.
void printError(const Error& error);

/// Warnings as `pellucid: warning: ...`, information as `pellucid: ...`; nothing when quiet.
[[nodiscard]] LogSink terminalLog(bool quiet);

/// Standard output, checked: a full disk or a closed pipe is an error, not silence.
void printResult(const std::string& text);

}  // namespace pellucid

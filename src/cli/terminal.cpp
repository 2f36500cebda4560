#include "terminal.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <pellucid/study/text_table.h>

namespace pellucid {
namespace {

void printLine(const std::string& text) {
    const std::string line = printable(text) + '\n';
    std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

void printError(const Error& error) { printLine(std::string("pellucid: error: ") + error.what()); }

LogSink terminalLog(bool quiet) {
    if (quiet) return {};
    return [](LogLevel level, std::string_view message) {
        printLine((level == LogLevel::Warning ? "pellucid: warning: " : "pellucid: ") + std::string(message));
    };
}

void printResult(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stdout);
    if (std::fflush(stdout) != 0)
        throw Error(ErrorKind::CannotFinish, std::string("cannot write: ") + std::strerror(errno), "standard output",
                    "redirect it to where there is space");
}

}  // namespace pellucid

#include "terminal_progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <unistd.h>

#include <pellucid/study/text_table.h>

namespace pellucid {
namespace {

constexpr double kRedrawSeconds = 0.1;     // of the bar
constexpr double kFirstLineSeconds = 5.0;  // of plain lines; the interval doubles up to the longest
constexpr double kLongestLineSeconds = 60.0;
constexpr int kBarWidth = 24;

[[nodiscard]] double percent(const ProgressReport& report) {
    return 100.0 * std::clamp(std::isfinite(report.fraction) ? report.fraction : 0.0, 0.0, 1.0);
}

[[nodiscard]] std::string rateText(double samplesPerSecond) {
    char text[40];
    if (!(samplesPerSecond > 0.0)) return "";
    if (samplesPerSecond >= 1e6)
        std::snprintf(text, sizeof text, ", %.2f M samples/s", samplesPerSecond * 1e-6);
    else if (samplesPerSecond >= 1e4)
        std::snprintf(text, sizeof text, ", %.0f k samples/s", samplesPerSecond * 1e-3);
    else
        std::snprintf(text, sizeof text, ", %.0f samples/s", samplesPerSecond);
    return text;
}

[[nodiscard]] std::string timesText(const ProgressReport& report) {
    const std::string left = report.secondsLeft < 0.0 ? "" : ", " + duration(report.secondsLeft) + " left";
    return duration(report.secondsElapsed) + left + rateText(report.samplesPerSecond);
}

}  // namespace

TerminalProgress::TerminalProgress(bool quiet)
    : quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      nextSeconds_(terminal_ ? 0.0 : kFirstLineSeconds),
      interval_(terminal_ ? kRedrawSeconds : kFirstLineSeconds) {}

TerminalProgress::~TerminalProgress() { clear(); }

void TerminalProgress::clear() {
    if (!drawn_) return;
    std::fputs("\r\033[K", stderr);
    drawn_ = false;
}

void TerminalProgress::report(const ProgressReport& report) {
    if (quiet_ || report.secondsElapsed < nextSeconds_) return;
    nextSeconds_ = report.secondsElapsed + interval_;
    if (terminal_) {
        drawBar(report);
        return;
    }
    printLine(report);
    interval_ = std::min(2.0 * interval_, kLongestLineSeconds);
}

void TerminalProgress::drawBar(const ProgressReport& report) {
    const int filled = static_cast<int>(std::lround(percent(report) / 100.0 * kBarWidth));
    std::string line = "\r\033[K[" + std::string(static_cast<std::size_t>(filled), '#') +
                       std::string(static_cast<std::size_t>(kBarWidth - filled), ' ') + "] ";
    char share[16];
    std::snprintf(share, sizeof share, "%3.0f %% ", percent(report));
    line += share + std::string(report.stage) + ", " + timesText(report);
    std::fputs(line.c_str(), stderr);
    drawn_ = true;
}

void TerminalProgress::printLine(const ProgressReport& report) {
    std::fprintf(stderr, "pellucid: %.0f %% %.*s, %s\n", percent(report), static_cast<int>(report.stage.size()),
                 report.stage.data(), timesText(report).c_str());
}

}  // namespace pellucid

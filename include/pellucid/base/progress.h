/// Progress and interruption: the render loop reports how far it is and asks whether to stop.
#pragma once

#include <functional>
#include <string_view>

namespace pellucid {

struct ProgressReport {
    std::string_view stage;  ///< e.g. "cache", "eye pass"
    double fraction = 0.0;   ///< of the whole job, 0..1
    double secondsElapsed = 0.0;
    double secondsLeft = -1.0;  ///< negative: not known yet
    double samplesPerSecond = 0.0;
};

struct Progress {
    std::function<void(const ProgressReport&)> report;  ///< may be empty
    std::function<bool()> interrupted;                  ///< may be empty: never interrupted

    [[nodiscard]] bool stopAsked() const { return interrupted && interrupted(); }
};

}  // namespace pellucid

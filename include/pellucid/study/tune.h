/// The tuner: which settings reach the least error in a given time in this scene. Successive halving on windows of the
/// image, then whole images of the finalists over fresh seeds; all against one reference. Every trial is kept in the
/// folder as soon as it is done, so that a tuning can be interrupted, resumed and continued with a larger budget.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <pellucid/base/log.h>
#include <pellucid/base/parallel.h>
#include <pellucid/base/progress.h>
#include <pellucid/render/settings.h>
#include <pellucid/study/compare.h>

namespace pellucid {

/// A parameter to search, and where.
struct TuneOver {
    std::string name;
    double low = 0.0, high = 0.0;    ///< of numbers
    std::vector<std::string> words;  ///< of words
};

/// "cache.error=0.05..0.5,cache.rays,photon.guiding=on|off": a name alone stands for its declared range. Throws
/// Error{Usage} with the nearest name, or what is wrong with the range.
[[nodiscard]] std::vector<TuneOver> parseOver(const std::string& text);

/// The point of the front that a user wants: the least error at a time, or the least time to an error.
struct TuneGoal {
    enum class Kind { Time, Error } kind = Kind::Time;
    double value = 0.0;
};

/// "error=0.02" or "time=30". Throws Error{Usage}.
[[nodiscard]] TuneGoal parseGoal(const std::string& text);

struct TuneRequest {
    double time = 0.0;             ///< seconds that the renders to tune for are to take
    double budget = 0.0;           ///< seconds for the tuning as a whole; not used with `iterations`
    int iterations = 0;            ///< rounds of the search; above 0 costs are counted in rays, not in seconds
    std::vector<TuneOver> over;    ///< empty: what the plan's passes use
    std::optional<TuneGoal> goal;  ///< empty: the least error at `time`
    int width = 0, height = 0;
    std::string camera;
    std::uint64_t seed = 0;
    std::filesystem::path folder, reference;  ///< no reference: one is made
    Settings settings;                        ///< what is fixed; the search starts from here
    std::string version, sceneFile, command;  ///< for the files
};

struct TuneOutcome {
    std::string text;          ///< for people
    bool interrupted = false;  ///< what was done is kept; there are files only when the finalists had begun
};

/// Writes tuned.toml, front.json and report.html into the folder.
[[nodiscard]] TuneOutcome tune(const TuneRequest& request, const SceneSource& scenes, const Workers& workers,
                               const Progress& progress = {}, const LogSink& log = {});

}  // namespace pellucid

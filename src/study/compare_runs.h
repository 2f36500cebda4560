/// The rendering part of a comparison: the list of runs, those that are not finished yet rendered one after another, and
/// the reference.
#pragma once

#include <vector>

#include <pellucid/study/compare.h>

#include "run_store.h"

namespace pellucid {

struct CompareRuns {
    std::vector<StoredRun> runs;  ///< finished ones
    std::size_t rendered = 0;     ///< of them, now
    bool interrupted = false;
    std::string sceneHash;
    int width = 0, height = 0;
};

/// Seeds outermost, then budgets, then methods: whatever drifts on the machine reaches all methods alike, and an
/// interrupted comparison is complete for its first seeds.
[[nodiscard]] CompareRuns renderRuns(const CompareRequest& request, const SceneSource& scenes, const RunStore& store,
                                     const Workers& workers, const Progress& progress, const LogSink& log);

struct CompareReference {
    Image image;
    std::string file, hash;  ///< `file` as a user finds it
    bool made = false;
    bool goodEnough = true;  ///< a made one: its error is a tenth of the best competitor's
    double noise = 0.0;      ///< relmse of the reference itself; NaN when unknown
    double seconds = 0.0;
    std::vector<std::string> blindSpots;
    std::string remark;  ///< for people; empty when there is nothing to say
};

[[nodiscard]] CompareReference loadReference(const std::filesystem::path& file);

/// Renders DIR/reference.exr with Method::Reference, each time going on from where it stood with twice the time, until its
/// own estimated error is a tenth of the smallest error of any run, or the time for it is over.
[[nodiscard]] CompareReference makeReference(const CompareRequest& request, const SceneSource& scenes,
                                             const CompareRuns& runs, const RunStore& store, const Workers& workers,
                                             const Progress& progress, const LogSink& log);

}  // namespace pellucid

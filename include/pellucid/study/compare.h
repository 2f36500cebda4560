/// Error against run time: each method, each budget of time and K seeds, rendered one after another, measured against a
/// reference, and written as files (curves.json, curves.csv, summary.json, report.html, one EXR a run). What is finished
/// is never rendered again, so a comparison can be interrupted, and grow by methods, times and seeds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <pellucid/base/log.h>
#include <pellucid/base/parallel.h>
#include <pellucid/base/progress.h>
#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>

namespace pellucid {

struct CompareMethod {
    std::string label;  ///< as typed: "photon:cache.error=0.1"; names the method in every file
    Method method = Method::Photon;
    Settings settings;  ///< the common ones, then the method's own
};

/// "path,photon:cache.error=0.1+photon.radius=2" on top of `common`. Throws Error{Usage}; equal entries are an error.
[[nodiscard]] std::vector<CompareMethod> parseMethods(const std::string& text, const Settings& common);

/// "1,2,4": seconds above 0, returned in rising order. Throws Error{Usage}.
[[nodiscard]] std::vector<double> parseTimes(const std::string& text);

struct CompareRequest {
    std::vector<CompareMethod> methods;
    std::vector<double> times;  ///< seconds, rising; loading and all preprocessing count
    int seeds = 8;
    std::uint64_t firstSeed = 0;
    int width = 0, height = 0;  ///< 0: the reference's size, or 512 wide by the camera's aspect
    std::string camera;
    std::filesystem::path folder;
    std::filesystem::path reference;  ///< empty: one is made
    double referenceTime = 0.0;       ///< longest time to make one, in seconds; 0: 100 times the longest budget
    Settings settings;                ///< of the reference that is made
    std::string version, sceneFile, environment, command;  ///< for the files
};

/// A scene is built for its settings (surface.cast_roughness belongs to it) and may be built once for several methods.
struct LoadedScene {
    const Scene& scene;
    double loadSeconds = 0.0;  ///< counts in the budget and the time of each run, as it does for `render`
};
using SceneSource = std::function<LoadedScene(const Settings&)>;

struct CompareOutcome {
    std::string table;                    ///< for people; empty when there was nothing to measure, or to measure with
    bool interrupted = false;             ///< files hold what was done
    std::size_t finished = 0, asked = 0;  ///< runs
};

[[nodiscard]] CompareOutcome compare(const CompareRequest& request, const SceneSource& scenes, const Workers& workers,
                                     const Progress& progress = {}, const LogSink& log = {});

}  // namespace pellucid

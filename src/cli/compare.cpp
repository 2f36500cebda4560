// `pellucid compare`: load the scene as often as its settings ask, render, measure, report.
#include <map>
#include <memory>
#include <string>
#include <utility>

#include <pellucid/study/compare.h>

#include "commands.h"
#include "process.h"
#include "scene_loading.h"
#include "terminal.h"
#include "terminal_progress.h"

namespace pellucid {
namespace {

constexpr int kInterrupted = 130;

/// One scene for each value of the settings that belong to a scene.
class SceneShelf {
public:
    SceneShelf(const SceneArguments& arguments, const Workers& workers, const LogSink& log)
        : arguments_(arguments), workers_(workers), log_(log) {}

    [[nodiscard]] LoadedScene scene(const Settings& settings) {
        auto found = shelf_.find(settings.castRoughness);
        if (found == shelf_.end()) {
            SceneArguments arguments = arguments_;
            arguments.settings = settings;
            const auto start = Clock::now();
            // The file's warnings are the same each time: they are told once.
            auto loaded = loadScene(arguments, true, workers_, shelf_.empty() ? log_ : LogSink{});
            const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
            found = shelf_.emplace(settings.castRoughness, Entry{std::move(loaded), seconds}).first;
        }
        return {*found->second.scene, found->second.seconds};
    }

private:
    struct Entry {
        std::unique_ptr<Scene> scene;
        double seconds;
    };
    const SceneArguments& arguments_;
    const Workers& workers_;
    const LogSink& log_;
    std::map<double, Entry> shelf_;
};

[[nodiscard]] CompareRequest requestOf(const CompareArguments& arguments) {
    CompareRequest request;
    request.methods = arguments.methods;
    request.times = arguments.times;
    request.seeds = arguments.seeds;
    request.firstSeed = arguments.common.seed;
    request.width = arguments.common.width;
    request.height = arguments.common.height;
    request.camera = arguments.common.camera;
    request.folder = arguments.folder;
    request.reference = arguments.reference;
    request.referenceTime = arguments.referenceTime;
    request.settings = arguments.common.settings;
    request.version = PELLUCID_VERSION;
    request.sceneFile = arguments.common.scene;
    request.environment = arguments.common.environment;
    request.command = arguments.command;
    return request;
}

}  // namespace

int runCompare(const CompareArguments& arguments) {
    TerminalProgress terminal(arguments.common.quiet);
    const LogSink print = terminalLog(arguments.common.quiet);
    const LogSink log = [&](LogLevel level, std::string_view message) {
        terminal.clear();
        logTo(print, level, message);
    };
    const Workers workers(arguments.common.threads);
    SceneShelf shelf(arguments.common, workers, log);
    Progress progress;
    progress.report = [&terminal](const ProgressReport& report) { terminal.report(report); };
    progress.interrupted = interruptAsked;
    catchInterrupts();
    const CompareOutcome outcome = compare(
        requestOf(arguments), [&shelf](const Settings& settings) { return shelf.scene(settings); }, workers, progress,
        log);
    terminal.clear();
    if (!arguments.common.quiet && !outcome.table.empty()) printResult(outcome.table);
    return outcome.interrupted ? kInterrupted : 0;
}

}  // namespace pellucid

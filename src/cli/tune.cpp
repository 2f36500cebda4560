// `pellucid tune`: load the scene as often as its settings ask, search, measure, write.
#include <pellucid/study/tune.h>

#include "commands.h"
#include "process.h"
#include "scene_shelf.h"
#include "terminal.h"
#include "terminal_progress.h"

namespace pellucid {
namespace {

constexpr int kInterrupted = 130;

[[nodiscard]] TuneRequest requestOf(const TuneArguments& arguments) {
    TuneRequest request;
    request.time = arguments.time;
    request.budget = arguments.budget;
    request.iterations = arguments.iterations;
    request.over = arguments.over;
    request.goal = arguments.goal;
    request.width = arguments.common.width;
    request.height = arguments.common.height;
    request.camera = arguments.common.camera;
    request.seed = arguments.common.seed;
    request.folder = arguments.folder;
    request.reference = arguments.reference;
    request.settings = arguments.common.settings;
    request.version = PELLUCID_VERSION;
    request.sceneFile = arguments.common.scene;
    request.command = arguments.command;
    return request;
}

}  // namespace

int runTune(const TuneArguments& arguments) {
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
    const TuneOutcome outcome = tune(
        requestOf(arguments), [&shelf](const Settings& settings) { return shelf.scene(settings); }, workers, progress,
        log);
    terminal.clear();
    if (!arguments.common.quiet && !outcome.text.empty()) printResult(outcome.text);
    return outcome.interrupted ? kInterrupted : 0;
}

}  // namespace pellucid

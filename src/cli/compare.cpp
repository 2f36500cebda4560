// `pellucid compare`: load the scene as often as its settings ask, render, measure, report.
#include <pellucid/study/compare.h>

#include "commands.h"
#include "scene_shelf.h"
#include "terminal.h"
#include "terminal_session.h"

namespace pellucid {
namespace {

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
    TerminalSession terminal(arguments.common.quiet);
    const LogSink log = terminal.log();
    const Workers workers(arguments.common.threads);
    SceneShelf shelf(arguments.common, workers, log);
    const CompareOutcome outcome = compare(
        requestOf(arguments), [&shelf](const Settings& settings) { return shelf.scene(settings); }, workers,
        terminal.progress(), log);
    terminal.clear();
    if (!arguments.common.quiet && !outcome.table.empty()) printResult(outcome.table);
    if (outcome.interrupted)
        logTo(log, LogLevel::Info,
              "interrupted with " + std::to_string(outcome.finished) + " of " + std::to_string(outcome.asked) +
                  " runs finished" + (outcome.table.empty() ? " and no reference yet" : "") +
                  "; the same command goes on from there");
    return outcome.interrupted ? kInterrupted : 0;
}

}  // namespace pellucid

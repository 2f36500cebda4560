// `pellucid tune`: load the scene as often as its settings ask, search, measure, write.
#include <pellucid/study/tune.h>

#include "commands.h"
#include "scene_shelf.h"
#include "terminal.h"
#include "terminal_session.h"

namespace pellucid {
namespace {

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
    TerminalSession terminal(arguments.common.quiet);
    const LogSink log = terminal.log();
    const Workers workers(arguments.common.threads);
    SceneShelf shelf(arguments.common, workers, log);
    const TuneOutcome outcome = tune(
        requestOf(arguments), [&shelf](const Settings& settings) { return shelf.scene(settings); }, workers,
        terminal.progress(), log);
    terminal.clear();
    if (!arguments.common.quiet && !outcome.text.empty()) printResult(outcome.text);
    return outcome.interrupted ? kInterrupted : 0;
}

}  // namespace pellucid

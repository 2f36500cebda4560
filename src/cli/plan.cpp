// `pellucid plan`: load, decide, print; nothing is rendered but a pilot.
#include <pellucid/study/record_json.h>

#include "commands.h"
#include "scene_loading.h"
#include "terminal.h"

namespace pellucid {

int runPlan(const PlanArguments& arguments) {
    const SceneArguments& common = arguments.common;
    const Workers workers(common.threads);
    const LogSink log = terminalLog(common.quiet);
    const auto scene = loadScene(common, true, workers, log);
    const RenderRecord plan = planOnly(*scene, makeRequest(common), workers, log);
    const Camera camera = scene->camera(common.camera, common.width, common.height);
    const RecordContext context = recordContext(common, *scene, camera.width(), camera.height());
    printResult(arguments.json ? planJson(plan, context) : planText(plan, context));
    return 0;
}

}  // namespace pellucid

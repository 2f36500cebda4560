// `pellucid info`: load, then say what there is.
#include <pellucid/study/scene_info.h>

#include "commands.h"
#include "scene_loading.h"
#include "terminal.h"

namespace pellucid {

int runInfo(const InfoArguments& arguments) {
    const Workers workers(arguments.common.threads);
    // The text holds the warnings: they are not printed twice.
    const auto scene = loadScene(arguments.common, false, workers, {});
    printResult(arguments.json ? infoJson(*scene, arguments.common.scene) : infoText(*scene, arguments.common.scene));
    return 0;
}

}  // namespace pellucid

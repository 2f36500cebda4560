#include "scene_loading.h"

#include <optional>
#include <string>
#include <utility>

#include <pellucid/io/gltf.h>
#include <pellucid/io/image_file.h>
#include <pellucid/io/views_file.h>

namespace pellucid {

std::unique_ptr<Scene> loadScene(const SceneArguments& arguments, bool requireLight, const Workers& workers,
                                 const LogSink& log, const std::string& viewsFile) {
    SceneDescription description = loadGltf(arguments.scene, log);
    if (!viewsFile.empty()) {
        constexpr double kDefaultFov = 0.8;
        const std::vector<CameraSpec>& own = description.cameras;
        const bool perspective = !own.empty() && !own.front().orthographic;
        description.cameras = loadViews(viewsFile, perspective ? own.front().verticalFov : kDefaultFov);
    }
    std::optional<EnvironmentDescription> environment;
    if (!arguments.environment.empty()) environment = loadEnvironment(arguments.environment);
    SceneOptions options;
    options.lobeRules.castRoughness = static_cast<float>(arguments.settings.castRoughness);
    options.lobeRules.glassCastRoughness = static_cast<float>(arguments.settings.glassCastRoughness);
    options.requireLight = requireLight;
    auto scene = std::make_unique<Scene>(std::move(description), std::move(environment), options, workers, log);
    if (!arguments.tunedFor.empty() && arguments.tunedFor != scene->hash())
        logTo(log, LogLevel::Warning,
              arguments.config + " was tuned for another scene, environment or roughness that casts (hash " +
                  arguments.tunedFor + ", here " + scene->hash() +
                  "): what it says of error and time need not hold here");
    return scene;
}

RenderRequest makeRequest(const SceneArguments& arguments) {
    RenderRequest request;
    request.method = arguments.method;
    request.width = arguments.width;
    request.height = arguments.height;
    request.camera = arguments.camera;
    request.seed = arguments.seed;
    request.budget = arguments.budget;
    request.settings = arguments.settings;
    return request;
}

RecordContext recordContext(const SceneArguments& arguments, const Scene& scene, int width, int height) {
    RecordContext context;
    context.version = PELLUCID_VERSION;
    context.sceneFile = arguments.scene;
    context.sceneHash = scene.hash();
    context.method = arguments.method;
    context.width = width;
    context.height = height;
    context.seed = arguments.seed;
    return context;
}

}  // namespace pellucid

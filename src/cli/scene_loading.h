/// From the arguments that all scene commands share to a Scene and a request.
#pragma once

#include <memory>
#include <string>

#include <pellucid/base/log.h>
#include <pellucid/base/parallel.h>
#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>
#include <pellucid/study/record_json.h>

#include "arguments.h"

namespace pellucid {

/// `viewsFile`: cameras in place of those of the scene; empty: the scene's own.
[[nodiscard]] std::unique_ptr<Scene> loadScene(const SceneArguments& arguments, bool requireLight,
                                               const Workers& workers, const LogSink& log,
                                               const std::string& viewsFile = {});

[[nodiscard]] RenderRequest makeRequest(const SceneArguments& arguments);

/// What a record of an image of this size says beside its figures.
[[nodiscard]] RecordContext recordContext(const SceneArguments& arguments, const Scene& scene, int width, int height);

}  // namespace pellucid

/// The scenes of a command that renders with many settings: loaded once for each value of those that belong to a scene.
#pragma once

#include <map>
#include <memory>
#include <utility>

#include <pellucid/base/log.h>
#include <pellucid/base/parallel.h>
#include <pellucid/scene/scene.h>
#include <pellucid/study/compare.h>

#include "arguments.h"

namespace pellucid {

/// Keeps references to what it is given.
class SceneShelf {
public:
    SceneShelf(const SceneArguments& arguments, const Workers& workers, const LogSink& log)
        : arguments_(arguments), workers_(workers), log_(log) {}

    [[nodiscard]] LoadedScene scene(const Settings& settings);

private:
    struct Entry {
        std::unique_ptr<Scene> scene;
        double seconds;
    };
    const SceneArguments& arguments_;
    const Workers& workers_;
    const LogSink& log_;
    std::map<std::pair<double, double>, Entry> shelf_;  ///< by surface.cast_roughness and surface.glass_cast_roughness
};

}  // namespace pellucid

#include "scene_shelf.h"

#include <chrono>
#include <utility>

#include "scene_loading.h"

namespace pellucid {

LoadedScene SceneShelf::scene(const Settings& settings) {
    const std::pair key{settings.castRoughness, settings.glassCastRoughness};
    auto found = shelf_.find(key);
    if (found == shelf_.end()) {
        SceneArguments arguments = arguments_;
        arguments.settings = settings;
        const auto start = std::chrono::steady_clock::now();
        // The file's warnings are the same each time: they are told once.
        auto loaded = loadScene(arguments, true, workers_, shelf_.empty() ? log_ : LogSink{});
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        found = shelf_.emplace(key, Entry{std::move(loaded), seconds}).first;
    }
    return {*found->second.scene, found->second.seconds};
}

}  // namespace pellucid

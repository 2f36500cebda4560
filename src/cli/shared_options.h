/// Options that mean the same for every command that has them, and what their texts come to.
#pragma once

#include <string>
#include <vector>

#include "arguments.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace pellucid {

/// Option texts as typed, until all are known: a --config is read before the first --set, wherever they stand.
struct TypedText {
    std::string size, config, layers, crop, sample, method = "photon", methods, times, over, goal;
    std::vector<std::string> set, failAbove;
};

/// An option that may come again, each time with one value.
CLI::Option* addRepeatable(CLI::App& app, const std::string& name, std::vector<std::string>& values,
                           const std::string& help);

/// The scene and what lights it.
void addSceneFile(CLI::App& app, SceneArguments& common);
/// What means the same for every command that renders, one image or many.
void addPictureOptions(CLI::App& app, SceneArguments& common, TypedText& typed);
/// The options of the commands that render one image.
void addSceneOptions(CLI::App& app, SceneArguments& common, TypedText& typed);

/// Reads what was typed into the values. Throws Error.
void resolve(SceneArguments& common, const TypedText& typed);

}  // namespace pellucid

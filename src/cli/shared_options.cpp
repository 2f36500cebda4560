#include "shared_options.h"

#include <cmath>
#include <map>
#include <tuple>

#include <CLI/CLI.hpp>

#include <pellucid/base/error.h>

#include "argument_values.h"

namespace pellucid {

namespace {

const std::map<std::string, Method> kMethods{{"photon", Method::Photon}, {"path", Method::Path},
                                             {"light", Method::Light},   {"reference", Method::Reference},
                                             {"bdpt", Method::Bdpt},     {"sppm", Method::Sppm}};

template <class Number>
CLI::Option* addBudget(CLI::App& app, const std::string& name, std::optional<Number>& limit, const std::string& help) {
    return app.add_option_function<Number>(
        name,
        [&limit, name](const Number& value) {
            if (!(value > Number{0}) || !std::isfinite(static_cast<double>(value)))
                throw Error(ErrorKind::Usage, "a budget must be above 0", name, "give a positive number");
            limit = value;
        },
        help);
}

}  // namespace

CLI::Option* addRepeatable(CLI::App& app, const std::string& name, std::vector<std::string>& values,
                           const std::string& help) {
    return app.add_option(name, values, help)->allow_extra_args(false)->take_all();
}

void addSceneFile(CLI::App& app, SceneArguments& common) {
    app.add_option("scene", common.scene, "glTF scene (.gltf or .glb)")->required()->type_name("SCENE");
    app.add_option("--env", common.environment,
                   "light from infinity: equirectangular .hdr or .exr, or a constant R,G,B")
        ->type_name("FILE|R,G,B");
    app.add_option("--threads", common.threads, "worker threads; 0: all. The image does not depend on it")
        ->check(CLI::Range(0, 1024))
        ->type_name("N");
    app.add_flag("--quiet", common.quiet, "print nothing but errors");
}

void addPictureOptions(CLI::App& app, SceneArguments& common, TypedText& typed) {
    addSceneFile(app, common);
    app.add_option("--size", typed.size, "pixels (default: 512 wide, the camera's aspect)")->type_name("WxH");
    app.add_option("--camera", common.camera, "camera of the scene (default: the first)")->type_name("NAME|INDEX");
    app.add_option("--seed", common.seed, "another seed makes other noise (default: 0)")
        ->check(CLI::NonNegativeNumber)
        ->type_name("N");
    addRepeatable(app, "--set", typed.set, "a parameter by name (see `pellucid options`); repeatable, after --config")
        ->type_name("KEY=VALUE");
    app.add_option("--config", typed.config, "parameters from a TOML file")->type_name("FILE.toml");
}

void addSceneOptions(CLI::App& app, SceneArguments& common, TypedText& typed) {
    addPictureOptions(app, common, typed);
    app.add_option("--method", typed.method,
                   "photon (default): maps, cache and gather. path: unbiased path tracing. "
                   "light: light tracing only. reference: path and light tracing by path class. "
                   "bdpt: bidirectional path tracing. sppm: stochastic progressive photon mapping")
        ->check(CLI::IsMember(kMethods))
        ->type_name("NAME");
    addBudget<double>(app, "--time", common.budget.seconds, "stop after so many seconds, loading included")
        ->type_name("S");
    addBudget<std::uint32_t>(app, "--spp", common.budget.samples, "stop after so many samples a pixel")->type_name("N");
    addBudget<double>(app, "--error", common.budget.error, "stop at this relative error (default: 0.05, with a cap)")
        ->type_name("E");
}

void resolve(SceneArguments& common, const TypedText& typed) {
    common.method = kMethods.at(typed.method);
    if (!typed.size.empty()) std::tie(common.width, common.height) = parseSize(typed.size);
    if (!typed.config.empty()) {
        loadSettings(common.settings, typed.config);
        common.config = typed.config;
        common.tunedFor = tunedSceneHash(typed.config);
    }
    for (const std::string& text : typed.set) {
        const auto [key, value] = parseAssignment("--set", text);
        setParameter(common.settings, key, value);
    }
}

}  // namespace pellucid

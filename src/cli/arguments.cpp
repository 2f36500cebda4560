#include "arguments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <tuple>

#include <CLI/CLI.hpp>

#include <pellucid/base/error.h>
#include <pellucid/base/nearest_name.h>
#include <pellucid/render/settings_page.h>

#include "argument_values.h"

namespace pellucid {
namespace {

constexpr std::array<std::string_view, 4> kImageExtensions{".exr", ".png", ".hdr", ".pfm"};
constexpr std::array<std::string_view, 1> kMapExtensions{".png"}, kPlotExtensions{".svg"};

const std::map<std::string, Method> kMethods{{"photon", Method::Photon},
                                             {"path", Method::Path},
                                             {"light", Method::Light},
                                             {"reference", Method::Reference},
                                             {"bdpt", Method::Bdpt}};

/// Option texts as typed, until all are known: a --config is read before the first --set, wherever they stand.
struct TypedText {
    std::string size, config, layers, crop, sample, method = "photon", methods, times, over, goal;
    std::vector<std::string> set, failAbove;
};

/// An option that may come again, each time with one value.
CLI::Option* addRepeatable(CLI::App& app, const std::string& name, std::vector<std::string>& values,
                           const std::string& help) {
    return app.add_option(name, values, help)->allow_extra_args(false)->take_all();
}

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

/// What means the same for every command that renders, one image or many.
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

/// The options of the commands that render one image.
void addSceneOptions(CLI::App& app, SceneArguments& common, TypedText& typed) {
    addPictureOptions(app, common, typed);
    app.add_option("--method", typed.method,
                   "photon (default): maps, cache and gather. path: unbiased path tracing. "
                   "light: light tracing only. reference: path and light tracing by path class. "
                   "bdpt: bidirectional path tracing")
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

/// Everything that CLI11 writes to, and the commands by name.
struct Parser {
    CLI::App app{
        "Renders caustic-heavy scenes by photon maps, an irradiance cache and path tracing, and measures its "
        "own error.",
        "pellucid"};
    TypedText typed;
    RenderArguments render;
    PlanArguments plan;
    InfoArguments info;
    DiffArguments diff;
    CheckArguments check;
    CompareArguments compare;
    TuneArguments tune;
    CLI::App *renderCommand, *planCommand, *infoCommand, *diffCommand, *compareCommand, *tuneCommand, *checkCommand,
        *optionsCommand;

    Parser() {
        app.require_subcommand(1);
        app.set_version_flag("--version", "pellucid " PELLUCID_VERSION);
        app.footer(
            "Exit status: 0 done; 1 wrong use; 2 bad input; 3 could not finish or write; 4 a check or gate failed; "
            "130 interrupted.\n`pellucid COMMAND --help` explains a command.");
        renderCommand = addRender();
        planCommand = addPlan();
        infoCommand = addInfo();
        diffCommand = addDiff();
        checkCommand = addCheck();
        compareCommand = addCompare();
        optionsCommand = app.add_subcommand("options", "every setting that --set and --config take");
        tuneCommand = addTune();
    }

    CLI::App* addRender() {
        CLI::App* command = app.add_subcommand("render", "render a scene into image files");
        addSceneOptions(*command, render.common, typed);
        addRepeatable(*command, "-o,--output", render.outputs, "image to write; repeatable")
            ->type_name("OUT.exr|.png|.hdr|.pfm");
        command->add_option("--exposure", render.exposure, "stops of exposure, for PNG only")->type_name("EV");
        command
            ->add_option(
                "--layers", typed.layers,
                "more layers in the EXR: albedo, normal, depth, variance, records, "
                "radius, photons, classes (each path class by itself), all (but classes) or none; emission, direct, "
                "caustic and indirect are always there")
            ->type_name("A,B,...");
        command->add_option("--record", render.record, "what was done, as JSON")->type_name("FILE.json");
        CLI::Option* checkpoint =
            command->add_option("--checkpoint", render.checkpoint, "state to go on from")->type_name("FILE");
        command->add_flag("--resume", render.resume, "go on from the checkpoint")->needs(checkpoint);
        command
            ->add_option(
                "--cache", render.cache,
                "records and global map of this scene's light: read if the file is there, and written with what "
                "this view adds. A file of another scene or of other settings is refused")
            ->excludes(checkpoint)
            ->type_name("FILE");
        command
            ->add_option(
                "--views", render.views,
                "a flythrough: an image for each camera of FILE, which has lines `eye X Y Z target X Y Z [up X Y Z] "
                "[fov DEGREES]`, or for each of the scene's own; out.exr gives out.0000.exr, ... All share one "
                "irradiance cache; the budget is that of each image")
            ->excludes(checkpoint)
            ->type_name("FILE|all");
        command
            ->add_option("--export-points", render.pointsFolder,
                         "folder for records.ply and caustic-photons.ply: point clouds for Blender or MeshLab")
            ->type_name("DIR");
        command
            ->add_option(
                "--debug-sample", typed.sample,
                "instead of rendering, take sample S (from 0) of pixel X,Y again and print its path, vertex by "
                "vertex")
            ->type_name("X,Y,S");
        command->footer(
            "Examples:\n  pellucid render scene.glb -o out.exr -o out.png --time 30\n"
            "  pellucid render scene.glb -o ref.exr --method reference --spp 4096 --checkpoint ref.state\n"
            "  pellucid render scene.glb -o out.exr --set cache.error=0.2 --layers variance,albedo\n"
            "  pellucid render scene.glb -o left.exr --camera left --cache scene.cache --time 30\n"
            "  pellucid render scene.glb -o frame.exr --views path.txt --spp 64");
        return command;
    }

    CLI::App* addPlan() {
        CLI::App* command = app.add_subcommand("plan", "what a render will do and leave out, why, and at what cost");
        addSceneOptions(*command, plan.common, typed);
        command->add_flag("--json", plan.json, "for programs");
        command->footer("Examples:\n  pellucid plan scene.glb\n  pellucid plan scene.glb --method path --json");
        return command;
    }

    CLI::App* addInfo() {
        CLI::App* command = app.add_subcommand("info", "what a scene holds");
        addSceneFile(*command, info.common);
        command->add_flag("--json", info.json, "for programs");
        command->footer("Examples:\n  pellucid info scene.glb\n  pellucid info scene.glb --json");
        return command;
    }

    CLI::App* addDiff() {
        CLI::App* command = app.add_subcommand("diff", "measure images against a reference");
        command
            ->add_option("reference", diff.reference,
                         "image to compare with; pixels where its channel mask.Y is 0 do "
                         "not count")
            ->required()
            ->type_name("REF.exr");
        command->add_option("images", diff.images, "images to measure")->required()->type_name("IMG.exr ...");
        command->add_flag("--json", diff.json, "for programs");
        command->add_option("--crop", typed.crop, "only this box; x1 and y1 lie one past the last pixel")
            ->type_name("x0,y0,x1,y1");
        command
            ->add_option("--map", diff.map,
                         "false-colour map of HDR-FLIP; OUT-1.png, OUT-2.png, ... for several images")
            ->type_name("OUT.png");
        addRepeatable(*command, "--fail-above", typed.failAbove,
                      "exit with 4 when a metric of an image is above; repeatable. "
                      "rmse, relmse, relmse_trimmed, smape, flip, bias (either sign), nonfinite")
            ->type_name("METRIC=VALUE");
        command->add_flag("--exposure-invariant", diff.exposureInvariant, "scale images to the reference's mean first");
        command->footer(
            "Examples:\n  pellucid diff ref.exr a.exr b.exr\n"
            "  pellucid diff ref.exr a.exr --crop 285,440,490,500 --map error.png\n"
            "  pellucid diff ref.exr a.exr --json --fail-above relmse=0.01 --fail-above nonfinite=0");
        return command;
    }

    CLI::App* addCompare() {
        CLI::App* command = app.add_subcommand("compare", "error against run time of several methods, with a report");
        addPictureOptions(*command, compare.common, typed);
        command->add_option("-o,--output", compare.folder, "folder for runs, figures and report.html")
            ->required()
            ->type_name("DIR");
        command
            ->add_option("--methods", typed.methods,
                         "photon, path, bdpt, light, reference, each with settings of its own after a colon")
            ->required()
            ->type_name("M[:KEY=VALUE+...],...");
        command->add_option("--times", typed.times, "budgets of each run, in seconds")
            ->required()
            ->type_name("S,S,...");
        command->add_option("--seeds", compare.seeds, "independent runs of each method and time (default: 8)")
            ->check(CLI::Range(1, 1000))
            ->type_name("K");
        command
            ->add_option("--reference", compare.reference,
                         "image to measure against (.exr, .hdr, .pfm); layers variance.* and mask.Y are used. "
                         "Without it one is made")
            ->type_name("FILE");
        command
            ->add_option("--reference-time", compare.referenceTime,
                         "longest time for making a reference (default: 100 times the longest of --times)")
            ->check(CLI::PositiveNumber)
            ->type_name("S");
        command->footer(
            "Runs that are finished in DIR are not rendered again: the same command goes on after an interruption, "
            "and\n"
            "more methods, times or seeds add to what is there.\n"
            "Examples:\n  pellucid compare scene.glb -o study --methods path,photon --times 1,2,4,8 --seeds 8\n"
            "  pellucid compare scene.glb -o study --methods photon,photon:cache.error=0.1+cache.rays=256 --times 2,8\n"
            "  pellucid compare scene.glb -o study --methods path,photon --times 4 --reference ref.exr");
        return command;
    }

    [[nodiscard]] Arguments resultOfCompare() {
        resolve(compare.common, typed);
        compare.methods = parseMethods(typed.methods, compare.common.settings);
        compare.times = parseTimes(typed.times);
        return compare;
    }

    CLI::App* addTune() {
        CLI::App* command = app.add_subcommand("tune", "find the settings that render this scene best in a given time");
        addPictureOptions(*command, tune.common, typed);
        command->add_option("-o,--output", tune.folder, "folder for tuned.toml, front.json, report.html and the trials")
            ->required()
            ->type_name("DIR");
        command->add_option("--time", tune.time, "seconds that the renders to tune for are to take")
            ->required()
            ->check(CLI::PositiveNumber)
            ->type_name("S");
        CLI::Option* budget =
            command->add_option("--budget", tune.budget, "seconds for the tuning as a whole, the reference included")
                ->check(CLI::PositiveNumber)
                ->type_name("S");
        command
            ->add_option("--iterations", tune.iterations,
                         "rounds of the search, in place of --budget: costs are then counted in rays (2 million stand "
                         "for a second), so that the same seed gives the same front anywhere")
            ->check(CLI::Range(1, 1000))
            ->excludes(budget)
            ->type_name("N");
        command
            ->add_option("--over", typed.over,
                         "what to search, and where (default: what the plan's passes use, in the declared ranges)")
            ->type_name("KEY[=LOW..HIGH],...");
        command->add_option("--for", typed.goal, "the point of the front that tuned.toml is to hold (default: --time)")
            ->type_name("error=E|time=S");
        command
            ->add_option("--reference", tune.reference,
                         "image to measure against; layers variance.* and mask.Y are used. Without it one is made")
            ->type_name("FILE");
        command->footer(
            "The same command goes on after an interruption, and with a larger --budget; another --for picks from what "
            "is\n"
            "measured already.\n"
            "Examples:\n  pellucid tune scene.glb -o tuning --time 10 --budget 600\n"
            "  pellucid tune scene.glb -o tuning --time 10 --budget 600 --over cache.error=0.05..0.5,cache.rays\n"
            "  pellucid tune scene.glb -o tuning --time 10 --budget 600 --for error=0.02\n"
            "  pellucid render scene.glb --config tuning/tuned.toml --time 10 -o out.exr");
        return command;
    }

    [[nodiscard]] Arguments resultOfTune() {
        resolve(tune.common, typed);
        if (tune.budget == 0.0 && tune.iterations == 0)
            throw Error(ErrorKind::Usage, "how long to tune is missing", "tune", "give --budget S, or --iterations N");
        if (!typed.over.empty()) tune.over = parseOver(typed.over);
        if (!typed.goal.empty()) tune.goal = parseGoal(typed.goal);
        return tune;
    }

    CLI::App* addCheck() {
        CLI::App* command = app.add_subcommand("check", "the numerical suite: closed forms, extremes, invariants");
        command->add_option("--filter", check.filter, "only cases with this in their name")->type_name("NAME");
        CLI::Option* json = command->add_flag("--json", check.json, "for programs");
        CLI::Option* markdown =
            command->add_flag("--markdown", check.markdown, "the page docs/validation.md")->excludes(json);
        CLI::Option* quick = command->add_flag("--quick", check.quick, "leave out the slow cases");
        command
            ->add_flag("--sweeps", check.sweeps,
                       "instead of the cases, the sweeps of stiffness: error and time over decades of a dial")
            ->excludes(quick);
        command->add_flag("--list", check.list, "the names of the cases and what each guards; nothing is run")
            ->excludes(json)
            ->excludes(markdown);
        command->add_option("--plot", check.plot, "draw the sweeps of --sweeps or --markdown")->type_name("OUT.svg");
        command->add_option("--threads", check.threads, "worker threads; 0: all. No figure depends on it")
            ->check(CLI::Range(0, 1024))
            ->type_name("N");
        command->add_option("--seed", check.seed, "another seed makes other noise (default: 0)")
            ->check(CLI::NonNegativeNumber)
            ->type_name("N");
        command->add_flag("--quiet", check.quiet, "print nothing but the report and errors");
        command->footer(
            "Examples:\n  pellucid check --quick\n  pellucid check --filter closed-form --json\n"
            "  pellucid check --sweeps --filter 'lamp size' --plot sweeps.svg");
        return command;
    }

    [[nodiscard]] std::string nameOfUsed() const {
        const std::vector<CLI::App*> used = app.get_subcommands();
        return used.empty() ? "" : used.front()->get_name();
    }

    /// CLI11 would only say that a command is missing.
    void requireKnownCommand(const std::string& word) const {
        if (word.starts_with('-')) return;
        std::vector<std::string> names;
        for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
        if (std::ranges::find(names, word) != names.end()) return;
        const std::vector<std::string_view> candidates(names.begin(), names.end());
        throw Error(ErrorKind::Usage, "there is no command '" + word + "'", "command line",
                    "the nearest name is '" + std::string(nearestName(word, candidates)) + "'; see `pellucid --help`");
    }

    [[nodiscard]] Arguments result() {
        if (renderCommand->parsed()) {
            if (!typed.sample.empty()) render.debugSample = parseSample(typed.sample);
            if (render.outputs.empty() && !render.debugSample)
                throw Error(ErrorKind::Usage, "no image to write is named", "command line", "give -o OUT.exr");
            for (const std::string& file : render.outputs) requireExtension("-o", file, kImageExtensions);
            if (!typed.layers.empty()) render.layers = parseLayers(typed.layers);
            resolve(render.common, typed);
            if (!render.cache.empty() && render.common.method != Method::Photon)
                throw Error(ErrorKind::Usage, "only --method photon has an irradiance cache", "--cache",
                            "leave --cache or --method away");
            if (!render.views.empty() &&
                (!render.common.camera.empty() || !render.pointsFolder.empty() || render.debugSample))
                throw Error(ErrorKind::Usage, "--camera, --export-points and --debug-sample are for one view",
                            "--views", "leave --views away, or them");
            return render;
        }
        if (planCommand->parsed()) {
            resolve(plan.common, typed);
            return plan;
        }
        if (infoCommand->parsed()) return info;
        if (checkCommand->parsed()) {
            if (!check.plot.empty()) requireExtension("--plot", check.plot, kPlotExtensions);
            if (!check.plot.empty() && !check.sweeps && !check.markdown)
                throw Error(ErrorKind::Usage, "only sweeps are drawn", "--plot", "add --sweeps or --markdown");
            return check;
        }
        if (optionsCommand->parsed()) return TextArguments{settingsMarkdown()};
        if (compareCommand->parsed()) return resultOfCompare();
        if (tuneCommand->parsed()) return resultOfTune();
        if (!typed.crop.empty()) diff.crop = parseCrop(typed.crop);
        for (const std::string& text : typed.failAbove) diff.failAbove.push_back(parseGate(text));
        if (!diff.map.empty()) requireExtension("--map", diff.map, kMapExtensions);
        return diff;
    }
};

/// The command for a shell, with quotes where it needs them.
[[nodiscard]] std::string asTyped(int count, const char* const* values) {
    std::string line = "pellucid";
    for (int i = 1; i < count; ++i) {
        const std::string word = values[i];
        const bool plain = !word.empty() && word.find_first_not_of(
                                                "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                                "0123456789-_=+,.:/%@") == std::string::npos;
        std::string quoted;
        for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
        line += plain ? " " + word : " '" + quoted + "'";
    }
    return line;
}

/// One line for what CLI11 says.
[[nodiscard]] std::string oneLine(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
    for (char& c : text)
        if (c == '\n') c = ' ';
    return text;
}

}  // namespace

Arguments parseArguments(int count, const char* const* values) {
    Parser parser;
    if (count > 1) parser.requireKnownCommand(values[1]);
    try {
        parser.app.parse(count, values);
    } catch (const CLI::CallForHelp&) {
        return TextArguments{parser.app.help()};
    } catch (const CLI::CallForVersion& version) {
        return TextArguments{std::string(version.what()) + "\n"};
    } catch (const CLI::ParseError& error) {
        const std::string command = parser.nameOfUsed();
        throw Error(ErrorKind::Usage, oneLine(error.what()), "command line",
                    "see `pellucid " + command + (command.empty() ? "" : " ") + "--help`");
    }
    Arguments arguments = parser.result();
    if (auto* const compare = std::get_if<CompareArguments>(&arguments)) compare->command = asTyped(count, values);
    if (auto* const tune = std::get_if<TuneArguments>(&arguments)) tune->command = asTyped(count, values);
    return arguments;
}

}  // namespace pellucid

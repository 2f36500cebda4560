#include "command_options.h"

#include <array>
#include <string_view>

#include <CLI/CLI.hpp>

#include <pellucid/base/error.h>

#include "argument_values.h"

namespace pellucid {

namespace {

constexpr std::array<std::string_view, 4> kImageExtensions{".exr", ".png", ".hdr", ".pfm"};
constexpr std::array<std::string_view, 1> kMapExtensions{".png"}, kPlotExtensions{".svg"};

}  // namespace

CLI::App* addRender(CLI::App& app, RenderArguments& arguments, TypedText& typed) {
    CLI::App* command = app.add_subcommand("render", "render a scene into image files");
    addSceneOptions(*command, arguments.common, typed);
    addRepeatable(*command, "-o,--output", arguments.outputs, "image to write; repeatable")
        ->type_name("OUT.exr|.png|.hdr|.pfm");
    command->add_option("--exposure", arguments.exposure, "stops of exposure, for PNG only")->type_name("EV");
    command
        ->add_option(
            "--layers", typed.layers,
            "more layers in the EXR: albedo, normal, depth, variance, records, "
            "radius, photons, classes (each path class by itself), all (but classes) or none; emission, direct, "
            "caustic and indirect are always there")
        ->type_name("A,B,...");
    command->add_option("--record", arguments.record, "what was done, as JSON")->type_name("FILE.json");
    CLI::Option* checkpoint =
        command->add_option("--checkpoint", arguments.checkpoint, "state to go on from")->type_name("FILE");
    command->add_flag("--resume", arguments.resume, "go on from the checkpoint")->needs(checkpoint);
    command
        ->add_option("--cache", arguments.cache,
                     "records and global map of this scene's light: read if the file is there, and written with what "
                     "this view adds. A file of another scene or of other settings is refused")
        ->excludes(checkpoint)
        ->type_name("FILE");
    command
        ->add_option(
            "--views", arguments.views,
            "a flythrough: an image for each camera of FILE, which has lines `eye X Y Z target X Y Z [up X Y Z] "
            "[fov DEGREES]`, or for each of the scene's own; out.exr gives out.0000.exr, ... All share one "
            "irradiance cache; the budget is that of each image")
        ->excludes(checkpoint)
        ->type_name("FILE|all");
    command
        ->add_option("--export-points", arguments.pointsFolder,
                     "folder for records.ply and caustic-photons.ply: point clouds for Blender or MeshLab")
        ->type_name("DIR");
    command
        ->add_option("--debug-sample", typed.sample,
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

void finish(RenderArguments& arguments, const TypedText& typed) {
    if (!typed.sample.empty()) arguments.debugSample = parseSample(typed.sample);
    if (arguments.outputs.empty() && !arguments.debugSample)
        throw Error(ErrorKind::Usage, "no image to write is named", "command line", "give -o OUT.exr");
    for (const std::string& file : arguments.outputs) requireExtension("-o", file, kImageExtensions);
    if (!typed.layers.empty()) arguments.layers = parseLayers(typed.layers);
    resolve(arguments.common, typed);
    if (!arguments.cache.empty() && arguments.common.method != Method::Photon)
        throw Error(ErrorKind::Usage, "only --method photon has an irradiance cache", "--cache",
                    "leave --cache or --method away");
    if (!arguments.views.empty() &&
        (!arguments.common.camera.empty() || !arguments.pointsFolder.empty() || arguments.debugSample))
        throw Error(ErrorKind::Usage, "--camera, --export-points and --debug-sample are for one view", "--views",
                    "leave --views away, or them");
}

CLI::App* addPlan(CLI::App& app, PlanArguments& arguments, TypedText& typed) {
    CLI::App* command = app.add_subcommand("plan", "what a render will do and leave out, why, and at what cost");
    addSceneOptions(*command, arguments.common, typed);
    command->add_flag("--json", arguments.json, "for programs");
    command->footer("Examples:\n  pellucid plan scene.glb\n  pellucid plan scene.glb --method path --json");
    return command;
}

CLI::App* addInfo(CLI::App& app, InfoArguments& arguments) {
    CLI::App* command = app.add_subcommand("info", "what a scene holds");
    addSceneFile(*command, arguments.common);
    command->add_flag("--json", arguments.json, "for programs");
    command->footer("Examples:\n  pellucid info scene.glb\n  pellucid info scene.glb --json");
    return command;
}

CLI::App* addDiff(CLI::App& app, DiffArguments& arguments, TypedText& typed) {
    CLI::App* command = app.add_subcommand("diff", "measure images against a reference");
    command
        ->add_option("reference", arguments.reference,
                     "image to compare with; pixels where its channel mask.Y is 0 do "
                     "not count")
        ->required()
        ->type_name("REF.exr");
    command->add_option("images", arguments.images, "images to measure")->required()->type_name("IMG.exr ...");
    command->add_flag("--json", arguments.json, "for programs");
    command->add_option("--crop", typed.crop, "only this box; x1 and y1 lie one past the last pixel")
        ->type_name("x0,y0,x1,y1");
    command
        ->add_option("--map", arguments.map,
                     "false-colour map of HDR-FLIP; OUT-1.png, OUT-2.png, ... for several images")
        ->type_name("OUT.png");
    addRepeatable(*command, "--fail-above", typed.failAbove,
                  "exit with 4 when a metric of an image is above; repeatable. "
                  "rmse, relmse, relmse_trimmed, smape, flip, bias (either sign), nonfinite")
        ->type_name("METRIC=VALUE");
    command->add_flag("--exposure-invariant", arguments.exposureInvariant,
                      "scale images to the reference's mean first");
    command->footer(
        "Examples:\n  pellucid diff ref.exr a.exr b.exr\n"
        "  pellucid diff ref.exr a.exr --crop 285,440,490,500 --map error.png\n"
        "  pellucid diff ref.exr a.exr --json --fail-above relmse=0.01 --fail-above nonfinite=0");
    return command;
}

void finish(DiffArguments& arguments, const TypedText& typed) {
    if (!typed.crop.empty()) arguments.crop = parseCrop(typed.crop);
    for (const std::string& text : typed.failAbove) arguments.failAbove.push_back(parseGate(text));
    if (!arguments.map.empty()) requireExtension("--map", arguments.map, kMapExtensions);
}

CLI::App* addCheck(CLI::App& app, CheckArguments& arguments) {
    CLI::App* command = app.add_subcommand("check", "the numerical suite: closed forms, extremes, invariants");
    command->add_option("--filter", arguments.filter, "only cases with this in their name")->type_name("NAME");
    CLI::Option* json = command->add_flag("--json", arguments.json, "for programs");
    CLI::Option* markdown =
        command->add_flag("--markdown", arguments.markdown, "the page docs/validation.md")->excludes(json);
    CLI::Option* quick = command->add_flag("--quick", arguments.quick, "leave out the slow cases");
    command
        ->add_flag("--sweeps", arguments.sweeps,
                   "instead of the cases, the sweeps of stiffness: error and time over decades of a dial")
        ->excludes(quick);
    command
        ->add_flag("--convergence", arguments.convergence,
                   "instead of the cases, how the error of the photon methods falls with the number of photons")
        ->excludes(quick)
        ->excludes(markdown)
        ->excludes("--sweeps");
    command->add_flag("--list", arguments.list, "the names of the cases and what each guards; nothing is run")
        ->excludes(json)
        ->excludes(markdown);
    command->add_option("--plot", arguments.plot, "draw what --sweeps, --convergence or --markdown measured")
        ->type_name("OUT.svg");
    command->add_option("--threads", arguments.threads, "worker threads; 0: all. No figure depends on it")
        ->check(CLI::Range(0, 1024))
        ->type_name("N");
    command->add_option("--seed", arguments.seed, "another seed makes other noise (default: 0)")
        ->check(CLI::NonNegativeNumber)
        ->type_name("N");
    command->add_flag("--quiet", arguments.quiet, "print nothing but the report and errors");
    command->footer(
        "Examples:\n  pellucid check --quick\n  pellucid check --filter closed-form --json\n"
        "  pellucid check --sweeps --filter 'lamp size' --plot sweeps.svg");
    return command;
}

void finish(const CheckArguments& arguments) {
    if (arguments.plot.empty()) return;
    requireExtension("--plot", arguments.plot, kPlotExtensions);
    if (!arguments.sweeps && !arguments.convergence && !arguments.markdown)
        throw Error(ErrorKind::Usage, "only sweeps and convergence are drawn", "--plot",
                    "add --sweeps, --convergence or --markdown");
}

}  // namespace pellucid

// The options of the commands that make many renders: compare and tune.
#include <CLI/CLI.hpp>

#include <pellucid/base/error.h>

#include "argument_values.h"
#include "command_options.h"

namespace pellucid {

CLI::App* addCompare(CLI::App& app, CompareArguments& arguments, TypedText& typed) {
    CLI::App* command = app.add_subcommand("compare", "error against run time of several methods, with a report");
    addPictureOptions(*command, arguments.common, typed);
    command->add_option("-o,--output", arguments.folder, "folder for runs, figures and report.html")
        ->required()
        ->type_name("DIR");
    command
        ->add_option("--methods", typed.methods,
                     "photon, path, bdpt, light, reference, sppm, each with settings of its own after a colon")
        ->required()
        ->type_name("M[:KEY=VALUE+...],...");
    command->add_option("--times", typed.times, "budgets of each run, in seconds")->required()->type_name("S,S,...");
    command->add_option("--seeds", arguments.seeds, "independent runs of each method and time (default: 8)")
        ->check(CLI::Range(1, 1000))
        ->type_name("K");
    command
        ->add_option("--reference", arguments.reference,
                     "image to measure against (.exr, .hdr, .pfm); layers variance.* and mask.Y are used. "
                     "Without it one is made")
        ->type_name("FILE");
    command
        ->add_option("--reference-time", arguments.referenceTime,
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

void finish(CompareArguments& arguments, const TypedText& typed) {
    resolve(arguments.common, typed);
    arguments.methods = parseMethods(typed.methods, arguments.common.settings);
    arguments.times = parseTimes(typed.times);
}

CLI::App* addTune(CLI::App& app, TuneArguments& arguments, TypedText& typed) {
    CLI::App* command = app.add_subcommand("tune", "find the settings that render this scene best in a given time");
    addPictureOptions(*command, arguments.common, typed);
    command
        ->add_option("-o,--output", arguments.folder, "folder for tuned.toml, front.json, report.html and the trials")
        ->required()
        ->type_name("DIR");
    command->add_option("--time", arguments.time, "seconds that the renders to tune for are to take")
        ->required()
        ->check(CLI::PositiveNumber)
        ->type_name("S");
    CLI::Option* budget =
        command->add_option("--budget", arguments.budget, "seconds for the tuning as a whole, the reference included")
            ->check(CLI::PositiveNumber)
            ->type_name("S");
    command
        ->add_option("--iterations", arguments.iterations,
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
        ->add_option("--reference", arguments.reference,
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

void finish(TuneArguments& arguments, const TypedText& typed) {
    resolve(arguments.common, typed);
    if (arguments.budget == 0.0 && arguments.iterations == 0)
        throw Error(ErrorKind::Usage, "how long to tune is missing", "tune", "give --budget S, or --iterations N");
    if (!typed.over.empty()) arguments.over = parseOver(typed.over);
    if (!typed.goal.empty()) arguments.goal = parseGoal(typed.goal);
}

}  // namespace pellucid

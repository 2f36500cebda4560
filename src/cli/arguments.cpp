#include "arguments.h"

#include <algorithm>
#include <string_view>

#include <CLI/CLI.hpp>

#include <pellucid/base/error.h>
#include <pellucid/base/nearest_name.h>
#include <pellucid/render/settings_page.h>

#include "command_options.h"

namespace pellucid {
namespace {

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
        renderCommand = addRender(app, render, typed);
        planCommand = addPlan(app, plan, typed);
        infoCommand = addInfo(app, info);
        diffCommand = addDiff(app, diff, typed);
        checkCommand = addCheck(app, check);
        compareCommand = addCompare(app, compare, typed);
        optionsCommand = app.add_subcommand("options", "every setting that --set and --config take");
        tuneCommand = addTune(app, tune, typed);
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
        if (renderCommand->parsed()) return finished(render);
        if (planCommand->parsed()) {
            resolve(plan.common, typed);
            return plan;
        }
        if (infoCommand->parsed()) return info;
        if (checkCommand->parsed()) {
            finish(check);
            return check;
        }
        if (optionsCommand->parsed()) return TextArguments{settingsMarkdown()};
        if (compareCommand->parsed()) return finished(compare);
        if (tuneCommand->parsed()) return finished(tune);
        return finished(diff);
    }

    template <class Command>
    [[nodiscard]] Arguments finished(Command& command) {
        finish(command, typed);
        return command;
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

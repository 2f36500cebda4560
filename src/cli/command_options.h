/// The commands and their options, each declared into a CLI11 parser that writes to these values. What needs all options to be
/// known before it can be read waits in TypedText, for the function that finishes the command.
#pragma once

#include "arguments.h"
#include "shared_options.h"

namespace pellucid {

CLI::App* addRender(CLI::App& app, RenderArguments& arguments, TypedText& typed);
CLI::App* addPlan(CLI::App& app, PlanArguments& arguments, TypedText& typed);
CLI::App* addInfo(CLI::App& app, InfoArguments& arguments);
CLI::App* addDiff(CLI::App& app, DiffArguments& arguments, TypedText& typed);
CLI::App* addCheck(CLI::App& app, CheckArguments& arguments);
CLI::App* addCompare(CLI::App& app, CompareArguments& arguments, TypedText& typed);
CLI::App* addTune(CLI::App& app, TuneArguments& arguments, TypedText& typed);

/// Throw Error{Usage} for what does not go together.
void finish(RenderArguments& arguments, const TypedText& typed);
void finish(DiffArguments& arguments, const TypedText& typed);
void finish(const CheckArguments& arguments);
void finish(CompareArguments& arguments, const TypedText& typed);
void finish(TuneArguments& arguments, const TypedText& typed);

}  // namespace pellucid

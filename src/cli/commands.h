/// One function a command. Each returns the exit status and throws Error for everything else.
#pragma once

#include <chrono>

#include "arguments.h"

namespace pellucid {

using Clock = std::chrono::steady_clock;

/// Exit status of a command that was interrupted; what was done is saved.
constexpr int kInterrupted = 130;

/// `started`: when the program began; a budget of time counts from there.
[[nodiscard]] int runRender(const RenderArguments& arguments, Clock::time_point started);
/// render --debug-sample.
[[nodiscard]] int runReplay(const RenderArguments& arguments);
[[nodiscard]] int runPlan(const PlanArguments& arguments);
[[nodiscard]] int runInfo(const InfoArguments& arguments);
[[nodiscard]] int runDiff(const DiffArguments& arguments);
[[nodiscard]] int runCheck(const CheckArguments& arguments);
[[nodiscard]] int runCompare(const CompareArguments& arguments);
[[nodiscard]] int runTune(const TuneArguments& arguments);

}  // namespace pellucid

// The command: parse, run, and turn whatever goes wrong into one line and an exit status.
#include <csignal>
#include <exception>
#include <new>
#include <variant>

#include <pellucid/base/error.h>
#include <pellucid/base/parallel.h>

#include "arguments.h"
#include "commands.h"
#include "process.h"
#include "terminal.h"

namespace {

using namespace pellucid;

struct Run {
    Clock::time_point started;
    int operator()(const RenderArguments& arguments) const { return runRender(arguments, started); }
    int operator()(const PlanArguments& arguments) const { return runPlan(arguments); }
    int operator()(const InfoArguments& arguments) const { return runInfo(arguments); }
    int operator()(const DiffArguments& arguments) const { return runDiff(arguments); }
    int operator()(const CheckArguments& arguments) const { return runCheck(arguments); }
    int operator()(const CompareArguments& arguments) const { return runCompare(arguments); }
    int operator()(const TuneArguments& arguments) const { return runTune(arguments); }
    int operator()(const TextArguments& arguments) const {
        printResult(arguments.text);
        return 0;
    }
};

int fail(const Error& error) {
    printError(error);
    return static_cast<int>(error.kind());
}

}  // namespace

int main(int count, char** values) {
    const auto started =
        Clock::now() - std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(processAge()));
    std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is a failed write, with its own message
    exitOnInterrupts();             // until a command has something to save
    failOnFullFiles();
    flushDenormalsOnThisThread();  // what runs outside of Workers computes as what runs inside
    try {
        return std::visit(Run{started}, parseArguments(count, values));
    } catch (const Error& error) {
        return fail(error);
    } catch (const std::bad_alloc&) {
        return fail({ErrorKind::CannotFinish, "out of memory", "this machine", "give a smaller --size or scene"});
    } catch (const std::exception& error) {
        return fail({ErrorKind::CannotFinish, error.what(), "internal", "report this with its command and scene"});
    }
}

// `pellucid check`: run the cases one by one, tell each as it ends, then print the report. Any failure exits with 4.
#include <string>

#include <pellucid/base/error.h>
#include <pellucid/study/check.h>
#include <pellucid/study/text_table.h>

#include "commands.h"
#include "terminal.h"

namespace pellucid {

int runCheck(const CheckArguments& arguments) {
    const auto chosen = selectChecks(arguments.filter, arguments.quick);
    if (chosen.empty())
        throw Error(ErrorKind::Usage, "no check has '" + arguments.filter + "' in its name", "--filter",
                    "run without --filter to see all names");
    const Workers workers(arguments.threads);
    const LogSink log = terminalLog(arguments.quiet);
    CheckReport report{PELLUCID_VERSION, arguments.seed, workers.threads(), arguments.quick, {}};
    for (const CheckCase* check : chosen) {
        report.results.push_back(runCheck(*check, {workers, arguments.seed}));
        const CheckResult& result = report.results.back();
        logTo(log, result.passed() ? LogLevel::Info : LogLevel::Warning,
              std::to_string(report.results.size()) + "/" + std::to_string(chosen.size()) + " " + check->name +
                  (result.passed() ? " ok, " : " FAILED, ") + duration(result.seconds));
    }
    if (arguments.markdown)
        printResult(checkMarkdown(report));
    else
        printResult(arguments.json ? checkJson(report) : checkTable(report));
    if (report.failures() > 0)
        throw Error(
            ErrorKind::CheckFailed,
            std::to_string(report.failures()) + " of " + std::to_string(report.results.size()) + " checks failed",
            "check", "see the figures marked above; --filter NAME runs one alone");
    return 0;
}

}  // namespace pellucid

// `pellucid check`: run the cases one by one, tell each as it ends, then print the report. Any failure exits with 4.
#include <filesystem>
#include <string>
#include <vector>

#include <pellucid/base/error.h>
#include <pellucid/io/plain_file.h>
#include <pellucid/study/check.h>
#include <pellucid/study/convergence.h>
#include <pellucid/study/stiffness.h>
#include <pellucid/study/text_table.h>

#include "commands.h"
#include "terminal.h"

namespace pellucid {

namespace {

/// Sweeps, drawn where that is asked for.
[[nodiscard]] std::vector<Sweep> sweep(const CheckArguments& arguments, const Workers& workers, const LogSink& log) {
    if (!arguments.plot.empty()) checkFolderWritable(arguments.plot);
    std::vector<Sweep> sweeps =
        runSweeps({workers, arguments.seed}, arguments.sweeps ? arguments.filter : "", [&](const Sweep& s) {
            logTo(log, LogLevel::Info, "sweep, " + s.name + " " + figure(s.steps.back().value) + " done");
        });
    if (sweeps.empty())
        throw Error(ErrorKind::Usage, "no sweep has '" + arguments.filter + "' in its name", "--filter",
                    "--sweeps --list shows all names");
    if (!arguments.plot.empty()) writeFile(arguments.plot, sweepsSvg(sweeps));
    return sweeps;
}

/// One line a case; those that --quick leaves out say so.
[[nodiscard]] std::string listed(const std::vector<const CheckCase*>& cases) {
    TextTable table({"case", "group", "", "guards"});
    for (const CheckCase* c : cases)
        table.add({c->name, std::string(groupName(c->group)), c->quick ? "" : "slow", c->guards});
    return table.text();
}
[[nodiscard]] std::string listedSweeps(std::string_view filter) {
    std::string text;
    for (const std::string_view name : sweepNames())
        if (name.find(filter) != std::string_view::npos) text += std::string(name) + "\n";
    return text;
}

void runConvergence(const CheckArguments& arguments) {
    if (!arguments.plot.empty()) checkFolderWritable(arguments.plot);
    const Workers workers(arguments.threads);
    const LogSink log = terminalLog(arguments.quiet);
    const std::vector<ConvergenceCurve> curves =
        measureConvergence({workers, arguments.seed}, wholeConvergence(),
                           [&](const ConvergenceCurve& c) { logTo(log, LogLevel::Info, c.label + " done"); });
    if (!arguments.plot.empty()) writeFile(arguments.plot, convergenceSvg(curves));
    printResult(arguments.json ? convergenceJson(curves) : convergenceTable(curves));
}

}  // namespace

int runCheck(const CheckArguments& arguments) {
    if (arguments.convergence) {
        runConvergence(arguments);
        return 0;
    }
    if (arguments.sweeps && arguments.list) {
        printResult(listedSweeps(arguments.filter));
        return 0;
    }
    if (arguments.sweeps) {
        const Workers workers(arguments.threads);
        const std::vector<Sweep> sweeps = sweep(arguments, workers, terminalLog(arguments.quiet));
        printResult(arguments.markdown
                        ? sweepsMarkdown(sweeps, std::filesystem::path(arguments.plot).filename().string())
                    : arguments.json ? sweepsJson(sweeps)
                                     : sweepsTable(sweeps));
        return 0;
    }
    const auto chosen = selectChecks(arguments.filter, arguments.quick);
    if (chosen.empty())
        throw Error(ErrorKind::Usage, "no check has '" + arguments.filter + "' in its name", "--filter",
                    "--list shows all names");
    if (arguments.list) {
        printResult(listed(chosen));
        return 0;
    }
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
    if (arguments.markdown && arguments.filter.empty() && !arguments.quick)
        printResult(checkMarkdown(report) + sweepsMarkdown(sweep(arguments, workers, log),
                                                           std::filesystem::path(arguments.plot).filename().string()));
    else if (arguments.markdown)
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

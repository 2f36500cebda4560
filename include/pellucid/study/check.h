/// `pellucid check`: the renderer held against what is known without it. A case makes its own tiny scene in memory (or
/// its own photons), measures, and states each figure beside its expectation, its confidence and the bias that it may
/// have. The closed forms are those of the field's textbooks; the extremes have invariants. To add a case, add an entry
/// to one of the lists in src/study/check_*.cpp: a name, what it guards, and a function that returns findings.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <pellucid/base/parallel.h>

namespace pellucid {

enum class CheckGroup { ClosedForm, Kernel, MonteCarlo, Energy, Extreme };

/// A figure against its expectation. It passes when they are no further apart than confidence and allowed bias together,
/// and when the confidence interval is narrow enough to mean something.
struct Finding {
    std::string quantity;  ///< what was measured, and by which method
    double expected = 0.0, measured = 0.0;
    double interval = 0.0;   ///< half width of the confidence interval of `measured`
    double allowance = 0.0;  ///< bias that the method may have, declared beforehand
    double resolution = std::numeric_limits<double>::infinity();  ///< greatest interval that counts as a measurement

    [[nodiscard]] bool passed() const noexcept;
};

struct CheckContext {
    const Workers& workers;
    std::uint64_t seed = 0;
};

struct CheckCase {
    std::string name;  ///< words with hyphens; --filter looks for a part of it
    CheckGroup group = CheckGroup::ClosedForm;
    std::string guards;  ///< the formula or invariant
    std::string source;  ///< where it comes from
    bool quick = true;   ///< part of --quick
    std::function<std::vector<Finding>(const CheckContext&)> run;
};

struct CheckResult {
    const CheckCase* check = nullptr;
    std::vector<Finding> findings;
    std::string problem;  ///< what was thrown; empty: nothing
    double seconds = 0.0;

    [[nodiscard]] bool passed() const noexcept;
};

struct CheckReport {
    std::string version;
    std::uint64_t seed = 0;
    int threads = 0;
    bool quick = false;
    std::vector<CheckResult> results = {};

    [[nodiscard]] std::size_t failures() const noexcept;
};

/// Every case, in the order of the report. Lives as long as the program.
[[nodiscard]] const std::vector<CheckCase>& checkCases();

/// Cases whose name holds `filter` (empty: all), only the quick ones if asked for.
[[nodiscard]] std::vector<const CheckCase*> selectChecks(std::string_view filter, bool quick);

/// Never throws what the case throws: that is a failure with its text.
[[nodiscard]] CheckResult runCheck(const CheckCase& check, const CheckContext& context);

[[nodiscard]] std::string checkTable(const CheckReport& report);
[[nodiscard]] std::string checkJson(const CheckReport& report);
/// The page docs/validation.md.
[[nodiscard]] std::string checkMarkdown(const CheckReport& report);

[[nodiscard]] std::string_view groupName(CheckGroup group) noexcept;

}  // namespace pellucid

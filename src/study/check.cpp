#include <pellucid/study/check.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>

#include "check_cases.h"

namespace pellucid {

bool Finding::passed() const noexcept {
    // Written so that a NaN fails.
    return std::fabs(measured - expected) <= interval + allowance && interval <= resolution;
}

bool CheckResult::passed() const noexcept {
    return problem.empty() && !findings.empty() && std::ranges::all_of(findings, &Finding::passed);
}

std::size_t CheckReport::failures() const noexcept {
    return static_cast<std::size_t>(std::ranges::count_if(results, [](const CheckResult& r) { return !r.passed(); }));
}

const std::vector<CheckCase>& checkCases() {
    static const std::vector<CheckCase> cases = [] {
        check::Cases list;
        check::addFurnaces(list);
        check::addLamps(list);
        check::addSkies(list);
        check::addFlatMirrors(list);
        check::addSlabs(list);
        check::addDispersion(list);
        check::addCurvedMirrors(list);
        check::addLenses(list);
        check::addKernels(list);
        check::addMonteCarlo(list);
        check::addEnergy(list);
        check::addScaleExtremes(list);
        check::addMaterialExtremes(list);
        check::addGeometryExtremes(list);
        check::addCoincidentFaces(list);
        check::addLampExtremes(list);
        check::addSightExtremes(list);
        check::addSizeExtremes(list);
        check::addPhotonExtremes(list);
        return list;
    }();
    return cases;
}

std::vector<const CheckCase*> selectChecks(std::string_view filter, bool quick) {
    std::vector<const CheckCase*> chosen;
    for (const CheckCase& c : checkCases())
        if ((!quick || c.quick) && c.name.find(filter) != std::string::npos) chosen.push_back(&c);
    return chosen;
}

CheckResult runCheck(const CheckCase& check, const CheckContext& context) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    CheckResult result;
    result.check = &check;
    try {
        result.findings = check.run(context);
    } catch (const std::exception& error) {
        result.problem = error.what();
    }
    result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return result;
}

std::string_view groupName(CheckGroup group) noexcept {
    switch (group) {
        case CheckGroup::ClosedForm:
            return "closed form";
        case CheckGroup::Kernel:
            return "kernel";
        case CheckGroup::MonteCarlo:
            return "Monte Carlo";
        case CheckGroup::Energy:
            return "energy";
        case CheckGroup::Extreme:
            return "extreme";
    }
    return "";
}

}  // namespace pellucid

// The quick part of `pellucid check`, one test a case.
#include <algorithm>
#include <cctype>
#include <ostream>

#include <gtest/gtest.h>

#include <pellucid/study/check.h>

namespace pellucid {

/// GoogleTest names parameters by this; a pointer's value would change from run to run.
void PrintTo(const CheckCase* check, std::ostream* out) { *out << check->name; }

namespace {

class Check : public testing::TestWithParam<const CheckCase*> {};

TEST_P(Check, Holds) {
    const Workers workers;
    const CheckResult result = runCheck(*GetParam(), {workers, 0});
    EXPECT_EQ(result.problem, "");
    for (const Finding& f : result.findings)
        EXPECT_TRUE(f.passed()) << f.quantity << ": expected " << f.expected << ", measured " << f.measured << " +- "
                                << f.interval << ", bias allowed " << f.allowance << ", interval at most "
                                << f.resolution;
    EXPECT_TRUE(result.passed());
}

std::string testName(const testing::TestParamInfo<const CheckCase*>& info) {
    std::string name = info.param->name;
    std::ranges::replace_if(
        name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Quick, Check, testing::ValuesIn(selectChecks("", true)), testName);

}  // namespace
}  // namespace pellucid

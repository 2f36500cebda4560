/// The files of a comparison as text: curves.json and curves.csv (one row a run), summary.json (intervals), and the table
/// for people. Their names and units are a contract.
#pragma once

#include <string>

#include "compare_analysis.h"

namespace pellucid {

[[nodiscard]] std::string curvesJson(const CompareRequest& request, const CompareRuns& runs);
[[nodiscard]] std::string curvesCsv(const CompareRequest& request, const CompareRuns& runs);
[[nodiscard]] std::string summaryJson(const CompareRequest& request, const CompareRuns& runs,
                                      const CompareReference& reference, const CompareFigures& figures);
[[nodiscard]] std::string compareTable(const CompareReference& reference, const CompareFigures& figures);

}  // namespace pellucid

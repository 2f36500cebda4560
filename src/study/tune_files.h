/// The files of a tuning as text: front.json, tuned.toml, and the summary for people.
#pragma once

#include <string>

#include "tune_front.h"

namespace pellucid {

/// All that was found, for the files and the page.
struct TuneFindings {
    const TuneRequest& request;
    const SearchSpace& space;
    const TuneReference& reference;
    const SearchOutcome& search;
    const Front& front;
    TuneGoal goal;
    Choice choice;
    std::string sceneHash;  ///< of the scene as built for the chosen settings
};

[[nodiscard]] std::string frontJson(const TuneFindings& findings);
[[nodiscard]] std::string tunedToml(const TuneFindings& findings);
[[nodiscard]] std::string tuneText(const TuneFindings& findings);

/// report.html; `frontJson` as above.
[[nodiscard]] std::string tuneReportHtml(const TuneFindings& findings, const std::string& frontJson);

}  // namespace pellucid

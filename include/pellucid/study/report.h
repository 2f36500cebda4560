/// report.html: one page that holds everything and asks for nothing, so that it opens offline and can be sent. The page is
/// made from src/study/report/ and the plotting library D3, embedded when the program is built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <pellucid/math/image.h>

namespace pellucid {

struct ReportPicture {
    std::string label;    ///< method, or "reference"
    double budget = 0.0;  ///< seconds; 0 for the reference
    std::uint64_t seed = 0;
    Image image;  ///< R G B and more
};

struct ReportMap {
    std::string label, kind;  ///< method; "bias" or "deviation"
    double budget = 0.0;
    Image image;  ///< one channel
};

/// A run's decisions and settings, as JSON text that the page shows.
struct ReportData {
    std::string title;
    std::string summaryJson, curvesJson;  ///< the files of that name
    std::string runsJson;                 ///< by method: plan decisions, resolved settings, blind spots
    std::vector<ReportPicture> pictures;  ///< in order of importance: the page takes as many as fit
    std::vector<ReportMap> maps;
};

/// Size that a page stays below.
inline constexpr std::size_t kReportBytes = 14'500'000;

/// The page. Pixels are float32 where they fit, else float32 without its lowest 8 bits, else half floats: the page tells
/// which, and shows values to no more digits than it has. Pictures that do not fit are left out from the end; when not even
/// the first budget's fit, all are halved in size.
[[nodiscard]] std::string reportHtml(const ReportData& data);

}  // namespace pellucid

/// The texts of src/study/report/ and D3, defined in a source that cmake/embed.cmake writes at build time.
#pragma once

#include <string_view>

namespace pellucid::report_parts {

extern const std::string_view kHead, kTemplate, kStyle, kD3, kCharts, kViewer, kTables, kTuneTemplate, kTune;

}  // namespace pellucid::report_parts

/// The small grammars of option values: WxH, x0,y0,x1,y1, KEY=VALUE, A,B,C. Each throws Error{Usage} that names the
/// option.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pellucid/study/metrics.h>

#include "arguments.h"

namespace pellucid {

[[nodiscard]] std::pair<int, int> parseSize(const std::string& text);
[[nodiscard]] CropBox parseCrop(const std::string& text);
/// x,y,s of --debug-sample.
[[nodiscard]] SampleName parseSample(const std::string& text);
/// Splits at the first '='.
[[nodiscard]] std::pair<std::string, std::string> parseAssignment(const std::string& option, const std::string& text);
/// METRIC=VALUE of --fail-above.
[[nodiscard]] std::pair<std::string, double> parseGate(const std::string& text);
/// Names separated by commas, each a known layer. "none" stands for no layer beyond those that are always there.
[[nodiscard]] std::vector<std::string> parseLayers(const std::string& text);
/// Throws unless `file` ends in one of the extensions (with their dots).
void requireExtension(const std::string& option, const std::string& file, std::span<const std::string_view> extensions);

}  // namespace pellucid

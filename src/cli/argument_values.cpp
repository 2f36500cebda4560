#include "argument_values.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>

#include <pellucid/base/error.h>
#include <pellucid/base/nearest_name.h>
#include <pellucid/study/diff_report.h>

namespace pellucid {
namespace {

constexpr int kLargestSide = 65536;
/// emission, direct, caustic and indirect are in every EXR and may be named all the same.
constexpr std::array<std::string_view, 21> kLayers{
    "all",     "none",    "emission",      "direct",          "caustic",    "indirect",     "classes",
    "albedo",  "normal",  "depth",         "variance",        "records",    "radius",       "photons",
    "density", "samples", "record_radius", "record_gradient", "record_age", "record_reuse", "record_reason"};
constexpr std::size_t kAlwaysThere = 6;  // of them name no extra layer, "all" apart

[[nodiscard]] std::vector<std::string> split(std::string_view text, char separator) {
    std::vector<std::string> parts;
    while (true) {
        const std::size_t end = text.find(separator);
        parts.emplace_back(text.substr(0, end));
        if (end == std::string_view::npos) return parts;
        text.remove_prefix(end + 1);
    }
}

template <class Number>
[[nodiscard]] std::optional<Number> parse(std::string_view text) {
    Number value{};
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& mend) {
    throw Error(ErrorKind::Usage, "'" + text + "' cannot be understood", option, mend);
}

}  // namespace

std::pair<int, int> parseSize(const std::string& text) {
    const std::vector<std::string> sides = split(text, 'x');
    const auto width = parse<int>(sides[0]);
    const auto height = sides.size() == 2 ? parse<int>(sides[1]) : std::nullopt;
    if (!width || !height || *width < 1 || *height < 1 || *width > kLargestSide || *height > kLargestSide)
        refuse("--size", text, "give width and height from 1 to 65536, such as --size 512x288");
    return {*width, *height};
}

CropBox parseCrop(const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    std::array<int, 4> sides{};
    bool understood = parts.size() == sides.size();
    for (std::size_t i = 0; understood && i < sides.size(); ++i) {
        const auto value = parse<int>(parts[i]);
        understood = value.has_value();
        sides[i] = value.value_or(0);
    }
    if (!understood) refuse("--crop", text, "give x0,y0,x1,y1 in pixels, such as --crop 0,0,64,64");
    return {sides[0], sides[1], sides[2], sides[3]};
}

SampleName parseSample(const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    const auto x = parse<int>(parts[0]), y = parts.size() == 3 ? parse<int>(parts[1]) : std::nullopt;
    const auto sample = parts.size() == 3 ? parse<std::uint32_t>(parts[2]) : std::nullopt;
    if (!x || !y || !sample) refuse("--debug-sample", text, "give X,Y,S, such as --debug-sample 120,33,4");
    return {*x, *y, *sample};
}

std::pair<std::string, std::string> parseAssignment(const std::string& option, const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) refuse(option, text, "write it as KEY=VALUE, without blanks");
    return {text.substr(0, equals), text.substr(equals + 1)};
}

std::pair<std::string, double> parseGate(const std::string& text) {
    const auto [name, value] = parseAssignment("--fail-above", text);
    const auto limit = parse<double>(value);
    if (!limit || !std::isfinite(*limit)) refuse("--fail-above", text, "give METRIC=NUMBER, such as relmse=0.01");
    static_cast<void>(metricByName(Metrics{}, name));  // an unknown name is an error before any image is read
    return {name, *limit};
}

std::vector<std::string> parseLayers(const std::string& text) {
    std::vector<std::string> layers;
    for (std::string& name : split(text, ',')) {
        const auto known = std::ranges::find(kLayers, name);
        if (known == kLayers.end())
            throw Error(ErrorKind::Usage, "there is no layer '" + name + "'", "--layers",
                        "the nearest name is '" + std::string(nearestName(name, kLayers)) + "'");
        if (known == kLayers.begin() || static_cast<std::size_t>(known - kLayers.begin()) >= kAlwaysThere)
            layers.push_back(std::move(name));
    }
    return layers;
}

void requireExtension(const std::string& option, const std::string& file,
                      std::span<const std::string_view> extensions) {
    const std::string extension = std::filesystem::path(file).extension().string();
    if (std::ranges::find(extensions, extension) != extensions.end()) return;
    std::string known;
    for (const std::string_view e : extensions) known += (known.empty() ? "" : ", ") + std::string(e);
    throw Error(ErrorKind::Usage, "'" + file + "' has no extension that can be written", option, "end it in " + known);
}

}  // namespace pellucid

#include "tune_space.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <pellucid/base/error.h>
#include <pellucid/base/nearest_name.h>

namespace pellucid {
namespace {

constexpr const char* kAutomatic = "auto";
constexpr double kAutomaticShare = 0.5;  // of a coordinate

[[nodiscard]] bool isWhole(const Parameter& row) { return std::holds_alternative<int Settings::*>(row.member); }
[[nodiscard]] bool isWord(const Parameter& row) { return std::holds_alternative<std::string Settings::*>(row.member); }

[[nodiscard]] std::string valueOf(const Settings& settings, std::string_view name) {
    for (const auto& [key, value] : settingsAsText(settings))
        if (key == name) return value;
    return "";
}

[[nodiscard]] double number(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

/// Three significant digits, without an exponent where a person would write none.
[[nodiscard]] std::string rounded(double value, bool whole) {
    const double size = value == 0.0 ? 1.0 : std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2.0);
    double shown = std::round(value / size) * size;
    if (whole) shown = std::round(shown);
    char text[40];
    std::snprintf(text, sizeof text, whole ? "%.0f" : "%.6g", shown);
    return text;
}

/// The declared range, in numbers that hold for this plan.
[[nodiscard]] Dimension declared(const Parameter& row, const RenderRecord& plan) {
    Dimension d;
    d.row = &row;
    d.standard = valueOf(plan.resolved, row.name);
    if (row.automatic && d.standard == "-1") d.standard = kAutomatic;
    const double factor = row.tuning.timesPlan && d.hasStandard() ? std::max(1.0, number(d.standard)) : 1.0;
    d.low = std::max(row.lower, row.tuning.low * factor);
    d.high = std::min(row.upper, row.tuning.high * factor);
    return d;
}

[[nodiscard]] const Parameter* rowNamed(std::string_view name) {
    for (const Parameter& row : parameters())
        if (row.name == name) return &row;
    return nullptr;
}

[[noreturn]] void refuse(const std::string& text, const std::string& mend) {
    throw Error(ErrorKind::Usage, "'" + text + "' cannot be searched", "--over", mend);
}

[[nodiscard]] std::vector<std::string> split(const std::string& text, const std::string& separator) {
    std::vector<std::string> parts;
    std::size_t from = 0;
    for (std::size_t at = text.find(separator); at != std::string::npos; at = text.find(separator, from)) {
        parts.push_back(text.substr(from, at - from));
        from = at + separator.size();
    }
    parts.push_back(text.substr(from));
    return parts;
}

[[nodiscard]] bool parseNumber(const std::string& text, double& value) {
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    return status == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
}

/// LOW..HIGH, checked against the row.
void readRange(TuneOver& over, const Parameter& row, const std::string& range, const std::string& text) {
    const std::vector<std::string> ends = split(range, "..");
    const std::string mend = "write " + over.name + "=LOW..HIGH, such as " + over.name + "=" +
                             rounded(row.tuning.high > 0.0 && !row.tuning.timesPlan ? row.tuning.low : 1.0, false) +
                             ".." +
                             rounded(row.tuning.high > 0.0 && !row.tuning.timesPlan ? row.tuning.high : 100.0, false);
    if (ends.size() != 2 || !parseNumber(ends[0], over.low) || !parseNumber(ends[1], over.high)) refuse(text, mend);
    if (over.low >= over.high) refuse(text, "the low end must lie below the high end");
    if (over.low < row.lower || over.high > row.upper)
        refuse(text, "allowed are values from " + rounded(row.lower, false) + " to " + rounded(row.upper, false));
    if (row.logScale && !(over.low > 0.0)) refuse(text, "its scale is logarithmic: begin above 0");
}

void readWords(TuneOver& over, const Parameter& row, const std::string& words, const std::string& text) {
    over.words = split(words, "|");
    Settings probe;
    for (const std::string& word : over.words) setParameter(probe, row.name, word);
    if (over.words.size() < 2) refuse(text, "give two words or more, such as " + over.name + "=on|off");
}

}  // namespace

std::vector<TuneOver> parseOver(const std::string& text) {
    std::vector<TuneOver> result;
    for (const std::string& part : split(text, ",")) {
        const std::size_t equals = part.find('=');
        TuneOver over;
        over.name = part.substr(0, equals);
        const Parameter* row = rowNamed(over.name);
        if (row == nullptr) {
            std::vector<std::string_view> names;
            for (const Parameter& each : parameters()) names.push_back(each.name);
            refuse(over.name, "the nearest name is '" + std::string(nearestName(over.name, names)) + "'");
        }
        if (std::ranges::any_of(result, [&](const TuneOver& o) { return o.name == over.name; }))
            refuse(part, "name each parameter once");
        if (over.name.starts_with("camera.")) refuse(part, "it changes what is seen: fix it with --set");
        if (equals == std::string::npos) {
            if (isWord(*row)) refuse(part, "give its words, such as " + over.name + "=on|off");
            if (row->tuning.high == 0.0) refuse(part, "it has no declared range: write " + over.name + "=LOW..HIGH");
        } else if (isWord(*row)) {
            readWords(over, *row, part.substr(equals + 1), part);
        } else {
            readRange(over, *row, part.substr(equals + 1), part);
        }
        result.push_back(std::move(over));
    }
    return result;
}

TuneGoal parseGoal(const std::string& text) {
    TuneGoal goal;
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const bool known = name == "time" || name == "error";
    if (!known || equals == std::string::npos || !parseNumber(text.substr(equals + 1), goal.value) ||
        !(goal.value > 0.0))
        throw Error(ErrorKind::Usage, "'" + text + "' is no goal", "--for", "write error=0.02 or time=30");
    goal.kind = name == "time" ? TuneGoal::Kind::Time : TuneGoal::Kind::Error;
    return goal;
}

std::string textOf(const SettingList& list) {
    std::string text;
    for (const auto& [name, value] : list) text += (text.empty() ? "" : "; ") + name + "=" + value;
    return text.empty() ? "default" : text;
}

void inTableOrder(SettingList& list) {
    std::ranges::stable_sort(list, {}, [](const auto& setting) { return rowNamed(setting.first); });
}

Settings withSettings(Settings settings, const SettingList& list) {
    for (const auto& [name, value] : list) setParameter(settings, name, value);
    return settings;
}

std::string Dimension::valueAt(double position) const {
    const double x = std::clamp(position, 0.0, 1.0);
    if (!words.empty())
        return words[std::min(words.size() - 1, static_cast<std::size_t>(x * static_cast<double>(words.size())))];
    double value = row->logScale ? low * std::pow(high / low, x) : std::lerp(low, high, x);
    if (const double step = row->tuning.step; step > 0.0)
        value = std::clamp(std::round(value / step) * step, low, high);
    return rounded(value, isWhole(*row));
}

double Dimension::positionOf(const std::string& value) const {
    if (!words.empty()) {
        const auto found = std::ranges::find(words, value);
        const auto index = static_cast<double>(found == words.end() ? 0 : found - words.begin());
        return (index + 0.5) / static_cast<double>(words.size());
    }
    if (value == kAutomatic) return 0.5;
    const double v = std::clamp(number(value), low, high);
    return row->logScale ? std::log(v / low) / std::log(high / low) : (v - low) / (high - low);
}

bool usesPass(const RenderRecord& plan, ParameterPass pass) {
    switch (pass) {
        case ParameterPass::CausticMap:
            return plan.resolved.causticMap == "on";
        case ParameterPass::Cache:
            return plan.resolved.cache == "on";
        case ParameterPass::GlobalMap:
            return plan.resolved.cache == "on" && plan.resolved.globalPhotons > 0;
        case ParameterPass::Any:
            break;
    }
    return true;
}

SearchSpace::SearchSpace(const std::vector<TuneOver>& over, const Settings& asked, const RenderRecord& plan,
                         bool glossy)
    : byPlan_(over.empty()) {
    for (const Parameter& row : parameters()) {
        const auto named = std::ranges::find(over, row.name, &TuneOver::name);
        if (named == over.end()) {
            // What a user has set stays set.
            const bool fixed = valueOf(asked, row.name) != valueOf(Settings{}, row.name);
            const bool idle = row.name == "surface.cast_roughness" && !glossy;
            if (!over.empty() || row.tuning.high == 0.0 || fixed || idle || !usesPass(plan, row.pass)) continue;
            dimensions_.push_back(declared(row, plan));
            continue;
        }
        Dimension d = declared(row, plan);
        if (named->high > 0.0 || !named->words.empty()) {
            d.low = named->low;
            d.high = named->high;
            d.words = named->words;
        }
        dimensions_.push_back(std::move(d));
    }
    if (dimensions_.empty())
        throw Error(ErrorKind::Usage, "there is nothing to tune: the plan uses neither caustic map nor cache", "--over",
                    "name a parameter and its range; `pellucid plan` tells what is left out and why");
}

Candidate SearchSpace::at(const std::vector<double>& coordinates, std::string origin) const {
    Candidate c;
    c.origin = std::move(origin);
    for (std::size_t i = 0; i < dimensions_.size(); ++i) {
        const Dimension& d = dimensions_[i];
        const bool free = d.row->automatic && d.words.empty();
        if (free && coordinates[i] < kAutomaticShare) continue;
        const double position = free ? (coordinates[i] - kAutomaticShare) / (1.0 - kAutomaticShare) : coordinates[i];
        c.set.emplace_back(d.row->name, d.valueAt(position));
    }
    return c;
}

std::vector<double> SearchSpace::positions(const Candidate& candidate) const {
    std::vector<double> x;
    for (const Dimension& d : dimensions_) {
        const auto set = std::ranges::find(candidate.set, std::string(d.row->name), &SettingList::value_type::first);
        x.push_back(d.positionOf(set == candidate.set.end() ? d.standard : set->second));
    }
    return x;
}

bool SearchSpace::contains(const Candidate& candidate) const {
    return std::ranges::all_of(candidate.set, [this](const auto& setting) {
        return std::ranges::any_of(dimensions_, [&](const Dimension& d) { return d.row->name == setting.first; });
    });
}

bool SearchSpace::allows(const Candidate& candidate) const { return byPlan_ || contains(candidate); }

std::vector<Candidate> peersSettings(const RenderRecord& plan, std::size_t pixels) {
    const std::string onePerPixel = std::to_string(pixels);
    // docs/tuning.md tells how each value was carried over.
    std::vector<Candidate> all{
        {"Radiance", {{"cache.error", "0.2"}, {"cache.rays", "640"}}},
        {"Mitsuba 0.6",
         {{"photon.caustic", "250000"},
          {"photon.global", "250000"},
          {"cache.error", "0.5"},
          {"cache.rays", "392"},
          {"cache.min_spacing", "3"},
          {"cache.max_spacing", "20"}}},
        {"POV-Ray", {{"cache.error", "1.8"}, {"cache.rays", "35"}}},
        {"pbrt-v2",
         {{"photon.caustic", "20000"},
          {"photon.global", "100000"},
          {"cache.error", "0.5"},
          {"cache.rays", "4096"},
          {"cache.min_spacing", "2.5"},
          {"cache.max_spacing", "15"}}},
        {"SPPM", {{"photon.caustic", onePerPixel}, {"photon.alpha", "0.667"}, {"cache.mode", "off"}}},
    };
    for (Candidate& c : all)
        std::erase_if(c.set, [&plan](const auto& setting) {
            const Parameter* row = rowNamed(setting.first);
            if (setting.first == "cache.mode") return !usesPass(plan, ParameterPass::Cache);
            return row == nullptr || !usesPass(plan, row->pass);
        });
    std::erase_if(all, [](const Candidate& c) { return c.set.empty(); });
    return all;
}

}  // namespace pellucid

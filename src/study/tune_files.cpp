#include "tune_files.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include <pellucid/study/text_table.h>

#include "study_json.h"

namespace pellucid {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kCurveSteps = 33;

[[nodiscard]] std::string unitOf(const TuneRequest& request) {
    return request.iterations > 0 ? "nominal seconds of 2 million rays" : "seconds";
}

[[nodiscard]] Json settingsJson(const SettingList& set) {
    Json json = Json::object();
    for (const auto& [name, value] : set) json[name] = value;
    return json;
}

[[nodiscard]] std::string valueIn(const SettingList& set, const Dimension& d) {
    for (const auto& [name, value] : set)
        if (name == d.row->name) return value;
    return d.standard;
}

/// The model's part of one parameter by its value, as a factor in relmse x cost relative to the default's value.
[[nodiscard]] Json curveJson(const TuneFindings& f, std::size_t i) {
    Json curve = Json::array();
    const Dimension& d = f.space.dimensions()[i];
    if (!f.search.model.valid() || !d.words.empty()) return curve;
    const double standard = f.search.model.part(i, d.positionOf(d.standard));
    for (int k = 0; k < kCurveSteps; ++k) {
        const double x = static_cast<double>(k) / (kCurveSteps - 1);
        curve.push_back({d.valueAt(x), std::exp(f.search.model.part(i, x) - standard)});
    }
    return curve;
}

[[nodiscard]] Json parametersJson(const TuneFindings& f) {
    Json json = Json::array();
    for (std::size_t i = 0; i < f.space.size(); ++i) {
        const Dimension& d = f.space.dimensions()[i];
        Json row{{"name", d.row->name}, {"help", d.row->help}, {"unit", d.row->unit}};
        if (d.words.empty())
            row.update({{"low", d.low}, {"high", d.high}, {"scale", d.row->logScale ? "log" : "linear"}});
        else
            row["words"] = d.words;
        row["automatic"] = d.words.empty() && !d.hasStandard();
        row["default"] = d.standard;
        row["tuned"] = valueIn(f.search.winner.candidate.set, d);
        const auto worth = std::ranges::find(f.search.worth, std::string(d.row->name), &Worth::name);
        if (worth != f.search.worth.end())
            row.update({{"worth", numberAs<Json>(std::exp(worth->gain))}, {"kept", worth->kept}});
        row["curve"] = curveJson(f, i);
        json.push_back(std::move(row));
    }
    return json;
}

[[nodiscard]] Json pointJson(const FrontPoint& p) {
    return {{"time", p.time},
            {"seeds", p.relmse.size()},
            {"seconds", intervalAs<Json>(p.seconds)},
            {"error", intervalAs<Json>(p.error)},
            {"relmse_cost_over_default", intervalAs<Json>(p.ratio)},
            {"on_front", p.onFront}};
}

[[nodiscard]] Json finalistsJson(const Front& front) {
    Json json = Json::array();
    for (const Finalist& f : front.finalists) {
        Json row{{"name", f.name},
                 {"origin", f.candidate.origin},
                 {"settings", settingsJson(f.candidate.set)},
                 {"may_win", f.mayWin}};
        row["points"] = Json::array();
        for (const FrontPoint& p : f.points)
            if (!p.relmse.empty()) row["points"].push_back(pointJson(p));
        json.push_back(std::move(row));
    }
    return json;
}

[[nodiscard]] Json paretoJson(const Front& front) {
    std::vector<std::pair<const Finalist*, const FrontPoint*>> points;
    for (const Finalist& f : front.finalists)
        for (const FrontPoint& p : f.points)
            if (p.onFront) points.emplace_back(&f, &p);
    std::ranges::stable_sort(points, {}, [](const auto& p) { return p.second->seconds.value; });
    Json json = Json::array();
    for (const auto& [f, p] : points)
        json.push_back({{"name", f->name},
                        {"settings", settingsJson(f->candidate.set)},
                        {"seconds", p->seconds.value},
                        {"error", intervalAs<Json>(p->error)}});
    return json;
}

[[nodiscard]] Json candidatesJson(const TuneFindings& f) {
    Json json = Json::array();
    for (const Contender& c : f.search.contenders) {
        Json factors = Json::array();
        for (int level = 0; level < c.levels; ++level)
            factors.push_back(std::exp(c.score[static_cast<std::size_t>(level)]));
        json.push_back({{"origin", c.candidate.origin},
                        {"settings", settingsJson(c.candidate.set)},
                        {"positions", f.space.positions(c.candidate)},
                        {"relmse_cost_over_default", factors}});
    }
    return json;
}

[[nodiscard]] std::string range(const Interval& i, double scale) {
    if (std::isnan(i.low) || std::isnan(i.high)) return figure(scale * i.value);
    return figure(scale * i.value) + " [" + figure(scale * i.low) + ", " + figure(scale * i.high) + "]";
}

[[nodiscard]] bool isWord(const std::string& value) {
    return value.empty() || value.find_first_not_of("0123456789.+-e") != std::string::npos;
}

/// A basic string of TOML.
[[nodiscard]] std::string quoted(const std::string& text) {
    std::string safe = "\"";
    for (const char c : printable(text)) safe += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    return safe + "\"";
}

[[nodiscard]] const FrontPoint& lastPoint(const Finalist& finalist) { return finalist.points.back(); }

}  // namespace

std::string frontJson(const TuneFindings& f) {
    const Finalist& chosen = f.front.finalists[f.choice.finalist];
    Json json{{"version", f.request.version},
              {"scene", std::filesystem::path(f.request.sceneFile).filename().string()},
              {"scene_hash", f.sceneHash},
              {"width", f.reference.mean.width()},
              {"height", f.reference.mean.height()},
              {"camera", f.request.camera},
              {"unit", unitOf(f.request)},
              {"time", f.request.time}};
    if (f.request.iterations > 0)
        json["iterations"] = f.request.iterations;
    else
        json["budget"] = f.request.budget;
    json.update(
        {{"rounds", f.search.rounds}, {"seed", f.request.seed}, {"seeds", f.front.seeds}, {"confidence", kConfidence}});
    json["reference"] = {{"file", f.reference.name}, {"remark", f.reference.remark}};
    json["goal"] = {{"kind", f.goal.kind == TuneGoal::Kind::Time ? "time" : "error"}, {"value", f.goal.value}};
    json["chosen"] = {{"name", chosen.name},
                      {"settings", settingsJson(chosen.candidate.set)},
                      {"seconds", numberAs<Json>(f.choice.seconds)},
                      {"error", numberAs<Json>(f.choice.error)},
                      {"reached", f.choice.reached}};
    json["front"] = paretoJson(f.front);
    json["finalists"] = finalistsJson(f.front);
    json["parameters"] = parametersJson(f);
    json["candidates"] = candidatesJson(f);
    return dumped(json);
}

std::string tunedToml(const TuneFindings& f) {
    const Finalist& chosen = f.front.finalists[f.choice.finalist];
    const std::string scene = printable(std::filesystem::path(f.request.sceneFile).filename().string());
    std::string text = "# Written by pellucid tune for " + scene + ". Use it with: pellucid render " + scene +
                       " --config tuned.toml --time " + figure(f.choice.seconds) + "\n";
    if (chosen.candidate.set.empty()) text += "# Nothing that was tried is surely better than the default.\n";
    text += "\n";
    const auto defaults = settingsAsText(Settings{});
    const auto own = settingsAsText(withSettings(f.request.settings, chosen.candidate.set));
    for (std::size_t i = 0; i < own.size(); ++i)
        if (own[i].second != defaults[i].second)
            text += own[i].first + " = " + (isWord(own[i].second) ? quoted(own[i].second) : own[i].second) + "\n";
    text += "\n[tuned]  # sets nothing: what was measured, and where\n";
    text += "scene = " + quoted(scene) + "\nscene_hash = " + quoted(f.sceneHash) + "\n";
    text += "width = " + std::to_string(f.reference.mean.width()) +
            "\nheight = " + std::to_string(f.reference.mean.height()) + "\n";
    text += "camera = " + quoted(f.request.camera) + "\nsettings = " + quoted(chosen.name) + "\n";
    text += "seconds = " + figure(f.choice.seconds) + "\nerror = " + figure(f.choice.error) + "\n";
    text += "seconds_are = " + quoted(unitOf(f.request)) + "\nseeds = " + std::to_string(f.front.seeds) + "\n";
    const Interval& ratio = lastPoint(chosen).ratio;
    text += "time_over_default = " + figure(lastPoint(chosen).relmse.empty() ? 1.0 : ratio.value) + "\n";
    text += "version = " + quoted(f.request.version) + "\n";
    return text;
}

std::string tuneText(const TuneFindings& f) {
    const Finalist& chosen = f.front.finalists[f.choice.finalist];
    TextTable table({"settings", "seconds", "error, %", "time for the default's error"});
    for (const Finalist& finalist : f.front.finalists)
        for (const FrontPoint& p : finalist.points)
            if (!p.relmse.empty())
                table.add({finalist.name + (p.onFront ? " *" : ""), figure(p.seconds.value), range(p.error, 100.0),
                           range(p.ratio, 1.0)});
    std::string text = table.text() + "* on the front\n\n";
    for (const Worth& w : f.search.worth)
        text +=
            w.name + (w.kept ? ": without it the tuned settings need " + figure(std::exp(w.gain)) + " times the time\n"
                             : ": taken back, it gained too little (" + figure(std::exp(w.gain)) + ")\n");
    if (!f.choice.reached)
        text += "No settings reach an error of " + figure(100.0 * f.goal.value) +
                " % within the measured times; nearest are:\n";
    text += "tuned.toml: " + chosen.name + ", " + textOf(chosen.candidate.set) + "\n";
    if (!f.reference.remark.empty()) text += "note: " + printable(f.reference.remark) + "\n";
    return text;
}

}  // namespace pellucid

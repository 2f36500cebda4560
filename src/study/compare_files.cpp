#include "compare_files.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include <pellucid/study/record_json.h>
#include <pellucid/study/text_table.h>

#include "study_json.h"

namespace pellucid {
namespace {

using Json = nlohmann::ordered_json;

[[nodiscard]] Json interval(const Interval& value) { return intervalAs<Json>(value); }

[[nodiscard]] Json classesJson(const std::vector<ClassFigures>& classes) {
    Json json = Json::object();
    for (const ClassFigures& c : classes)
        json[c.name] = {
            {"relmse", interval(c.relmse)}, {"bias2", interval(c.bias2)}, {"variance", interval(c.variance)}};
    return json;
}

[[nodiscard]] Json pointJson(const PointFigures& p) {
    Json stages = Json::array();
    for (const auto& [name, seconds] : p.stages) stages.push_back({{"name", name}, {"seconds", seconds}});
    return {{"budget", p.budget},
            {"seeds", p.seeds},
            {"seconds", interval(p.seconds)},
            {"relmse", interval(p.relmse)},
            {"relmse_trimmed", interval(p.relmseTrimmed)},
            {"rmse", interval(p.rmse)},
            {"smape", interval(p.smape)},
            {"flip", interval(p.flip)},
            {"bias", interval(p.bias)},
            {"bias2", interval(p.bias2)},
            {"variance", interval(p.variance)},
            {"bias2_absolute", interval(p.bias2Absolute)},
            {"variance_absolute", interval(p.varianceAbsolute)},
            {"efficiency", interval(p.efficiency)},
            {"peak_rss_bytes", p.peakRssBytes},
            {"stages", stages},
            {"classes", classesJson(p.classes)}};
}

/// A time that is not reached is null with its status; the low end may be finite all the same.
[[nodiscard]] Json timeJson(const MethodFigures& method, std::size_t target) {
    const Interval& time = method.timeToError[target];
    std::string status = "reached";
    if (std::isnan(time.value))
        status = "unknown";
    else if (std::isinf(time.value))
        status = "not reached";
    else if (time.value == method.points.front().seconds.value)
        status = "at the first budget or before";
    Json json{{"error", kTargetErrors[target]}, {"seconds", numberAs<Json>(time.value)}};
    json["low"] = numberAs<Json>(time.low);
    json["high"] = numberAs<Json>(time.high);
    json["status"] = status;
    return json;
}

[[nodiscard]] Json methodJson(const CompareMethod& asked, const MethodFigures& method) {
    Json json{{"method", method.label}, {"integrator", methodName(asked.method)}, {"settings", Json::object()}};
    const auto defaults = settingsAsText(Settings{}), own = settingsAsText(asked.settings);
    for (std::size_t i = 0; i < own.size(); ++i)
        if (own[i].second != defaults[i].second) json["settings"][own[i].first] = own[i].second;
    if (!method.points.empty()) {  // at the longest budget, for those who want one figure
        json["relmse"] = interval(method.points.back().relmse);
        json["bias2"] = interval(method.points.back().bias2);
        json["variance"] = interval(method.points.back().variance);
    }
    json["slope"] = interval(method.slope);
    json["time_to_error"] = Json::array();
    for (std::size_t i = 0; i < method.timeToError.size() && !method.points.empty(); ++i)
        json["time_to_error"].push_back(timeJson(method, i));
    json["points"] = Json::array();
    for (const PointFigures& point : method.points) json["points"].push_back(pointJson(point));
    return json;
}

[[nodiscard]] Json pairsJson(const std::vector<PairFigures>& pairs) {
    Json json = Json::array();
    for (const PairFigures& pair : pairs)
        json.push_back({{"a", pair.a},
                        {"b", pair.b},
                        {"budget", pair.budget},
                        {"relmse_ratio", interval(pair.ratio)},
                        {"p", pair.p},
                        {"p_adjusted", pair.pAdjusted},
                        {"significant", pair.significant()}});
    return json;
}

[[nodiscard]] Json runRow(const StoredRun& run) {
    Json row{{"method", run.key.label}, {"seconds", run.seconds}, {"seed", run.key.seed}, {"budget", run.key.budget}};
    row.update(metricsAs<Json>(run.metrics->whole));
    row["error_estimate"] = numberAs<Json>(run.errorEstimate);
    row["iterations"] = run.iterations;
    row["samples_per_pixel"] = run.samplesPerPixel;
    row["threads"] = run.threads;
    row["peak_rss_bytes"] = run.peakRssBytes;
    row["classes"] = Json::object();
    for (const auto& [name, relmse] : run.metrics->classRelmse)
        row["classes"][name] = {{"relmse", numberAs<Json>(relmse)}};
    row["stages"] = stagesAs<Json>(run.stages);
    row["image"] = run.image.generic_string();
    return row;
}

/// By method as asked, budget, seed: the order of the runs does not depend on what was finished when.
[[nodiscard]] std::vector<const StoredRun*> sorted(const CompareRequest& request, const CompareRuns& runs) {
    std::vector<const StoredRun*> order;
    for (const CompareMethod& method : request.methods)
        for (const double budget : request.times)
            for (const StoredRun* run : runsOf(runs, method.label, budget)) order.push_back(run);
    return order;
}

[[nodiscard]] std::string csvText(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

[[nodiscard]] std::string range(const Interval& i, double scale = 1.0) {
    if (!std::isfinite(i.value)) return "-";
    const std::string value = figure(scale * i.value);
    if (std::isnan(i.low) || std::isnan(i.high)) return value;
    return value + " [" + figure(scale * i.low) + ", " + (std::isfinite(i.high) ? figure(scale * i.high) : "inf") + "]";
}

[[nodiscard]] int fewestSeeds(const CompareFigures& figures) {
    int fewest = std::numeric_limits<int>::max();
    for (const MethodFigures& method : figures.methods)
        for (const PointFigures& point : method.points) fewest = std::min(fewest, point.seeds);
    return fewest;
}

}  // namespace

std::string curvesJson(const CompareRequest& request, const CompareRuns& runs) {
    Json json = Json::array();
    for (const StoredRun* run : sorted(request, runs)) json.push_back(runRow(*run));
    return dumped(json);
}

std::string curvesCsv(const CompareRequest& request, const CompareRuns& runs) {
    std::string text =
        "method,seconds,seed,budget,rmse,relmse,relmse_trimmed,smape,flip,bias,nonfinite,error_estimate,iterations,"
        "samples_per_pixel,threads,peak_rss_bytes,relmse_direct,relmse_caustic,relmse_indirect,image\n";
    for (const StoredRun* run : sorted(request, runs)) {
        const Json row = runRow(*run);
        text += csvText(run->key.label);
        for (const char* name :
             {"seconds", "seed", "budget", "rmse", "relmse", "relmse_trimmed", "smape", "flip", "bias", "nonfinite",
              "error_estimate", "iterations", "samples_per_pixel", "threads", "peak_rss_bytes"})
            text += "," + (row.at(name).is_null() ? "" : row.at(name).dump());
        for (const std::string_view name : kMeasuredClasses) {
            const auto found = run->metrics->classRelmse.find(std::string(name));
            text += "," + (found == run->metrics->classRelmse.end() ? "" : Json(found->second).dump());
        }
        text += "," + csvText(run->image.generic_string()) + "\n";
    }
    return text;
}

std::string summaryJson(const CompareRequest& request, const CompareRuns& runs, const CompareReference& reference,
                        const CompareFigures& figures) {
    Json json{{"version", request.version},
              {"scene", request.sceneFile},
              {"scene_hash", runs.sceneHash},
              {"environment", request.environment},
              {"camera", request.camera},
              {"width", runs.width},
              {"height", runs.height},
              {"threads", runs.runs.empty() ? 0 : runs.runs.front().threads},
              {"seeds", request.seeds},
              {"first_seed", request.firstSeed},
              {"times", request.times},
              {"confidence", kConfidence},
              {"command", request.command},
              {"runs", runs.runs.size()},
              {"runs_missing", request.methods.size() * request.times.size() * static_cast<std::size_t>(request.seeds) -
                                   runs.runs.size()}};
    json["reference"] = {{"file", reference.file},
                         {"made", reference.made},
                         {"good_enough", reference.goodEnough},
                         {"noise_relmse", numberAs<Json>(reference.noise)},
                         {"seconds", reference.seconds},
                         {"blind_spots", reference.blindSpots},
                         {"remark", reference.remark}};
    json["methods"] = Json::array();
    for (std::size_t i = 0; i < figures.methods.size(); ++i)
        json["methods"].push_back(methodJson(request.methods[i], figures.methods[i]));
    json["comparisons"] = pairsJson(figures.pairs);
    json["seeds_needed"] = seedsNeeded(figures.pairs.size());
    return dumped(json);
}

std::string compareTable(const CompareReference& reference, const CompareFigures& figures) {
    TextTable table({"method", "seconds", "error, %", "relmse", "trimmed", "bias^2", "variance", "flip"});
    for (const MethodFigures& method : figures.methods)
        for (const PointFigures& p : method.points)
            table.add({method.label, figure(p.seconds.value), figure(100.0 * std::sqrt(p.relmse.value)),
                       range(p.relmse), figure(p.relmseTrimmed.value), range(p.bias2), range(p.variance),
                       figure(p.flip.value)});
    TextTable times({"method", "slope", "s to 10 %", "s to 5 %", "s to 2 %", "s to 1 %"});
    for (const MethodFigures& method : figures.methods) {
        std::vector<std::string> row{method.label, range(method.slope)};
        for (const Interval& time : method.timeToError) row.push_back(range(time));
        times.add(std::move(row));
    }
    std::string text = table.text() + "\n" + times.text();
    double longest = 0.0;
    for (const PairFigures& pair : figures.pairs) longest = std::max(longest, pair.budget);
    for (const PairFigures& pair : figures.pairs)
        if (pair.significant() && pair.budget == longest)
            text += "\n" + figure(pair.budget) + " s: relmse of " + pair.a + " is " + range(pair.ratio) +
                    " times that of " + pair.b + " (p = " + figure(pair.pAdjusted) + " after Holm)";
    if (const int needed = seedsNeeded(figures.pairs.size()); fewestSeeds(figures) < needed)
        text += "\nnote: " + std::to_string(figures.pairs.size()) + " comparisons need --seeds " +
                std::to_string(needed) + " before a difference can be told from chance";
    if (!reference.remark.empty()) text += "\nnote: " + printable(reference.remark);
    return text + (text.ends_with('\n') ? "" : "\n");
}

}  // namespace pellucid

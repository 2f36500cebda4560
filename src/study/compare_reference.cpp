// The reference of a comparison: given as a file, or made until it is good enough.
#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include <pellucid/base/error.h>
#include <pellucid/io/image_file.h>
#include <pellucid/io/plain_file.h>
#include <pellucid/study/diff_report.h>
#include <pellucid/study/text_table.h>

#include "compare_runs.h"
#include "study_json.h"

namespace pellucid {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kWantedShare = 0.1;         // of the best competitor's error
constexpr double kLongestTimesBudget = 100;  // a tenth of the error costs 100 times the time at 1/sqrt(t)
constexpr std::uint64_t kReferenceSeed = 0x5265666572656e63ULL;  // far from the runs' seeds: independent of them

/// What is known of DIR/reference.exr; `key` tells whether it is of this scene and size.
struct ReferenceState {
    std::string key;
    double seconds = 0.0, error = std::numeric_limits<double>::infinity();
    std::vector<std::string> blindSpots;
};

[[nodiscard]] std::string keyText(const CompareRequest& request, const CompareRuns& runs) {
    std::string key = "pellucid " + request.version + ", scene " + runs.sceneHash + ", " + std::to_string(runs.width) +
                      "x" + std::to_string(runs.height) + ", camera '" + request.camera + "'";
    for (const auto& [name, value] : settingsAsText(request.settings)) key += ", " + name + "=" + value;
    return key;
}

[[nodiscard]] ReferenceState readState(const std::filesystem::path& file, const std::string& key) {
    ReferenceState fresh;
    fresh.key = key;
    return readKeyed<Json>(file, key, fresh, [&key](const Json& json) -> ReferenceState {
        return {key, json.at("seconds").get<double>(), json.at("error_estimate").get<double>(),
                json.at("blind_spots").get<std::vector<std::string>>()};
    });
}

void writeState(const std::filesystem::path& file, const ReferenceState& state) {
    writeFile(file, dumped(Json{{"key", state.key},
                                {"seconds", state.seconds},
                                {"error_estimate", numberAs<Json>(state.error)},
                                {"blind_spots", state.blindSpots}}));
}

/// The smallest root of relmse of any run, the reference's own noise taken off.
[[nodiscard]] double bestError(const Image& reference, double noise, const CompareRuns& runs, const RunStore& store,
                               const Workers& workers) {
    double longest = 0.0;
    for (const StoredRun& run : runs.runs) longest = std::max(longest, run.key.budget);
    std::vector<double> relmse(runs.runs.size(), std::numeric_limits<double>::infinity());
    workers.forEach(relmse.size(), 1, [&](std::size_t i) {
        if (runs.runs[i].key.budget == longest)
            relmse[i] = compareImages(reference, store.readImage(runs.runs[i]), false).relmse;
    });
    const double best = relmse.empty() ? std::numeric_limits<double>::infinity() : *std::ranges::min_element(relmse);
    return std::sqrt(std::max(0.0, best - noise));
}

/// Renders for `seconds` more, from the checkpoint on.
[[nodiscard]] RenderResult renderMore(const CompareRequest& request, const LoadedScene& loaded, const CompareRuns& runs,
                                      const RunStore& store, double seconds, const Workers& workers,
                                      const Progress& progress, const LogSink& log) {
    RenderRequest render;
    render.method = Method::Reference;
    render.width = runs.width;
    render.height = runs.height;
    render.camera = request.camera;
    render.seed = kReferenceSeed;
    render.budget.seconds = seconds;
    render.settings = request.settings;
    render.layers = {"variance"};
    render.checkpoint = store.folder() / "reference.state";
    render.resume = std::filesystem::exists(render.checkpoint);
    return pellucid::render(loaded.scene, render, workers, progress, log);
}

/// What the reference is expected to take in all, at most `limit` seconds: its error falls as 1/sqrt(t).
[[nodiscard]] double expectedSeconds(const ReferenceState& state, double best, double limit) {
    if (!(state.seconds > 0.0) || !std::isfinite(state.error) || !(best > 0.0)) return limit;
    return std::min(limit, state.seconds * std::pow(state.error / (kWantedShare * best), 2));
}

/// From a part of `seconds` of the reference's time to the whole reference.
[[nodiscard]] Progress referenceProgress(const Progress& progress, const ReferenceState& state, double best,
                                         double limit, double seconds) {
    Progress inner;
    inner.interrupted = progress.interrupted;
    if (!progress.report) return inner;
    std::string stage = "reference";
    if (std::isfinite(state.error))
        stage += " (its error " + figure(100.0 * state.error) + " %, wanted " +
                 (best > 0.0 ? figure(100.0 * kWantedShare * best) + " %" : "less") + ")";
    const double done = state.seconds, whole = std::max(expectedSeconds(state, best, limit), done + seconds);
    inner.report = [&progress, stage, done, whole, seconds](ProgressReport report) {
        const double spent = done + std::clamp(report.fraction, 0.0, 1.0) * seconds;
        report.stage = stage;
        report.fraction = spent / whole;
        report.secondsLeft = whole - spent;
        progress.report(report);
    };
    return inner;
}

[[nodiscard]] std::string remarkOn(const CompareReference& reference, double error, double best) {
    std::string remark;
    if (!reference.goodEnough)
        remark = "the reference could not be made good enough: its own error is " + figure(100.0 * error) +
                 " % after " + duration(reference.seconds) + ", the best run's " +
                 (best > 0.0 ? "is " + figure(100.0 * best) + " %" : "cannot be told from it") +
                 "; give --reference FILE or a longer --reference-time";
    for (const std::string& blind : reference.blindSpots)
        remark += (remark.empty() ? "" : "; ") + ("the reference cannot see: " + blind);
    return remark;
}

}  // namespace

CompareReference loadReference(const std::filesystem::path& file) {
    CompareReference reference;
    reference.image = readImage(file);
    reference.file = file.string();
    reference.hash = imageHash(reference.image);
    reference.noise = referenceNoise(reference.image).value_or(std::numeric_limits<double>::quiet_NaN());
    if (!std::isfinite(reference.noise))
        reference.remark = "the reference has no layers variance.*: its own noise is unknown and counts as bias^2";
    return reference;
}

CompareReference makeReference(const CompareRequest& request, const SceneSource& scenes, const CompareRuns& runs,
                               const RunStore& store, const Workers& workers, const Progress& progress,
                               const LogSink& log) {
    const std::filesystem::path file = store.folder() / "reference.exr", stateFile = store.folder() / "reference.json";
    ReferenceState state = readState(stateFile, keyText(request, runs));
    if (state.seconds == 0.0) std::filesystem::remove(store.folder() / "reference.state");  // of another scene or size
    const double limit =
        request.referenceTime > 0.0 ? request.referenceTime : kLongestTimesBudget * request.times.back();
    CompareReference reference;
    if (state.seconds > 0.0 && std::filesystem::exists(file)) reference.image = readImage(file);
    double best = 0.0;
    while (true) {
        if (reference.image.pixels() > 0)
            best = bestError(reference.image, state.error * state.error, runs, store, workers);
        reference.goodEnough = reference.image.pixels() > 0 && state.error <= kWantedShare * best;
        const double left = limit - state.seconds;
        if (reference.goodEnough || left < 0.01 * limit || progress.stopAsked()) break;
        const double more = std::min(left, std::max(state.seconds, request.times.back()));
        const RenderResult result = renderMore(request, scenes(request.settings), runs, store, more, workers,
                                               referenceProgress(progress, state, best, limit, more), log);
        reference.image = result.image;
        state.seconds += result.record.seconds;
        state.error = result.record.errorEstimate;
        state.blindSpots = result.record.blindSpots;
        writeExr(file, reference.image, {{"pellucid.version", request.version}, {"pellucid.method", "reference"}});
        writeState(stateFile, state);
    }
    if (reference.image.pixels() > 0) reference.image = readImage(file);  // the order of channels is the file's
    reference.made = true;
    reference.file = file.string();
    reference.hash = imageHash(reference.image);
    reference.noise = state.error * state.error;
    reference.seconds = state.seconds;
    reference.blindSpots = state.blindSpots;
    reference.remark = remarkOn(reference, state.error, best);
    return reference;
}

}  // namespace pellucid

#include <pellucid/study/compare.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <nlohmann/json.hpp>

#include <pellucid/base/error.h>
#include <pellucid/io/image_file.h>
#include <pellucid/io/plain_file.h>
#include <pellucid/study/report.h>

#include "compare_files.h"
#include "study_json.h"

namespace pellucid {
namespace {

using Json = nlohmann::ordered_json;
using Runs = std::vector<const StoredRun*>;

/// The size of the reference is the size of the runs, unless one is asked for, which must then be the same.
[[nodiscard]] CompareRequest withReferenceSize(CompareRequest request, const Image& reference) {
    if (request.width == 0 && request.height == 0) {
        request.width = reference.width();
        request.height = reference.height();
    }
    if (request.width != reference.width() || (request.height != 0 && request.height != reference.height()))
        throw Error(ErrorKind::BadInput,
                    "the reference is " + std::to_string(reference.width()) + "x" + std::to_string(reference.height()),
                    request.reference.string(), "leave out --size, or give the reference's");
    return request;
}

/// The run whose error is the median of its seeds: neither luck nor mishap.
[[nodiscard]] const StoredRun& typicalRun(Runs runs) {
    const auto middle = runs.begin() + static_cast<std::ptrdiff_t>((runs.size() - 1) / 2);
    std::ranges::nth_element(runs, middle, [](const StoredRun* a, const StoredRun* b) {
        return a->metrics->whole.relmse < b->metrics->whole.relmse;
    });
    return **middle;
}

/// The reference, then the pictures of each budget from the longest: the page takes what fits.
void addPictures(ReportData& data, const CompareRequest& request, const CompareRuns& runs,
                 const CompareReference& reference, const RunStore& store) {
    data.pictures.push_back({"reference", 0.0, 0, reference.image});
    std::size_t bytes = 0;
    for (auto budget = request.times.rbegin(); budget != request.times.rend(); ++budget)
        for (const CompareMethod& method : request.methods) {
            const Runs cell = runsOf(runs, method.label, *budget);
            // More than this cannot fit, however packed; the last budget is never left out.
            if (cell.empty() || (bytes > kReportBytes && *budget != request.times.back())) continue;
            const StoredRun& run = typicalRun(cell);
            data.pictures.push_back({method.label, *budget, run.key.seed, store.readImage(run)});
            bytes += data.pictures.back().image.pixels() * 3 * sizeof(std::uint16_t);
        }
}

/// maps/METHOD_BUDGETs.exr with the channels bias.Y and deviation.Y.
void writeMaps(const RunStore& store, const RunKey& key, const SeedMaps& maps) {
    Image both(maps.bias.width(), maps.bias.height(), {"bias.Y", "deviation.Y"});
    for (std::size_t i = 0; i < both.pixels(); ++i) {
        both.at(i, 0) = maps.bias.at(i, 0);
        both.at(i, 1) = maps.deviation.at(i, 0);
    }
    const std::filesystem::path folder = store.folder() / "maps";
    std::filesystem::create_directories(folder);
    writeExr(folder / (key.series() + ".exr"), both, {{"pellucid.method", key.label}});
}

/// Maps at the longest budget.
void addMaps(ReportData& data, const CompareRequest& request, const CompareRuns& runs,
             const CompareReference& reference, const RunStore& store, const Workers& workers) {
    for (const CompareMethod& method : request.methods) {
        const Runs cell = runsOf(runs, method.label, request.times.back());
        if (cell.size() < 2) continue;
        std::vector<Image> images(cell.size());
        workers.forEach(cell.size(), 1, [&](std::size_t i) { images[i] = store.readImage(*cell[i]); });
        SeedMaps maps = seedMaps(reference.image, images);
        writeMaps(store, cell.front()->key, maps);
        data.maps.push_back({method.label, "bias", request.times.back(), std::move(maps.bias)});
        data.maps.push_back({method.label, "deviation", request.times.back(), std::move(maps.deviation)});
    }
}

/// Plan, settings and blind spots of every run; runs of the same plan share a row.
[[nodiscard]] std::string runsJson(const CompareRequest& request, const CompareRuns& runs) {
    Json json = Json::array();
    for (const CompareMethod& method : request.methods)
        for (const double budget : request.times)
            for (const StoredRun* run : runsOf(runs, method.label, budget)) {
                Json settings = Json::object();
                for (const auto& [name, value] : run->resolved) settings[name] = value;
                const Json plan = decisionsAs<Json>(run->decisions);
                const auto same = std::ranges::find_if(json, [&](const Json& row) {
                    return row["method"] == method.label && row["plan"] == plan && row["settings"] == settings;
                });
                const Json which{{"budget", budget}, {"seed", run->key.seed}};
                if (same != json.end())
                    (*same)["runs"].push_back(which);
                else
                    json.push_back({{"method", method.label},
                                    {"runs", Json::array({which})},
                                    {"plan", plan},
                                    {"settings", settings},
                                    {"blind_spots", run->blindSpots}});
            }
    return dumped(json, -1);
}

void writeReport(const CompareRequest& request, const CompareRuns& runs, const CompareReference& reference,
                 const RunStore& store, const Workers& workers, const std::string& summary, const std::string& curves) {
    ReportData data;
    data.title = std::filesystem::path(request.sceneFile).filename().string();
    data.summaryJson = summary;
    data.curvesJson = curves;
    data.runsJson = runsJson(request, runs);
    addPictures(data, request, runs, reference, store);
    addMaps(data, request, runs, reference, store, workers);
    writeFile(store.folder() / "report.html", reportHtml(data));
}

[[nodiscard]] CompareReference referenceFor(const CompareRequest& request, const SceneSource& scenes,
                                            const CompareRuns& runs, const RunStore& store, const Workers& workers,
                                            const Progress& progress, const LogSink& log) {
    if (!request.reference.empty()) return loadReference(request.reference);
    return makeReference(request, scenes, runs, store, workers, progress, log);
}

/// The time elapsed is that of the whole comparison.
[[nodiscard]] Progress sinceStart(const Progress& progress, std::chrono::steady_clock::time_point start) {
    Progress whole = progress;
    if (progress.report)
        whole.report = [&progress, start](ProgressReport report) {
            report.secondsElapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            progress.report(report);
        };
    return whole;
}

}  // namespace

CompareOutcome compare(const CompareRequest& asked, const SceneSource& scenes, const Workers& workers,
                       const Progress& progress, const LogSink& log) {
    const auto start = std::chrono::steady_clock::now();
    CompareRequest request = asked;
    // A reference that cannot be read or does not fit is told before hours of rendering.
    if (!request.reference.empty()) request = withReferenceSize(request, loadReference(request.reference).image);
    const RunStore store(request.folder);
    CompareRuns runs = renderRuns(request, scenes, store, workers, progress, log);
    CompareOutcome outcome;
    outcome.interrupted = runs.interrupted;
    outcome.finished = runs.runs.size();
    outcome.asked = request.methods.size() * request.times.size() * static_cast<std::size_t>(request.seeds);
    if (runs.runs.empty()) return outcome;
    const CompareReference reference =
        referenceFor(request, scenes, runs, store, workers, sinceStart(progress, start), log);
    outcome.interrupted = outcome.interrupted || progress.stopAsked();
    if (reference.image.pixels() == 0) return outcome;  // interrupted before there was one: the runs are kept
    if (!reference.remark.empty()) logTo(log, LogLevel::Warning, reference.remark);
    measureRuns(runs, reference, store, workers);
    const CompareFigures figures = analyse(request, runs, reference, store, workers);
    const std::string curves = curvesJson(request, runs), summary = summaryJson(request, runs, reference, figures);
    writeFile(store.folder() / "curves.json", curves);
    writeFile(store.folder() / "curves.csv", curvesCsv(request, runs));
    writeFile(store.folder() / "summary.json", summary);
    writeReport(request, runs, reference, store, workers, summary, curves);
    outcome.table = compareTable(reference, figures);
    outcome.table += "\nreport: " + (store.folder() / "report.html").string() + "\n";
    return outcome;
}

}  // namespace pellucid

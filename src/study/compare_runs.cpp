#include "compare_runs.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>

#include <pellucid/study/record_json.h>
#include <pellucid/study/text_table.h>

#include "peak_memory.h"

namespace pellucid {
namespace {

/// A run that is to be: its key and what it takes to render it.
struct RunTask {
    RunKey key;
    const CompareMethod* method;
};

/// Budgets that differ in their twelfth digit only are still two.
[[nodiscard]] std::string exactFigure(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.12g", value);
    return text;
}

[[nodiscard]] std::string keyText(const CompareRequest& request, const CompareMethod& method, const RunKey& key,
                                  const std::string& sceneHash, int width, int height, int threads) {
    std::string settings;
    for (const auto& [name, value] : settingsAsText(method.settings)) settings += name + "=" + value + ";";
    return "pellucid " + request.version + ", scene " + sceneHash + ", method " + methodName(method.method) +
           ", settings " + hashText(settings) + ", " + std::to_string(width) + "x" + std::to_string(height) +
           ", camera '" + request.camera + "', threads " + std::to_string(threads) + ", budget " +
           exactFigure(key.budget) + " s, seed " + std::to_string(key.seed);
}

[[nodiscard]] RenderRequest renderRequest(const CompareRequest& request, const RunTask& task, int width, int height,
                                          double loadSeconds) {
    RenderRequest render;
    render.method = task.method->method;
    render.width = width;
    render.height = height;
    render.camera = request.camera;
    render.seed = task.key.seed;
    render.budget.seconds = task.key.budget;
    render.budget.startedSecondsAgo = loadSeconds;
    render.settings = task.method->settings;
    return render;
}

[[nodiscard]] StoredRun storedRun(const RunKey& key, const RenderRecord& record) {
    StoredRun run;
    run.key = key;
    run.seconds = record.seconds;
    run.errorEstimate = record.errorEstimate;
    run.iterations = record.iterations;
    run.samplesPerPixel = record.samplesPerPixel;
    run.peakRssBytes = peakMemoryBytes();
    run.nonfinite = record.nonfinite.count;
    run.threads = record.threads;
    run.stages = record.stages;
    run.decisions = record.decisions;
    run.blindSpots = record.blindSpots;
    run.resolved = settingsAsText(record.resolved);
    return run;
}

/// Progress of the whole comparison from that of one run: budgets are what the time left is known from.
class WholeProgress {
public:
    WholeProgress(const Progress& progress, double total) : progress_(progress), total_(total) {}

    [[nodiscard]] Progress during(const RunTask& task, std::size_t number, std::size_t count) const {
        Progress inner;
        inner.interrupted = progress_.interrupted;
        if (!progress_.report) return inner;
        const std::string stage = "run " + std::to_string(number) + " of " + std::to_string(count) + " (" +
                                  task.key.label + ", " + figure(task.key.budget) + " s, seed " +
                                  std::to_string(task.key.seed) + ")";
        inner.report = [this, stage, budget = task.key.budget](const ProgressReport& report) {
            tell(stage, done_ + std::clamp(report.fraction, 0.0, 1.0) * budget, report.samplesPerSecond);
        };
        return inner;
    }
    void finished(const RunTask& task) { done_ += task.key.budget; }

private:
    void tell(const std::string& stage, double done, double rate) const {
        ProgressReport whole;
        whole.stage = stage;
        whole.fraction = total_ > 0.0 ? done / total_ : 1.0;
        whole.secondsElapsed = std::chrono::duration<double>(Clock::now() - start_).count();
        whole.secondsLeft = done > 0.0 ? whole.secondsElapsed * (total_ / done - 1.0) : total_;
        whole.samplesPerSecond = rate;
        progress_.report(whole);
    }
    using Clock = std::chrono::steady_clock;
    const Progress& progress_;
    double total_, done_ = 0.0;
    Clock::time_point start_ = Clock::now();
};

}  // namespace

CompareRuns renderRuns(const CompareRequest& request, const SceneSource& scenes, const RunStore& store,
                       const Workers& workers, const Progress& progress, const LogSink& log) {
    CompareRuns result;
    std::vector<RunTask> open;
    double openSeconds = 0.0;
    for (int k = 0; k < request.seeds; ++k)
        for (const double budget : request.times)
            for (const CompareMethod& method : request.methods) {
                const Scene& scene = scenes(method.settings).scene;
                if (result.sceneHash.empty()) {
                    const Camera camera = scene.camera(request.camera, request.width, request.height);
                    result.sceneHash = scenes(request.settings).scene.hash();
                    result.width = camera.width();
                    result.height = camera.height();
                }
                RunKey key{method.label, "", budget, request.firstSeed + static_cast<std::uint64_t>(k)};
                key.text = keyText(request, method, key, scene.hash(), result.width, result.height, workers.threads());
                if (auto run = store.find(key)) {
                    result.runs.push_back(std::move(*run));
                } else {
                    open.push_back({key, &method});
                    openSeconds += budget;
                }
            }
    if (!result.runs.empty())
        logTo(log, LogLevel::Info, std::to_string(result.runs.size()) + " runs are finished already");
    WholeProgress whole(progress, openSeconds);
    for (const RunTask& task : open) {
        if ((result.interrupted = progress.stopAsked())) break;
        const LoadedScene loaded = scenes(task.method->settings);
        resetPeakMemory();
        const RenderResult rendered =
            render(loaded.scene, renderRequest(request, task, result.width, result.height, loaded.loadSeconds), workers,
                   whole.during(task, result.rendered + 1, open.size()), log);
        if ((result.interrupted = rendered.interrupted)) break;
        StoredRun run = storedRun(task.key, rendered.record);
        store.save(run, rendered.image,
                   {{"pellucid.version", request.version},
                    {"pellucid.run", task.key.text},
                    {"pellucid.method", task.key.label},
                    {"pellucid.seconds", figure(run.seconds)}});
        result.runs.push_back(std::move(run));
        ++result.rendered;
        whole.finished(task);
    }
    return result;
}

}  // namespace pellucid

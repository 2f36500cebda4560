// `pellucid render`: check the outputs, load, render, write. Loading counts against a budget of time.
#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include <pellucid/base/error.h>
#include <pellucid/io/image_file.h>
#include <pellucid/io/plain_file.h>
#include <pellucid/study/record_json.h>
#include <pellucid/study/text_table.h>

#include "commands.h"
#include "process.h"
#include "scene_loading.h"
#include "terminal.h"
#include "terminal_progress.h"

namespace pellucid {
namespace {

constexpr int kInterrupted = 130;

[[nodiscard]] double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A render that took an hour must not end with a file that cannot be written.
void checkOutputs(const RenderArguments& arguments) {
    for (const std::string& file : arguments.outputs) checkFolderWritable(file);
    for (const std::string& file : {arguments.record, arguments.checkpoint})
        if (!file.empty()) checkFolderWritable(file);
}

[[nodiscard]] RenderResult renderWithProgress(const Scene& scene, const RenderRequest& request, const Workers& workers,
                                              bool quiet) {
    TerminalProgress terminal(quiet);
    const LogSink print = terminalLog(quiet);
    const LogSink log = [&](LogLevel level, std::string_view message) {
        terminal.clear();
        logTo(print, level, message);
    };
    Progress progress;
    progress.report = [&terminal](const ProgressReport& report) { terminal.report(report); };
    progress.interrupted = interruptAsked;
    catchInterrupts();
    return render(scene, request, workers, progress, log);
}

[[nodiscard]] ImageMetadata metadataOf(const RecordContext& context, const RenderRecord& record) {
    ImageMetadata metadata{{"pellucid.version", context.version},
                           {"pellucid.scene", std::filesystem::path(context.sceneFile).filename().string()},
                           {"pellucid.scene_hash", context.sceneHash},
                           {"pellucid.method", methodName(context.method)},
                           {"pellucid.seed", std::to_string(context.seed)},
                           {"pellucid.samples", std::to_string(record.samplesPerPixel)},
                           {"pellucid.seconds", figure(record.seconds)}};
    for (const auto& [name, value] : settingsAsText(record.resolved)) metadata["pellucid." + name] = value;
    return metadata;
}

void writeImage(const std::filesystem::path& file, const Image& image, float exposure, const ImageMetadata& metadata) {
    const std::string extension = file.extension().string();
    if (extension == ".exr")
        writeExr(file, image, metadata);
    else if (extension == ".png")
        writePng(file, image, exposure, metadata);
    else if (extension == ".hdr")
        writeRadianceHdr(file, image);
    else
        writePfm(file, image);
}

/// What the user should know of a finished render.
void tellResult(const RenderResult& result, const RecordContext& context, const LogSink& log) {
    const RenderRecord& record = result.record;
    for (const std::string& blind : record.blindSpots) logTo(log, LogLevel::Warning, "blind spot: " + blind);
    if (const NonFinite& bad = record.nonfinite; bad.count > 0)
        logTo(log, LogLevel::Warning,
              std::to_string(bad.count) + " samples were not finite and count as black; the first: pixel " +
                  std::to_string(bad.x) + "," + std::to_string(bad.y) + ", sample " + std::to_string(bad.sample) +
                  ", seed " + std::to_string(context.seed) +
                  "; --debug-sample " + std::to_string(bad.x) + "," + std::to_string(bad.y) + "," +
                  std::to_string(bad.sample) + " takes it again");
    logTo(log, LogLevel::Info,
          std::string(result.interrupted ? "interrupted; " : "") + std::to_string(context.width) + "x" +
              std::to_string(context.height) + ", " + std::to_string(record.samplesPerPixel) + " samples a pixel, " +
              duration(record.seconds) + ", estimated error " + figure(100.0 * record.errorEstimate) + " %");
}

[[nodiscard]] RecordContext contextOf(const RenderArguments& arguments, const Scene& scene,
                                      const RenderResult& result) {
    RecordContext context;
    context.version = PELLUCID_VERSION;
    context.sceneFile = arguments.common.scene;
    context.sceneHash = scene.hash();
    context.method = arguments.common.method;
    context.width = result.image.width();
    context.height = result.image.height();
    context.seed = arguments.common.seed;
    context.images = arguments.outputs;
    context.peakRssBytes = peakRssBytes();
    context.interrupted = result.interrupted;
    return context;
}

}  // namespace

int runRender(const RenderArguments& arguments, Clock::time_point started) {
    if (arguments.debugSample) return runReplay(arguments);
    const LogSink log = terminalLog(arguments.common.quiet);
    checkOutputs(arguments);
    const Workers workers(arguments.common.threads);
    const auto scene = loadScene(arguments.common, true, workers, log);
    RenderRequest request = makeRequest(arguments.common);
    request.layers = arguments.layers;
    request.checkpoint = arguments.checkpoint;
    request.resume = arguments.resume;
    request.budget.startedSecondsAgo = secondsSince(started);
    const RenderResult result = renderWithProgress(*scene, request, workers, arguments.common.quiet);
    const RecordContext context = contextOf(arguments, *scene, result);
    const ImageMetadata metadata = metadataOf(context, result.record);
    for (const std::string& file : arguments.outputs) writeImage(file, result.image, arguments.exposure, metadata);
    if (!arguments.record.empty()) writeFile(arguments.record, recordJson(result.record, context));
    tellResult(result, context, log);
    return result.interrupted ? kInterrupted : 0;
}

}  // namespace pellucid

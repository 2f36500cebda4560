// `pellucid render`: check the outputs, load, render, write. Loading counts against a budget of time.
#include <array>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>

#include <pellucid/base/error.h>
#include <pellucid/io/image_file.h>
#include <pellucid/io/plain_file.h>
#include <pellucid/render/views.h>
#include <pellucid/study/record_json.h>
#include <pellucid/study/text_table.h>

#include "commands.h"
#include "process.h"
#include "scene_loading.h"
#include "terminal.h"
#include "terminal_session.h"

namespace pellucid {
namespace {

[[nodiscard]] double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A render that took an hour must not end with a file that cannot be written.
void checkOutputs(const RenderArguments& arguments) {
    for (const std::string& file : arguments.outputs) checkFolderWritable(file);
    for (const std::string& file : {arguments.record, arguments.checkpoint, arguments.cache})
        if (!file.empty()) checkFolderWritable(file);
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
                  ", seed " + std::to_string(context.seed) + "; --debug-sample " + std::to_string(bad.x) + "," +
                  std::to_string(bad.y) + "," + std::to_string(bad.sample) + " takes it again");
    if (record.reuse.asked)
        logTo(log, LogLevel::Info,
              std::to_string(record.reuse.recordsReused) + " cache records were there already, " +
                  std::to_string(record.reuse.recordsNew) + " are new");
    logTo(log, LogLevel::Info,
          std::string(result.interrupted ? "interrupted; " : "") + std::to_string(context.width) + "x" +
              std::to_string(context.height) + ", " + std::to_string(record.samplesPerPixel) + " samples a pixel, " +
              duration(record.seconds) + ", estimated error " + figure(100.0 * record.errorEstimate) + " %");
}

/// out.exr -> out.0012.exr
[[nodiscard]] std::string numbered(const std::string& name, std::size_t frame) {
    const std::filesystem::path file(name);
    std::string number = std::to_string(frame);
    number.insert(0, number.size() < 4 ? 4 - number.size() : 0, '0');
    return (file.parent_path() / (file.stem().string() + "." + number + file.extension().string())).string();
}

[[nodiscard]] RecordContext contextOf(const RenderArguments& arguments, const Scene& scene,
                                      const RenderResult& result) {
    RecordContext context = recordContext(arguments.common, scene, result.image.width(), result.image.height());
    context.images = arguments.outputs;
    context.peakRssBytes = peakRssBytes();
    context.interrupted = result.interrupted;
    return context;
}

void writeResult(const RenderArguments& arguments, const Scene& scene, const RenderResult& result, const LogSink& log) {
    const RecordContext context = contextOf(arguments, scene, result);
    const ImageMetadata metadata = metadataOf(context, result.record);
    for (const std::string& file : arguments.outputs) writeImage(file, result.image, arguments.exposure, metadata);
    if (!arguments.record.empty()) writeFile(arguments.record, recordJson(result.record, context));
    tellResult(result, context, log);
}

/// Every camera in turn, with numbers in the names of all that is written.
[[nodiscard]] bool runViews(const RenderArguments& arguments, const Scene& scene, const RenderRequest& request,
                            const Workers& workers) {
    std::vector<std::string> cameras;
    for (std::size_t i = 0; i < scene.description().cameras.size(); ++i)
        cameras.push_back(scene.description().cameras[i].name);
    std::set<std::string> distinct(cameras.begin(), cameras.end());
    if (distinct.size() < cameras.size() || distinct.contains(""))
        for (std::size_t i = 0; i < cameras.size(); ++i) cameras[i] = std::to_string(i);
    TerminalSession terminal(arguments.common.quiet);
    const LogSink log = terminal.log();
    bool interrupted = false;
    std::size_t frames = 0;
    renderViews(
        scene, request, cameras,
        [&](std::size_t frame, const RenderResult& result) {
            RenderArguments own = arguments;
            for (std::string& file : own.outputs) file = numbered(file, frame);
            if (!own.record.empty()) own.record = numbered(own.record, frame);
            writeResult(own, scene, result, log);
            interrupted = interrupted || result.interrupted;
            ++frames;
        },
        workers, terminal.progress());
    return interrupted || frames < cameras.size();
}

}  // namespace

int runRender(const RenderArguments& arguments, Clock::time_point started) {
    if (arguments.debugSample) return runReplay(arguments);
    const LogSink log = terminalLog(arguments.common.quiet);
    checkOutputs(arguments);
    const Workers workers(arguments.common.threads);
    const auto scene =
        loadScene(arguments.common, true, workers, log, arguments.views == "all" ? std::string() : arguments.views);
    RenderRequest request = makeRequest(arguments.common);
    request.layers = arguments.layers;
    request.checkpoint = arguments.checkpoint;
    request.resume = arguments.resume;
    request.cacheFile = arguments.cache;
    request.pointsFolder = arguments.pointsFolder;
    if (!arguments.views.empty()) return runViews(arguments, *scene, request, workers) ? kInterrupted : 0;
    request.budget.startedSecondsAgo = secondsSince(started);
    TerminalSession terminal(arguments.common.quiet);
    const RenderResult result = render(*scene, request, workers, terminal.progress(), terminal.log());
    writeResult(arguments, *scene, result, terminal.log());
    return result.interrupted ? kInterrupted : 0;
}

}  // namespace pellucid

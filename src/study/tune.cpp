#include <pellucid/study/tune.h>

#include <algorithm>

#include <pellucid/base/error.h>
#include <pellucid/io/image_file.h>
#include <pellucid/io/plain_file.h>
#include <pellucid/study/text_table.h>
#include <pellucid/surface/material.h>

#include "tune_files.h"

namespace pellucid {
namespace {

constexpr double kReferenceShare = 0.2, kSearchShare = 0.55, kFinalShare = 0.95;  // of the budget, by when
constexpr double kReferenceTimes = 30.0;  // of the time to tune for, where the budget is in rounds

void makeFolders(const std::filesystem::path& folder) {
    std::error_code status;
    std::filesystem::create_directories(folder / "pictures", status);
    if (status)
        throw Error(ErrorKind::CannotFinish, "cannot make the folder: " + status.message(), folder.string(),
                    "give -o a folder that can be written");
    checkFolderWritable(folder / "front.json");
}

/// Whether surface.cast_roughness decides anything: some surface is neither a mirror nor plainly diffuse.
[[nodiscard]] bool isGlossy(const Scene& scene) {
    constexpr float kSmoothest = 0.05F, kRoughest = 0.65F;  // what the parameter's range divides
    return std::ranges::any_of(scene.description().materials, [](const Material& m) {
        const bool reflects = m.metallic > 0.0F || m.transmission > 0.0F || m.specular > 0.0F;
        const bool varies = m.metallicRoughnessTexture.image != nullptr;
        return reflects && (varies || (m.roughness > kSmoothest && m.roughness < kRoughest));
    });
}

[[nodiscard]] std::string journalKey(const TuneRequest& request, const TuneReference& reference,
                                     const std::string& hash) {
    std::string key = "pellucid " + request.version + ", scene " + hash + ", reference " + reference.key +
                      ", camera '" + request.camera + (request.iterations > 0 ? "', by rays" : "', by seconds");
    for (const auto& [name, value] : settingsAsText(request.settings)) key += ", " + name + "=" + value;
    return key;
}

/// The size of a given reference is the size of the renders, unless one is asked for, which must then be the same.
[[nodiscard]] TuneRequest withReferenceSize(TuneRequest request) {
    if (request.reference.empty() || request.width != 0 || request.height != 0) return request;
    const Image reference = readImage(request.reference);
    request.width = reference.width();
    request.height = reference.height();
    return request;
}

/// What the figures of this session do not deserve to hide.
void warnOf(const Front& front, const TuneRequest& request, const LogSink& log) {
    constexpr double kUneven = 1.3;
    if (front.seeds < 2)
        logTo(log, LogLevel::Warning,
              "the budget sufficed for one seed of the finalists: their errors have no intervals; a larger --budget "
              "goes on from here");
    double spread = 1.0;
    for (const Finalist& f : front.finalists)
        for (const FrontPoint& p : f.points)
            if (!p.cost.empty())
                spread = std::max(spread, std::ranges::max(p.cost) / std::max(1e-9, std::ranges::min(p.cost)));
    if (request.iterations == 0 && spread > kUneven)
        logTo(log, LogLevel::Warning,
              "the same settings took up to " + figure(spread) +
                  " times as long with another seed: this machine was busy, or --time " +
                  "is less than one iteration takes; --iterations counts rays instead of seconds");
}

}  // namespace

TuneOutcome tune(const TuneRequest& asked, const SceneSource& scenes, const Workers& workers, const Progress& progress,
                 const LogSink& log) {
    const TuneRequest request = withReferenceSize(asked);
    const Scene& scene = scenes(request.settings).scene;
    makeFolders(request.folder);

    RenderRequest plain;
    plain.width = request.width;
    plain.height = request.height;
    plain.camera = request.camera;
    plain.settings = request.settings;
    plain.budget.samples = 1;
    const RenderRecord plan = planOnly(scene, plain, workers);
    const SearchSpace space(request.over, request.settings, plan, isGlossy(scene));

    const double referenceLimit =
        request.iterations > 0 ? kReferenceTimes * request.time : kReferenceShare * request.budget;
    const TuneReference reference = referenceFor(request, scenes, referenceLimit, workers, progress, log);
    if (reference.interrupted) return {"", true};
    if (!reference.remark.empty()) logTo(log, LogLevel::Warning, reference.remark);

    TrialJournal journal(request.folder / "trials.json", journalKey(request, reference, scene.hash()));
    if (journal.size() > 0) logTo(log, LogLevel::Info, std::to_string(journal.size()) + " trials are finished already");
    TrialRunner runner(request, scenes, reference, journal, workers, progress, log);
    const std::vector<Candidate> peers = peersSettings(plan, reference.mean.pixels());
    Search search(request, space, peers, runner, kSearchShare * request.budget);
    const std::optional<SearchOutcome> found = search.run();
    if (!found) return {"", true};
    const std::optional<Front> front =
        measureFinalists(request, *found, space, peers, runner, kFinalShare * request.budget);
    if (!front) return {"", true};

    warnOf(*front, request, log);
    TuneFindings findings{request, space,  reference,
                          *found,  *front, request.goal.value_or(TuneGoal{TuneGoal::Kind::Time, request.time}),
                          {},      ""};
    findings.choice = choose(*front, findings.goal);
    const SettingList& set = front->finalists[findings.choice.finalist].candidate.set;
    findings.sceneHash = scenes(withSettings(request.settings, set)).scene.hash();
    const std::string json = frontJson(findings);
    writeFile(request.folder / "front.json", json);
    writeFile(request.folder / "tuned.toml", tunedToml(findings));
    writeFile(request.folder / "report.html", tuneReportHtml(findings, json));
    return {tuneText(findings), runner.interrupted()};
}

}  // namespace pellucid

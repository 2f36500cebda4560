#include "tune_trials.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include <pellucid/base/error.h>
#include <pellucid/io/image_file.h>
#include <pellucid/io/plain_file.h>

#include "study_json.h"
#include "tune_windows.h"

namespace pellucid {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kWindowKey = 0x77696e646f7773ULL;

[[nodiscard]] Json trialJson(const Trial& t) {
    return {{"settings", t.settings}, {"time", t.plan.time}, {"windows", t.plan.windows}, {"seed", t.plan.seed},
            {"relmse", t.relmse},     {"cost", t.cost},      {"spent", t.spent}};
}

[[nodiscard]] Trial trialFrom(const Json& json) {
    Trial t;
    t.settings = json.at("settings").get<std::string>();
    t.plan = {json.at("time").get<double>(), json.at("windows").get<int>(), json.at("seed").get<std::uint64_t>()};
    t.relmse = json.at("relmse").get<double>();
    t.cost = json.at("cost").get<double>();
    t.spent = json.at("spent").get<double>();
    return t;
}

[[nodiscard]] Json readJson(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    return Json::parse(text, nullptr, false);
}

}  // namespace

TrialJournal::TrialJournal(std::filesystem::path file, std::string key) : file_(std::move(file)), key_(std::move(key)) {
    if (!std::filesystem::exists(file_)) return;
    const Json json = readJson(file_);
    try {
        if (!json.is_discarded() && json.at("key").get<std::string>() == key_) {
            for (const Json& t : json.at("trials")) trials_.push_back(trialFrom(t));
            return;
        }
    } catch (const nlohmann::json::exception&) {
        trials_.clear();  // damaged: told below, and left for the user to look at
    }
    throw Error(ErrorKind::Usage, "this folder holds the tuning of another scene, size, time or kind of budget",
                file_.string(), "give -o another folder, or remove this one");
}

const Trial* TrialJournal::find(const std::string& settings, const TrialPlan& plan) const {
    const auto found = std::ranges::find_if(trials_, [&](const Trial& t) {
        return t.settings == settings && t.plan.time == plan.time && t.plan.windows == plan.windows &&
               t.plan.seed == plan.seed;
    });
    return found == trials_.end() ? nullptr : &*found;
}

void TrialJournal::add(const Trial& trial) {
    trials_.push_back(trial);
    Json json{{"key", key_}, {"trials", Json::array()}};
    for (const Trial& t : trials_) json["trials"].push_back(trialJson(t));
    writeFile(file_, dumped(json, 1));
}

double nominalSeconds(const RenderRecord& record) noexcept {
    double rays = 0.0;
    for (const StageRecord& s : record.stages) rays += static_cast<double>(s.rays);
    return rays / kRaysOfNominalSecond;
}

TrialRunner::TrialRunner(const TuneRequest& request, const SceneSource& scenes, const TuneReference& reference,
                         TrialJournal& journal, const Workers& workers, const Progress& progress, const LogSink& log)
    : request_(request),
      scenes_(scenes),
      reference_(reference),
      journal_(journal),
      workers_(workers),
      progress_(progress),
      log_(log),
      spent_(reference.spent) {}

Trial TrialRunner::counted(const Trial& trial) {
    const std::string name = trial.settings + "|" + std::to_string(trial.plan.time) + "|" +
                             std::to_string(trial.plan.windows) + "|" + std::to_string(trial.plan.seed);
    if (counted_.insert(name).second) spent_ += trial.spent;
    return trial;
}

void TrialRunner::tell() const {
    if (!progress_.report) return;
    ProgressReport report;
    report.stage = stage_;
    report.fraction = fraction_;
    report.secondsElapsed = spent_;
    if (fraction_ > 0.0) report.secondsLeft = spent_ * (1.0 / fraction_ - 1.0);
    progress_.report(report);
}

RenderRequest TrialRunner::renderRequest(const Candidate& candidate, const TrialPlan& plan) const {
    RenderRequest render;
    render.width = reference_.mean.width();
    render.height = reference_.mean.height();
    render.camera = request_.camera;
    render.seed = plan.seed;
    render.settings = withSettings(request_.settings, candidate.set);
    if (request_.iterations > 0)
        render.budget.rays = static_cast<std::uint64_t>(plan.time * kRaysOfNominalSecond);
    else
        render.budget.seconds = plan.time;
    if (plan.windows != kWholeImage)
        render.windows =
            stratifiedWindows(render.width, render.height, kWindowKey + static_cast<std::uint64_t>(plan.windows));
    return render;
}

std::optional<Trial> TrialRunner::run(const Candidate& candidate, const TrialPlan& plan, const std::string& picture) {
    const std::string settings = textOf(candidate.set);
    const std::filesystem::path image = picture.empty() ? "" : request_.folder / "pictures" / (picture + ".exr");
    const bool missing = !image.empty() && !std::filesystem::exists(image);
    if (const Trial* known = journal_.find(settings, plan); known != nullptr && !missing) return counted(*known);
    if (interrupted_ || progress_.stopAsked()) {
        interrupted_ = true;
        return std::nullopt;
    }
    const auto start = Clock::now();
    RenderRequest render = renderRequest(candidate, plan);
    const LoadedScene loaded = scenes_(render.settings);
    render.budget.startedSecondsAgo = loaded.loadSeconds;
    Progress inner;
    inner.interrupted = progress_.interrupted;
    const RenderResult result = pellucid::render(loaded.scene, render, workers_, inner, log_);
    if (result.interrupted) {
        interrupted_ = true;
        return std::nullopt;
    }
    Trial trial{settings, plan, reference_.relmseTrimmed(result.image, render.windows), result.record.seconds, 0.0};
    if (request_.iterations > 0) trial.cost = nominalSeconds(result.record);
    if (missing)
        writeExr(image, result.image, {{"pellucid.version", request_.version}, {"pellucid.settings", settings}});
    trial.spent = std::chrono::duration<double>(Clock::now() - start).count();
    if (const Trial* known = journal_.find(settings, plan)) return counted(*known);  // only its picture was missing
    journal_.add(trial);
    tell();
    return counted(trial);
}

}  // namespace pellucid

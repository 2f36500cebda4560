/// Trials: one render of one candidate, measured. Each is kept in DIR/trials.json as soon as it is done; a trial that
/// is found there is not rendered again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tune_reference.h"
#include "tune_space.h"

namespace pellucid {

inline constexpr int kWholeImage = -1;

/// What is rendered of a candidate.
struct TrialPlan {
    double time = 0.0;          ///< budget, in seconds or nominal ones
    int windows = kWholeImage;  ///< which set of windows
    std::uint64_t seed = 0;
};

struct Trial {
    std::string settings;  ///< textOf(Candidate::set)
    TrialPlan plan;
    double relmse = 0.0;
    double cost = 0.0;   ///< what the whole image took or would take, in seconds or nominal ones
    double spent = 0.0;  ///< seconds of wall time that the trial took
};

/// Reads and writes DIR/trials.json.
class TrialJournal {
public:
    /// `key`: what makes trials comparable. Throws Error{Usage} when the folder holds trials of something else.
    TrialJournal(std::filesystem::path file, std::string key);
    [[nodiscard]] const Trial* find(const std::string& settings, const TrialPlan& plan) const;
    void add(const Trial& trial);
    [[nodiscard]] std::size_t size() const noexcept { return trials_.size(); }

private:
    std::filesystem::path file_;
    std::string key_;
    std::vector<Trial> trials_;
};

class TrialRunner {
public:
    TrialRunner(const TuneRequest& request, const SceneSource& scenes, const TuneReference& reference,
                TrialJournal& journal, const Workers& workers, const Progress& progress, const LogSink& log);

    /// Empty when interrupted. With `picture` the image is kept as DIR/pictures/NAME.exr.
    [[nodiscard]] std::optional<Trial> run(const Candidate& candidate, const TrialPlan& plan,
                                           const std::string& picture = "");

    [[nodiscard]] bool interrupted() const noexcept { return interrupted_; }
    /// Seconds that the reference and the trials asked for so far have taken, whether now or in an earlier session: a
    /// resumed search sees the same clock and takes the same way.
    [[nodiscard]] double spent() const noexcept { return spent_; }
    /// The share of the budget or of the rounds that is used, for the progress bar.
    void setStage(std::string stage, double fraction) { stage_ = std::move(stage), fraction_ = fraction; }

private:
    [[nodiscard]] RenderRequest renderRequest(const Candidate& candidate, const TrialPlan& plan) const;
    [[nodiscard]] Trial counted(const Trial& trial);
    void tell() const;
    const TuneRequest& request_;
    const SceneSource& scenes_;
    const TuneReference& reference_;
    TrialJournal& journal_;
    const Workers& workers_;
    const Progress& progress_;
    const LogSink& log_;
    std::string stage_;
    double fraction_ = 0.0, spent_;
    std::set<std::string> counted_;
    bool interrupted_ = false;
};

/// Rays of all stages over kRaysOfNominalSecond.
[[nodiscard]] double nominalSeconds(const RenderRecord& record) noexcept;

}  // namespace pellucid

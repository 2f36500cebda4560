/// The search: rounds of successive halving [Jamieson2016] on windows of the image. Every candidate is rendered with
/// the same seeds on the same windows as the default (common random numbers), and judged by relmse x cost over the
/// default's: what is compared is efficiency at one time, so a render that ends early or late is neither helped nor
/// hurt.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tune_model.h"
#include "tune_space.h"
#include "tune_trials.h"

namespace pellucid {

inline constexpr int kLevels = 3;

/// A candidate and how it did: log of (relmse x cost) over the default's, by level as far as it came.
struct Contender {
    Candidate candidate;
    std::array<double, kLevels> score{};
    int levels = 0;  ///< that it has reached
};

/// What a parameter's departure from the default is worth in the winner.
struct Worth {
    std::string name;
    double gain = 0.0;  ///< log of the winner's (relmse x cost) without this departure over that with it
    bool kept = false;  ///< false: it gained too little and was taken back
};

struct SearchOutcome {
    std::vector<Contender> contenders;  ///< best first: by level reached, then by score
    Contender winner;                   ///< for the whole time, with idle departures taken back
    std::optional<Contender> quick;     ///< the best at the shortest time, where that is another
    std::vector<Worth> worth;
    AdditiveModel model;
    int rounds = 0;
};

class Search {
public:
    /// `limit`: seconds of TrialRunner::spent() after which no round begins; not used with request.iterations.
    Search(const TuneRequest& request, const SearchSpace& space, const std::vector<Candidate>& peers,
           TrialRunner& runner, double limit);

    /// Empty when interrupted.
    [[nodiscard]] std::optional<SearchOutcome> run();

private:
    [[nodiscard]] std::vector<TrialPlan> plansOf(int level) const;
    [[nodiscard]] std::optional<double> score(const Candidate& candidate, int level);
    [[nodiscard]] bool timeLeft() const;
    [[nodiscard]] int affordable() const;
    [[nodiscard]] bool round(const std::vector<Candidate>& field);
    [[nodiscard]] std::vector<Candidate> firstField(int size);
    [[nodiscard]] std::vector<Candidate> nextField(int size);
    [[nodiscard]] Candidate sobolPoint();
    [[nodiscard]] Candidate neighbour(const Candidate& of, double reach);
    [[nodiscard]] Candidate modelsBest(const AdditiveModel& model) const;
    [[nodiscard]] std::vector<const Contender*> ranked() const;
    [[nodiscard]] AdditiveModel fitted() const;
    [[nodiscard]] bool prune(SearchOutcome& outcome);
    void tellStage(const std::string& what);

    const TuneRequest& request_;
    const SearchSpace& space_;
    const std::vector<Candidate>& peers_;
    TrialRunner& runner_;
    double limit_;
    std::map<std::string, Contender> known_;
    std::uint32_t sobolIndex_ = 0, neighbourIndex_ = 0;
    std::array<double, kLevels> levelSeconds_{};  ///< that the default's trials took
    int rounds_ = 0;
};

}  // namespace pellucid

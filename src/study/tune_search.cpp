#include "tune_search.h"

#include <algorithm>
#include <cmath>

#include <pellucid/math/sampler.h>

namespace pellucid {
namespace {

constexpr std::array<double, kLevels> kTimeShare{0.25, 0.5, 1.0};
constexpr int kSurvivors = 3;  // one of so many goes on to the next level
constexpr int kFirstField = 27, kNextField = 9, kLeastField = 4;
constexpr double kLeastRatio = 0.02;  // a relmse so far below the default's is noise of the reference
constexpr double kIdle = 0.02;        // a departure that gains less than 2 % is taken back
constexpr double kPruneShare = 0.1;   // of the budget, for finding that out
constexpr double kFirstReach = 0.35, kReachFalls = 0.75;
constexpr std::uint64_t kSearchKey = 0x736561726368ULL, kSobolKey = 0x736f626f6cULL, kNeighbourKey = 0x6e656172ULL;

}  // namespace

Search::Search(const TuneRequest& request, const SearchSpace& space, const std::vector<Candidate>& peers,
               TrialRunner& runner, double limit)
    : request_(request), space_(space), peers_(peers), runner_(runner), limit_(limit) {}

std::vector<TrialPlan> Search::plansOf(int level) const {
    std::vector<TrialPlan> plans;
    const double time = request_.time * kTimeShare[static_cast<std::size_t>(level)];
    for (int repeat = 0; repeat <= (level == kLevels - 1 ? 1 : 0); ++repeat) {
        const int set = level + repeat;
        plans.push_back({time, set, hashCombine(kSearchKey + request_.seed, static_cast<std::uint64_t>(set)) >> 12U});
    }
    return plans;
}

std::optional<double> Search::score(const Candidate& candidate, int level) {
    double own = 0.0, standard = 0.0;
    for (const TrialPlan& plan : plansOf(level)) {
        const std::optional<Trial> base = runner_.run({"default", {}}, plan), trial = runner_.run(candidate, plan);
        if (!base || !trial) return std::nullopt;
        const double floor = std::max(1e-12, base->relmse);
        own += std::max(trial->relmse, kLeastRatio * floor) * trial->cost;
        standard += floor * base->cost;
    }
    return std::log(own / standard);
}

bool Search::timeLeft() const { return request_.iterations > 0 || runner_.spent() < limit_; }

/// How many candidates a round can have, from what the default's trials took.
int Search::affordable() const {
    if (request_.iterations > 0) return kFirstField;
    double each = 0.0, share = 1.0;
    for (int level = 0; level < kLevels; ++level, share /= kSurvivors)
        each += share * levelSeconds_[static_cast<std::size_t>(level)];
    return static_cast<int>(std::min(1e6, (limit_ - runner_.spent()) / std::max(1e-6, each)));
}

bool Search::round(const std::vector<Candidate>& field) {
    std::vector<std::string> alive;
    for (const Candidate& c : field) {
        const std::string name = textOf(c.set);
        if (std::ranges::find(alive, name) != alive.end()) continue;
        known_.try_emplace(name, Contender{c, {}, 0});
        alive.push_back(name);
    }
    for (int level = 0; level < kLevels; ++level) {
        const auto index = static_cast<std::size_t>(level);
        std::vector<std::string> measured;
        for (const std::string& name : alive) {
            Contender& contender = known_.at(name);
            // The last level is where the result comes from: it is finished whatever it takes.
            if (level == 0 && !timeLeft() && !measured.empty()) break;
            tellStage("round " + std::to_string(rounds_ + 1) + ", level " + std::to_string(level + 1));
            const std::optional<double> value = score(contender.candidate, level);
            if (!value) return false;
            contender.score[index] = *value;
            contender.levels = std::max(contender.levels, level + 1);
            measured.push_back(name);
        }
        std::ranges::stable_sort(measured, {}, [&](const std::string& name) { return known_.at(name).score[index]; });
        const std::size_t keep = std::max<std::size_t>(1, (measured.size() + kSurvivors - 1) / kSurvivors);
        measured.resize(std::min(measured.size(), keep));
        alive = std::move(measured);
    }
    ++rounds_;
    return true;
}

Candidate Search::sobolPoint() {
    // Padded pairs of an Owen-scrambled (0,2)-sequence: stratified in every coordinate and in each pair.
    Sampler sampler(kSobolKey + request_.seed, 0, sobolIndex_++);
    std::vector<double> x(space_.size());
    for (std::size_t i = 0; i < x.size(); i += 2) {
        const glm::vec2 pair = sampler.next2D();
        x[i] = static_cast<double>(pair.x);
        if (i + 1 < x.size()) x[i + 1] = static_cast<double>(pair.y);
    }
    return space_.at(x, "Sobol point");
}

/// Half of the parameters move, by a triangular distance; some of those that depart go back to the plan's choice.
Candidate Search::neighbour(const Candidate& of, double reach) {
    constexpr float kMoves = 0.5F, kReturns = 0.3F;
    Sampler sampler(kNeighbourKey + request_.seed, 0, neighbourIndex_++);
    Candidate moved{"near " + of.origin, of.set};
    if (moved.origin.starts_with("near near ")) moved.origin = moved.origin.substr(5);
    const std::vector<double> x = space_.positions(of);
    for (std::size_t i = 0; i < x.size(); ++i) {
        const glm::vec2 step = sampler.next2D(), chance = sampler.next2D();
        if (chance.x >= kMoves && space_.size() > 1) continue;
        const std::string name(space_.dimensions()[i].row->name);
        const auto departs = [&](const auto& setting) { return setting.first == name; };
        const bool departed = std::erase_if(moved.set, departs) > 0;
        if (departed && chance.y < kReturns) continue;
        const double to = x[i] + (static_cast<double>(step.x + step.y) - 1.0) * 2.0 * reach;
        moved.set.emplace_back(name, space_.dimensions()[i].valueAt(to < 0.0 ? -to : to > 1.0 ? 2.0 - to : to));
    }
    inTableOrder(moved.set);
    return moved;
}

/// What the model expects to gain something by; the rest stays with the plan.
Candidate Search::modelsBest(const AdditiveModel& model) const {
    const std::vector<double> best = model.best(), standard = space_.positions({"default", {}});
    Candidate c{"model", {}};
    for (std::size_t i = 0; i < space_.size(); ++i)
        if (model.part(i, standard[i]) - model.part(i, best[i]) > kIdle)
            c.set.emplace_back(space_.dimensions()[i].row->name, space_.dimensions()[i].valueAt(best[i]));
    return c;
}

std::vector<Candidate> Search::firstField(int size) {
    std::vector<Candidate> field;
    for (const Candidate& peer : peers_)
        if (space_.allows(peer)) field.push_back(peer);
    const auto wanted = static_cast<std::size_t>(size);
    for (bool near = true; field.size() < wanted; near = !near)
        field.push_back(near ? neighbour({"default", {}}, kFirstReach) : sobolPoint());
    return field;
}

std::vector<Candidate> Search::nextField(int size) {
    std::vector<Candidate> field;
    const AdditiveModel model = fitted();
    if (model.valid()) field.push_back(modelsBest(model));
    const std::vector<const Contender*> best = ranked();
    const double reach = kFirstReach * std::pow(kReachFalls, rounds_);
    const auto wanted = static_cast<std::size_t>(size);
    for (std::size_t i = 0; field.size() < wanted; ++i) {
        if (i % 3 == 2)
            field.push_back(sobolPoint());
        else
            field.push_back(neighbour(best[i % std::min<std::size_t>(4, best.size())]->candidate, reach));
    }
    return field;
}

/// Best first. A score of a higher level comes before any of a lower one.
std::vector<const Contender*> Search::ranked() const {
    std::vector<const Contender*> order;
    for (const auto& [name, contender] : known_)
        if (contender.levels > 0) order.push_back(&contender);
    std::ranges::stable_sort(order, [](const Contender* a, const Contender* b) {
        if (a->levels != b->levels) return a->levels > b->levels;
        const auto level = static_cast<std::size_t>(a->levels - 1);
        return a->score[level] < b->score[level];
    });
    return order;
}

AdditiveModel Search::fitted() const {
    std::vector<Observation> observations;
    for (const auto& [name, contender] : known_) {
        if (!space_.contains(contender.candidate)) continue;
        for (int level = 0; level < contender.levels; ++level)
            observations.push_back({space_.positions(contender.candidate),
                                    contender.score[static_cast<std::size_t>(level)], std::pow(2.0, level)});
    }
    return {observations, space_.size()};
}

/// Takes back what gains nothing, one departure after another, those first of which the model expects least.
bool Search::prune(SearchOutcome& outcome) {
    Contender& winner = outcome.winner;
    const std::vector<double> own = space_.positions(winner.candidate), standard = space_.positions({"default", {}});
    std::vector<std::pair<double, std::string>> order;
    for (const auto& [name, value] : winner.candidate.set) {
        double expected = 0.0;
        for (std::size_t i = 0; i < space_.size() && outcome.model.valid(); ++i)
            if (space_.dimensions()[i].row->name == name)
                expected = outcome.model.part(i, standard[i]) - outcome.model.part(i, own[i]);
        order.emplace_back(expected, name);
    }
    std::ranges::stable_sort(order);
    const auto last = static_cast<std::size_t>(kLevels - 1);
    for (const auto& [expected, name] : order) {
        Candidate without = winner.candidate;
        std::erase_if(without.set, [&name = name](const auto& setting) { return setting.first == name; });
        if (request_.iterations == 0 && runner_.spent() > limit_ + kPruneShare * request_.budget) break;
        tellStage("what " + name + " is worth");
        const std::optional<double> value = score(without, kLevels - 1);
        if (!value) return false;
        const double gain = *value - winner.score[last];
        outcome.worth.push_back({name, gain, gain > kIdle});
        if (gain > kIdle) continue;
        winner.candidate.set = without.set;
        winner.score[last] = *value;
    }
    return true;
}

void Search::tellStage(const std::string& what) {
    const double used =
        request_.iterations > 0 ? 0.6 * rounds_ / request_.iterations : runner_.spent() / request_.budget;
    runner_.setStage(what, std::min(1.0, used));
}

std::optional<SearchOutcome> Search::run() {
    Contender standard{{"default", {}}, {}, kLevels};
    for (int level = 0; level < kLevels; ++level) {
        tellStage("default");
        if (!score(standard.candidate, level)) return std::nullopt;
        for (const TrialPlan& plan : plansOf(level))
            levelSeconds_[static_cast<std::size_t>(level)] += runner_.run(standard.candidate, plan)->spent;
    }
    known_.emplace("default", standard);
    // The default's own renders may have used the budget up: then there is nothing to search with, and the default
    // stands.
    if (timeLeft() && !round(firstField(std::clamp(affordable(), kLeastField, kFirstField)))) return std::nullopt;
    const auto more = [this] {
        return request_.iterations > 0 ? rounds_ < request_.iterations : timeLeft() && affordable() >= kLeastField;
    };
    while (more())
        if (!round(nextField(std::min(affordable(), kNextField)))) return std::nullopt;
    SearchOutcome outcome;
    outcome.rounds = rounds_;
    outcome.model = fitted();
    for (const Contender* contender : ranked()) outcome.contenders.push_back(*contender);
    outcome.winner = outcome.contenders.front();
    if (!prune(outcome)) return std::nullopt;
    const auto quick = std::ranges::min_element(outcome.contenders, {}, [](const Contender& c) { return c.score[0]; });
    if (textOf(quick->candidate.set) != textOf(outcome.contenders.front().candidate.set) && quick->score[0] < 0.0)
        outcome.quick = *quick;
    return outcome;
}

}  // namespace pellucid

#include "tune_front.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pellucid {
namespace {

constexpr std::array<double, 4> kTimeShare{0.125, 0.25, 0.5, 1.0};
constexpr int kMostSeeds = 8, kSeedsOfIterations = 4;
constexpr int kPeersSeeds =
    2;  // then their settings are but marks on the front, unless they seem better than the default
constexpr double kInfinity = std::numeric_limits<double>::infinity();

[[nodiscard]] std::vector<Finalist> finalistsOf(const SearchOutcome& search, const SearchSpace& space,
                                                const std::vector<Candidate>& peers) {
    std::vector<Finalist> list{{"default", {"default", {}}, true, {}}};
    const auto add = [&list](const std::string& name, const Candidate& candidate, bool mayWin) {
        for (Finalist& f : list)
            if (f.candidate.set == candidate.set) return;
        list.push_back({name, candidate, mayWin, {}});
    };
    add("tuned", search.winner.candidate, true);
    if (search.quick) add("quick", search.quick->candidate, true);
    for (const Contender& c : search.contenders)
        if (c.levels == kLevels && c.candidate.set != search.contenders.front().candidate.set &&
            c.score[kLevels - 1] < 0.0) {
            add("runner-up", c.candidate, true);
            break;
        }
    for (const Candidate& peer : peers) add(peer.origin, peer, space.allows(peer));
    for (Finalist& f : list)
        for (const double share : kTimeShare) f.points.push_back({share, {}, {}, {}, {}, {}, false});
    return list;
}

[[nodiscard]] bool isPeer(const Finalist& finalist, const std::vector<Candidate>& peers) {
    return std::ranges::any_of(peers, [&](const Candidate& c) { return c.origin == finalist.name; });
}

void fill(FrontPoint& point, const FrontPoint& standard) {
    if (point.relmse.empty()) return;
    const auto count = static_cast<int>(point.relmse.size());
    const SeedBootstrap bootstrap(count);
    const auto mean = [&](const std::vector<double>& values) {
        return bootstrap.interval([&](SeedCounts c) { return std::max(1e-12, countedMean(values, c)); },
                                  IntervalScale::Log);
    };
    const Interval relmse = mean(point.relmse);
    point.error = {std::sqrt(relmse.value), std::sqrt(relmse.low), std::sqrt(relmse.high)};
    point.seconds = mean(point.cost);
    const auto efficiency = [](const FrontPoint& p, SeedCounts c) {
        double sum = 0.0;
        for (std::size_t i = 0; i < c.size(); ++i) sum += c[i] * std::max(1e-12, p.relmse[i]) * p.cost[i];
        return sum;
    };
    point.ratio = bootstrap.interval([&](SeedCounts c) { return efficiency(point, c) / efficiency(standard, c); },
                                     IntervalScale::Log);
}

/// Of points that are the same (a budget below one iteration's cost gives the image of the next) the first stands for all.
void markFront(Front& front) {
    std::vector<FrontPoint*> points;
    for (Finalist& f : front.finalists)
        for (FrontPoint& p : f.points)
            if (!p.relmse.empty()) points.push_back(&p);
    for (std::size_t i = 0; i < points.size(); ++i) {
        FrontPoint& p = *points[i];
        p.onFront = true;
        for (std::size_t j = 0; j < points.size(); ++j) {
            const FrontPoint& q = *points[j];
            const bool noSlower = q.seconds.value <= p.seconds.value, noWorse = q.error.value <= p.error.value;
            const bool same = q.seconds.value == p.seconds.value && q.error.value == p.error.value;
            if (j != i && noSlower && noWorse && (!same || j < i)) p.onFront = false;
        }
    }
}

/// Log-log between measured points, and along the curve's slope of -1/2 in the error beyond them.
[[nodiscard]] double errorAt(const Finalist& f, double seconds) {
    const FrontPoint* before = nullptr;
    for (const FrontPoint& p : f.points) {
        if (p.relmse.empty()) continue;
        if (p.seconds.value >= seconds) {
            if (before == nullptr) return p.error.value * std::sqrt(p.seconds.value / seconds);
            const double share =
                std::log(seconds / before->seconds.value) / std::log(p.seconds.value / before->seconds.value);
            return before->error.value * std::pow(p.error.value / before->error.value, share);
        }
        before = &p;
    }
    return before == nullptr ? kInfinity : before->error.value * std::sqrt(before->seconds.value / seconds);
}

[[nodiscard]] double secondsTo(const Finalist& f, double error) {
    std::vector<double> seconds, relmse;
    for (const FrontPoint& p : f.points) {
        if (p.relmse.empty()) continue;
        seconds.push_back(p.seconds.value);
        relmse.push_back(p.error.value * p.error.value);
    }
    return timeToError(seconds, relmse, error);
}

/// A departure from the default has to be surer than chance: over all its seeds, and the mean of the log ratios lies below 0
/// by more than its standard error.
[[nodiscard]] bool surelyBetter(const Finalist& f, const Finalist& standard) {
    const FrontPoint &own = f.points.back(), &base = standard.points.back();
    const std::size_t n = own.relmse.size();
    if (n == 0 || n < base.relmse.size()) return false;
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const double r =
            std::log(std::max(1e-12, own.relmse[i]) * own.cost[i] / (std::max(1e-12, base.relmse[i]) * base.cost[i]));
        sum += r;
        squares += r * r;
    }
    const double count = static_cast<double>(n), mean = sum / count;
    const double deviation = n > 1 ? std::sqrt(std::max(0.0, squares / count - mean * mean) / (count - 1.0)) : 0.0;
    return mean + deviation < -0.02;
}

/// Which finalists the next seed is rendered for: peers beyond their first seeds only when they may still win.
[[nodiscard]] std::vector<bool> goingOn(const Front& front, int seed, const std::vector<Candidate>& peers) {
    std::vector<bool> list;
    for (const Finalist& f : front.finalists)
        list.push_back(!isPeer(f, peers) || seed < kPeersSeeds ||
                       (f.mayWin && surelyBetter(f, front.finalists.front())));
    return list;
}

/// Renders one seed of all finalists; false when interrupted.
[[nodiscard]] bool measureSeed(Front& front, int k, int most, const TuneRequest& request,
                               const std::vector<Candidate>& peers, TrialRunner& runner, double limit) {
    const std::vector<bool> going = goingOn(front, k, peers);
    for (std::size_t which = 0; which < front.finalists.size(); ++which) {
        Finalist& f = front.finalists[which];
        for (std::size_t i = 0; i < f.points.size(); ++i) {
            const bool last = i + 1 == f.points.size(), shown = f.name == "default" || f.name == "tuned";
            if (!going[which] || (isPeer(f, peers) && !last)) continue;
            // Whatever is left, the default and the tuned settings are rendered once for the whole time.
            if (!(last && shown) && k == 0 && request.iterations == 0 && runner.spent() > limit) continue;
            const double share = request.iterations > 0 ? 0.6 + 0.4 * k / most : runner.spent() / request.budget;
            runner.setStage("finalists, seed " + std::to_string(k + 1) + ", " + f.name, std::min(1.0, share));
            const TrialPlan plan{f.points[i].time, kWholeImage, request.seed + static_cast<std::uint64_t>(k)};
            const auto trial = runner.run(f.candidate, plan, last && shown && k == 0 ? f.name : "");
            if (!trial) return false;
            f.points[i].relmse.push_back(trial->relmse);
            f.points[i].cost.push_back(trial->cost);
        }
    }
    return true;
}

/// A seed that was interrupted counts for nobody.
void dropUnfinished(Front& front) {
    for (Finalist& f : front.finalists)
        for (FrontPoint& p : f.points) {
            const auto seeds = std::min(p.relmse.size(), static_cast<std::size_t>(front.seeds));
            p.relmse.resize(seeds);
            p.cost.resize(seeds);
        }
}

}  // namespace

std::optional<Front> measureFinalists(const TuneRequest& request, const SearchOutcome& search, const SearchSpace& space,
                                      const std::vector<Candidate>& peers, TrialRunner& runner, double limit) {
    Front front;
    front.finalists = finalistsOf(search, space, peers);
    for (Finalist& f : front.finalists)
        for (FrontPoint& p : f.points) p.time *= request.time;
    const int most = request.iterations > 0 ? kSeedsOfIterations : kMostSeeds;
    double before = runner.spent(), ofSeed = 0.0;
    while (front.seeds < most) {
        if (front.seeds > 0 && request.iterations == 0 && runner.spent() + ofSeed > limit) break;
        if (!measureSeed(front, front.seeds, most, request, peers, runner, limit)) {
            if (front.seeds == 0) return std::nullopt;
            break;
        }
        ++front.seeds;
        ofSeed = runner.spent() - before;
        before = runner.spent();
    }
    dropUnfinished(front);
    for (Finalist& f : front.finalists)
        for (std::size_t i = 0; i < f.points.size(); ++i) fill(f.points[i], front.finalists.front().points[i]);
    markFront(front);
    return front;
}

Choice choose(const Front& front, const TuneGoal& goal) {
    const Finalist& standard = front.finalists.front();
    Choice best;
    double least = kInfinity;
    for (std::size_t i = 0; i < front.finalists.size(); ++i) {
        const Finalist& f = front.finalists[i];
        if (!f.mayWin || (i > 0 && !surelyBetter(f, standard))) continue;
        const double value = goal.kind == TuneGoal::Kind::Time ? errorAt(f, goal.value) : secondsTo(f, goal.value);
        if (!(value < least)) continue;
        least = value;
        best.finalist = i;
    }
    if (goal.kind == TuneGoal::Kind::Time) {
        best.seconds = goal.value;
        best.error = least;
        return best;
    }
    best.reached = std::isfinite(least);
    best.seconds = least;
    best.error = goal.value;
    if (best.reached) return best;
    Choice nearest = choose(front, {TuneGoal::Kind::Time, standard.points.back().seconds.value});
    nearest.reached = false;
    return nearest;
}

}  // namespace pellucid

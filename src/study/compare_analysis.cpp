#include "compare_analysis.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <pellucid/study/metrics.h>

#include "compare_cell.h"

namespace pellucid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using Runs = std::vector<const StoredRun*>;

/// One value a seed.
template <class Value>
[[nodiscard]] std::vector<double> valuesOf(const Runs& runs, Value&& value) {
    std::vector<double> values;
    for (const StoredRun* run : runs) values.push_back(value(*run));
    return values;
}

template <class Value>
[[nodiscard]] Interval meanInterval(const SeedBootstrap& bootstrap, const Runs& runs, Value&& value,
                                    IntervalScale scale = IntervalScale::Log) {
    const std::vector<double> values = valuesOf(runs, value);
    return bootstrap.interval([&](SeedCounts counts) { return countedMean(values, counts); }, scale);
}

[[nodiscard]] double relmseOf(const StoredRun& run) { return run.metrics->whole.relmse; }
[[nodiscard]] double secondsOf(const StoredRun& run) { return run.seconds; }

void addStages(PointFigures& point, const Runs& runs) {
    for (const StoredRun* run : runs)
        for (const StageRecord& stage : run->stages) {
            auto found = std::ranges::find(point.stages, stage.name, &std::pair<std::string, double>::first);
            if (found == point.stages.end()) found = point.stages.insert(point.stages.end(), {stage.name, 0.0});
            found->second += stage.seconds / static_cast<double>(runs.size());
        }
}

/// A variance lies above 0, and so does the interval that holds it.
[[nodiscard]] Interval varianceInterval(const SeedBootstrap& bootstrap, const ErrorProducts& errors) {
    Interval interval = bootstrap.interval([&](SeedCounts c) { return errorVariance(errors, c); });
    if (interval.low < 0.0) interval.low = 0.0;
    return interval;
}

[[nodiscard]] ClassFigures classFigures(const std::string& name, const ErrorProducts& errors,
                                        const SeedBootstrap& bootstrap) {
    return {name, bootstrap.interval([&](SeedCounts c) { return meanSquaredError(errors, c); }, IntervalScale::Log),
            bootstrap.interval([&](SeedCounts c) { return biasSquared(errors, c); }),
            varianceInterval(bootstrap, errors)};
}

[[nodiscard]] PointFigures pointFigures(const Runs& runs, double budget, const CellProducts& cell) {
    const SeedBootstrap bootstrap(static_cast<int>(runs.size()));
    PointFigures point;
    point.budget = budget;
    point.seeds = static_cast<int>(runs.size());
    point.seconds = meanInterval(bootstrap, runs, secondsOf);
    point.relmse = meanInterval(bootstrap, runs, relmseOf);
    point.relmseTrimmed =
        meanInterval(bootstrap, runs, [](const StoredRun& r) { return r.metrics->whole.relmseTrimmed; });
    point.rmse = meanInterval(bootstrap, runs, [](const StoredRun& r) { return r.metrics->whole.rmse; });
    point.smape = meanInterval(bootstrap, runs, [](const StoredRun& r) { return r.metrics->whole.smape; });
    point.flip = meanInterval(bootstrap, runs, [](const StoredRun& r) { return r.metrics->whole.flip; });
    point.bias = meanInterval(
        bootstrap, runs, [](const StoredRun& r) { return r.metrics->whole.bias; }, IntervalScale::Linear);
    point.bias2 = bootstrap.interval([&](SeedCounts c) { return biasSquared(cell.relative, c); });
    point.variance = varianceInterval(bootstrap, cell.relative);
    point.bias2Absolute = bootstrap.interval([&](SeedCounts c) { return biasSquared(cell.absolute, c); });
    point.varianceAbsolute = varianceInterval(bootstrap, cell.absolute);
    const std::vector<double> relmse = valuesOf(runs, relmseOf), seconds = valuesOf(runs, secondsOf);
    point.efficiency = bootstrap.interval(
        [&](SeedCounts c) { return 1.0 / (countedMean(relmse, c) * countedMean(seconds, c)); }, IntervalScale::Log);
    for (const StoredRun* run : runs) point.peakRssBytes = std::max(point.peakRssBytes, run->peakRssBytes);
    addStages(point, runs);
    for (const auto& [name, errors] : cell.classes) point.classes.push_back(classFigures(name, errors, bootstrap));
    return point;
}

/// Seconds and relmse of a method over its budgets, one value a seed: the seeds are drawn for the whole curve at once, as
/// the longer run of a seed begins with the samples of the shorter.
struct Curve {
    std::vector<std::vector<double>> seconds, relmse;

    template <class Figure>
    [[nodiscard]] double operator()(SeedCounts counts, Figure&& figure) const {
        std::vector<double> x, y;
        for (std::size_t i = 0; i < seconds.size(); ++i) {
            x.push_back(countedMean(seconds[i], counts));
            y.push_back(countedMean(relmse[i], counts));
        }
        return figure(x, y);
    }
};

/// Only the seeds that every budget has, so that an unfinished comparison is treated rightly.
[[nodiscard]] std::vector<Runs> commonSeeds(std::vector<Runs> cells) {
    for (Runs& cell : cells)
        std::erase_if(cell, [&](const StoredRun* run) {
            return !std::ranges::all_of(cells, [&](const Runs& other) {
                return &other == &cell ||
                       std::ranges::any_of(other, [&](const StoredRun* r) { return r->key.seed == run->key.seed; });
            });
        });
    return cells;
}

void addCurveFigures(MethodFigures& method, const std::vector<Runs>& cells) {
    const std::vector<Runs> common = commonSeeds(cells);
    const std::size_t seeds = common.empty() ? 0 : common.front().size();
    Curve curve;
    for (const Runs& cell : common) {
        if (cell.size() != seeds || seeds == 0) continue;
        curve.seconds.push_back(valuesOf(cell, secondsOf));
        curve.relmse.push_back(valuesOf(cell, relmseOf));
    }
    method.slope = {kNan, kNan, kNan};
    method.timeToError.assign(kTargetErrors.size(), {kNan, kNan, kNan});
    if (curve.seconds.empty()) return;
    const SeedBootstrap bootstrap(static_cast<int>(seeds));
    method.slope = bootstrap.interval(
        [&](SeedCounts c) { return curve(c, [](const auto& x, const auto& y) { return logLogSlope(x, y); }); });
    for (std::size_t i = 0; i < kTargetErrors.size(); ++i)
        method.timeToError[i] = bootstrap.interval(
            [&](SeedCounts c) {
                return curve(c, [i](const auto& x, const auto& y) { return timeToError(x, y, kTargetErrors[i]); });
            },
            IntervalScale::Log);
}

[[nodiscard]] PairFigures pairFigures(const std::string& a, const std::string& b, double budget, const Runs& runsA,
                                      const Runs& runsB) {
    const auto logOf = [](const StoredRun& run) { return std::log(std::max(relmseOf(run), 1e-300)); };
    const std::vector<double> x = valuesOf(runsA, logOf), y = valuesOf(runsB, logOf);
    PairFigures pair{a, b, budget, {kNan, kNan, kNan}, permutationTest(x, y), 1.0};
    // Of geometric means. The same seeds are drawn for both, as they may share random numbers.
    if (x.size() == y.size() && !x.empty())
        pair.ratio = SeedBootstrap(static_cast<int>(x.size()))
                         .interval([&](SeedCounts c) { return std::exp(countedMean(x, c) - countedMean(y, c)); },
                                   IntervalScale::Log);
    return pair;
}

void addPairs(CompareFigures& figures, const CompareRequest& request, const CompareRuns& runs) {
    std::vector<double> p;
    for (std::size_t a = 0; a < request.methods.size(); ++a)
        for (std::size_t b = a + 1; b < request.methods.size(); ++b)
            for (const double budget : request.times) {
                const std::string &nameA = request.methods[a].label, &nameB = request.methods[b].label;
                const Runs runsA = runsOf(runs, nameA, budget), runsB = runsOf(runs, nameB, budget);
                if (runsA.empty() || runsB.empty()) continue;
                figures.pairs.push_back(pairFigures(nameA, nameB, budget, runsA, runsB));
                p.push_back(figures.pairs.back().p);
            }
    const std::vector<double> adjusted = holmAdjusted(p);
    for (std::size_t i = 0; i < p.size(); ++i) figures.pairs[i].pAdjusted = adjusted[i];
}

/// relmse of the classes of one run: the diagonal of its own product.
[[nodiscard]] std::map<std::string, double> classRelmse(const Image& reference, const Image& image) {
    std::map<std::string, double> result;
    const std::vector<std::string> classes = classesIn(reference), own = classesIn(image);
    for (const std::string& name : classes)
        if (std::ranges::find(own, name) != own.end())
            result[name] = errorProducts(reference, std::span(&image, 1), true, name + ".").at(0, 0);
    return result;
}

}  // namespace

int seedsNeeded(std::size_t comparisons) noexcept {
    if (comparisons == 0) return 0;
    int seeds = 1;
    for (double smallest = 1.0; smallest * static_cast<double>(comparisons) > 1.0 - kConfidence;) {
        ++seeds;
        smallest *= seeds / (4.0 * seeds - 2.0);  // from (2K-2 choose K-1) splits to (2K choose K)
    }
    return seeds;
}

std::vector<const StoredRun*> runsOf(const CompareRuns& runs, const std::string& label, double budget) {
    Runs found;
    for (const StoredRun& run : runs.runs)
        if (run.key.label == label && run.key.budget == budget) found.push_back(&run);
    std::ranges::sort(found, [](const StoredRun* x, const StoredRun* y) { return x->key.seed < y->key.seed; });
    return found;
}

void measureRuns(CompareRuns& runs, const CompareReference& reference, const RunStore& store, const Workers& workers) {
    workers.forEach(runs.runs.size(), 1, [&](std::size_t i) {
        StoredRun& run = runs.runs[i];
        if (run.metrics && run.metrics->referenceHash == reference.hash) return;
        const Image image = store.readImage(run);
        run.metrics = {reference.hash, compareImages(reference.image, image), classRelmse(reference.image, image)};
        store.saveRecord(run);
    });
}

CompareFigures analyse(const CompareRequest& request, const CompareRuns& runs, const CompareReference& reference,
                       const RunStore& store, const Workers& workers) {
    CompareFigures figures;
    for (const CompareMethod& method : request.methods) {
        MethodFigures own;
        own.label = method.label;
        std::vector<Runs> cells;
        for (const double budget : request.times) {
            const Runs cell = runsOf(runs, method.label, budget);
            if (cell.empty()) continue;
            cells.push_back(cell);
            own.points.push_back(pointFigures(cell, budget, cellProducts(cell, reference, store, workers)));
        }
        addCurveFigures(own, cells);
        figures.methods.push_back(std::move(own));
    }
    addPairs(figures, request, runs);
    return figures;
}

}  // namespace pellucid

#include "tune_reference.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>

#include <nlohmann/json.hpp>

#include <pellucid/base/error.h>
#include <pellucid/io/image_file.h>
#include <pellucid/io/plain_file.h>
#include <pellucid/study/diff_report.h>
#include <pellucid/study/image_pair.h>
#include <pellucid/study/metrics.h>

#include "run_store.h"
#include "study_json.h"

namespace pellucid {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kSeeds[2] = {0x74756e6552656641ULL, 0x74756e6552656642ULL};  // far from the trials' seeds
constexpr double kPilotShare = 0.05;  // of the limit, to learn how many samples fit
constexpr std::uint32_t kLeastSamples = 4;
constexpr double kCleanEnough = 1e-3;  // relmse of the R in a weight: its bias is about 6 times the square of that [D]
constexpr int kWidestBlur = 3;         // in pixels to each side

[[nodiscard]] std::size_t pixelAt(int x, int y, int width) noexcept {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

struct HalfState {
    std::string key;
    std::uint32_t samples = 0;  ///< that the half is to have
    double spent = 0.0;
    bool done = false;
};

[[nodiscard]] HalfState readState(const std::filesystem::path& file, const std::string& key) {
    return readKeyed<Json>(file, key, HalfState{key, 0, 0.0, false}, [&key](const Json& json) -> HalfState {
        return {key, json.at("samples").get<std::uint32_t>(), json.at("spent").get<double>(),
                json.at("done").get<bool>()};
    });
}

void writeState(const std::filesystem::path& file, const HalfState& state) {
    writeFile(file, dumped(Json{
                        {"key", state.key}, {"samples", state.samples}, {"spent", state.spent}, {"done", state.done}}));
}

/// Reference, or, where that is blind, photon maps without a cache: its bias falls with every iteration.
[[nodiscard]] RenderRequest methodFor(const TuneRequest& request, const Scene& scene, const Workers& workers,
                                      std::string& remark) {
    RenderRequest render;
    render.method = Method::Reference;
    render.width = request.width;
    render.height = request.height;
    render.camera = request.camera;
    render.settings = request.settings;
    const RenderRecord plan = planOnly(scene, render, workers);
    if (plan.blindSpots.empty()) return render;
    render.method = Method::Photon;
    render.settings.cache = "off";
    render.settings.causticMap = "on";
    render.settings.alpha = 2.0 / 3.0;
    remark =
        "the reference is a photon render without a cache, since no unbiased method sees " + plan.blindSpots.front();
    return render;
}

/// One half: a short render tells how many samples fit, then it goes on to as many.
[[nodiscard]] Image renderHalf(RenderRequest render, int half, const std::string& key, const TuneRequest& request,
                               const Scene& scene, double limit, const Workers& workers, const Progress& progress,
                               const LogSink& log, TuneReference& reference) {
    const std::string name = half == 0 ? "reference-a" : "reference-b";
    const std::filesystem::path stateFile = request.folder / (name + ".json"), image = request.folder / (name + ".exr");
    HalfState state = readState(stateFile, key + ", half " + std::to_string(half));
    reference.spent += state.spent;
    if (state.done && std::filesystem::exists(image)) return readImage(image);
    render.seed = kSeeds[half];
    render.checkpoint = request.folder / (name + ".state");
    render.resume = state.samples > 0 && std::filesystem::exists(render.checkpoint);
    const auto start = Clock::now();
    const auto told = [&](RenderResult result) {
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        state.done = !result.interrupted && state.samples > 0 && result.record.samplesPerPixel >= state.samples;
        if (state.done) writeExr(image, result.image, {{"pellucid.version", request.version}});
        HalfState kept = state;
        kept.spent += seconds;
        writeState(stateFile, kept);
        if (state.done) std::filesystem::remove(render.checkpoint);
        reference.interrupted = reference.interrupted || result.interrupted;
        return result;
    };
    if (state.samples == 0) {
        if (request.iterations > 0)
            render.budget.rays = static_cast<std::uint64_t>(kPilotShare * limit * kRaysOfNominalSecond);
        else
            render.budget.seconds = kPilotShare * limit;
        const RenderResult pilot = told(pellucid::render(scene, render, workers, progress, log));
        if (pilot.interrupted) return {};
        state.samples = std::max(kLeastSamples, static_cast<std::uint32_t>(pilot.record.samplesPerPixel / kPilotShare));
        render.resume = true;
    }
    render.budget = {};
    render.budget.samples = state.samples;
    RenderResult result = told(pellucid::render(scene, render, workers, progress, log));
    reference.spent += std::chrono::duration<double>(Clock::now() - start).count();
    return std::move(result.image);
}

[[nodiscard]] Image meanOf(const Image& a, const Image& b) {
    const std::array<int, 3> ca = colourChannels(a), cb = colourChannels(b);
    Image mean(a.width(), a.height(), {"R", "G", "B"});
    for (std::size_t i = 0; i < a.pixels(); ++i)
        for (std::size_t c = 0; c < 3; ++c) mean.at(i, static_cast<int>(c)) = 0.5F * (a.at(i, ca[c]) + b.at(i, cb[c]));
    return mean;
}

[[nodiscard]] TuneReference givenReference(const TuneRequest& request, const Camera& camera) {
    TuneReference reference;
    reference.mean = readImage(request.reference);
    reference.name = request.reference.filename().string();
    reference.key = "file " + imageHash(reference.mean);
    if (reference.mean.width() != camera.width() || reference.mean.height() != camera.height())
        throw Error(ErrorKind::BadInput,
                    "the reference is " + std::to_string(reference.mean.width()) + "x" +
                        std::to_string(reference.mean.height()),
                    request.reference.string(), "leave out --size, or give the reference's");
    const auto noise = referenceNoise(reference.mean);
    reference.noise = noise.value_or(0.0);
    if (!noise)
        reference.remark = "the reference has no layers variance.*: its own noise counts as error of every render";
    reference.weigh();
    return reference;
}

}  // namespace

void TuneReference::weigh() {
    const ImagePair pair(first.pixels() > 0 ? first : mean, second.pixels() > 0 ? second : mean), whole(mean, mean);
    const double floor = whole.relativeFloor();
    double noiseSum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < pair.pixels(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const double d = 0.5 * static_cast<double>(pair.image(i, c) - pair.reference(i, c));
            const double r = static_cast<double>(whole.reference(i, c));
            const double term = d * d / (r * r + floor);
            if (!std::isfinite(term)) continue;
            noiseSum += term;
            count += 1.0;
        }
    const double share = count > 0.0 ? noiseSum / count : 0.0;
    int radius = 0;
    while (radius < kWidestBlur && share / ((2 * radius + 1) * (2 * radius + 1)) > kCleanEnough) ++radius;
    weights = Image(mean.width(), mean.height(), {"R", "G", "B"});
    for (int y = 0; y < mean.height(); ++y)
        for (int x = 0; x < mean.width(); ++x) {
            const std::size_t pixel = pixelAt(x, y, mean.width());
            if (!whole.counts(pixel)) continue;
            for (std::size_t c = 0; c < 3; ++c) {
                double sum = 0.0, number = 0.0;
                for (int v = std::max(0, y - radius); v <= std::min(mean.height() - 1, y + radius); ++v)
                    for (int u = std::max(0, x - radius); u <= std::min(mean.width() - 1, x + radius); ++u) {
                        sum += static_cast<double>(whole.reference(pixelAt(u, v, mean.width()), c));
                        number += 1.0;
                    }
                const double r = sum / number, weight = 1.0 / (r * r + floor);
                weights.at(pixel, static_cast<int>(c)) = std::isfinite(weight) ? static_cast<float>(weight) : 0.0F;
            }
        }
}

double TuneReference::relmseTrimmed(const Image& image, const std::vector<PixelWindow>& windows) const {
    const bool halves = first.pixels() > 0;
    const ImagePair a(halves ? first : mean, image), b(halves ? second : mean, image);
    std::vector<double> errors;
    const auto add = [&](const PixelWindow& w) {
        for (int y = w.y0; y < w.y1; ++y)
            for (int x = w.x0; x < w.x1; ++x) {
                const std::size_t pixel = pixelAt(x, y, image.width());
                double sum = 0.0;
                int values = 0;
                for (std::size_t c = 0; c < 3; ++c) {
                    const double weight = static_cast<double>(weights.at(pixel, static_cast<int>(c)));
                    const double value = static_cast<double>(a.image(pixel, c));
                    const double product = (value - static_cast<double>(a.reference(pixel, c))) *
                                           (value - static_cast<double>(b.reference(pixel, c)));
                    if (!(weight > 0.0) || !std::isfinite(product)) continue;
                    sum += weight * product;
                    ++values;
                }
                if (values > 0) errors.push_back(sum / values);
            }
    };
    if (windows.empty()) add({0, 0, image.width(), image.height()});
    for (const PixelWindow& w : windows) add(w);
    if (errors.empty()) return -noise;
    // A glint in one half of the reference makes a term as wrong below 0.
    const auto worst = static_cast<std::ptrdiff_t>(std::ceil(kTrimmedShare * static_cast<double>(errors.size())));
    std::ranges::nth_element(errors, errors.begin() + worst,
                             [](double x, double y) { return std::abs(x) > std::abs(y); });
    const auto kept = static_cast<double>(errors.size()) - static_cast<double>(worst);
    return std::accumulate(errors.begin() + worst, errors.end(), 0.0) / std::max(1.0, kept) - noise;
}

TuneReference referenceFor(const TuneRequest& request, const SceneSource& scenes, double limit, const Workers& workers,
                           const Progress& progress, const LogSink& log) {
    const LoadedScene loaded = scenes(request.settings);
    const Camera camera = loaded.scene.camera(request.camera, request.width, request.height);
    if (!request.reference.empty()) return givenReference(request, camera);
    TuneReference reference;
    const RenderRequest render = methodFor(request, loaded.scene, workers, reference.remark);
    std::string settings;
    for (const auto& [name, value] : settingsAsText(render.settings)) settings += name + "=" + value + ";";
    reference.key = "pellucid " + request.version + ", scene " + loaded.scene.hash() + ", " +
                    std::to_string(camera.width()) + "x" + std::to_string(camera.height()) + ", camera '" +
                    request.camera + "', settings " + hashText(settings) +
                    (request.iterations > 0 ? ", by rays" : ", by seconds");
    reference.name = "reference.exr";
    Progress inner = progress;
    if (progress.report)
        inner.report = [&progress](ProgressReport report) {
            report.stage = "reference";
            progress.report(report);
        };
    Image halves[2];
    for (int half = 0; half < 2; ++half) {
        halves[half] =
            renderHalf(render, half, reference.key, request, loaded.scene, 0.5 * limit, workers, inner, log, reference);
        if (reference.interrupted) return reference;
    }
    reference.first = std::move(halves[0]);
    reference.second = std::move(halves[1]);
    reference.mean = meanOf(reference.first, reference.second);
    reference.weigh();
    if (!std::filesystem::exists(request.folder / "reference.exr"))
        writeExr(request.folder / "reference.exr", reference.mean, {{"pellucid.version", request.version}});
    return reference;
}

}  // namespace pellucid

// How a step of a dial is measured.
#include <pellucid/study/stiffness.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <pellucid/math/hash.h>
#include <pellucid/study/statistics.h>

#include "check_measure.h"
#include "check_scenes.h"
#include "stiffness_dials.h"

namespace pellucid {

namespace {

using namespace check;

constexpr int kSize = 12, kSweepSeeds = 4;

/// The picture as it must be.
[[nodiscard]] std::vector<double> pictureOf(const Scene& scene, const Known& known) {
    const Camera camera = scene.camera("", kSize, kSize);
    std::vector<double> picture;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const CameraRay ray =
                camera.ray({static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F}, {0.5F, 0.5F});
            const auto hit = scene.intersect(ray.ray, 0.5F);
            const glm::dvec3 at =
                hit ? glm::dvec3(hit->point.position) / scene.normalisation().scale() + scene.normalisation().centre
                    : glm::dvec3(0.0);
            picture.push_back(known.radiance(at));
        }
    return picture;
}

[[nodiscard]] double greyOf(const Image& image, std::size_t pixel) {
    double sum = 0.0;
    for (int c = 0; c < 3; ++c) sum += static_cast<double>(image.at(pixel, c)) / 3.0;
    return sum;
}

[[nodiscard]] SweepFigures figuresOf(const CheckContext& context, const Scene& scene,
                                     const std::vector<double>& picture, const By& by, const Settings& settings,
                                     std::uint64_t key) {
    SweepFigures figures;
    std::array<double, kSweepSeeds> bias{};
    double expected = 0.0;
    for (const double r : picture) expected += r / static_cast<double>(picture.size());
    for (std::size_t k = 0; k < bias.size(); ++k) {
        const RenderResult result = renderOnce(context, scene, by, settings, kSize, hashCombine(key, k));
        double mean = 0.0;
        for (std::size_t i = 0; i < picture.size(); ++i) {
            const double value = greyOf(result.image, i), off = value / picture[i] - 1.0;
            figures.error += off * off / static_cast<double>(picture.size() * bias.size());
            mean += value / static_cast<double>(picture.size());
        }
        bias[k] = mean / expected - 1.0;
        figures.seconds += result.record.seconds / static_cast<double>(bias.size());
        for (const StageRecord& s : result.record.stages)
            figures.rays += static_cast<double>(s.rays) / static_cast<double>(bias.size());
    }
    figures.error = std::sqrt(figures.error);
    double square = 0.0;
    for (const double b : bias) figures.bias += b / kSweepSeeds;
    for (const double b : bias) square += (b - figures.bias) * (b - figures.bias);
    figures.interval =
        studentQuantile(0.975, kSweepSeeds - 1) * std::sqrt(square / (kSweepSeeds * (kSweepSeeds - 1.0)));
    return figures;
}

[[nodiscard]] SweepStep measureStep(const CheckContext& context, double value, Known known) {
    const Scene scene = makeScene(context, std::move(known.scene));
    const std::vector<double> picture = pictureOf(scene, known);
    SweepStep step;
    step.value = value;
    const std::uint64_t key = hashCombine(context.seed, 0x7377656570ULL);
    step.by[0] = figuresOf(context, scene, picture, {Method::Path, known.pathSamples}, known.settings, key);
    step.by[1] = figuresOf(context, scene, picture, {Method::Photon, known.photonSamples}, known.settings, key);
    return step;
}

}  // namespace

std::optional<std::size_t> breakdown(const Sweep& sweep, std::size_t method) noexcept {
    if (sweep.steps.empty()) return std::nullopt;
    const double limit = kBrokenFactor * std::max(kSmallError, sweep.steps.front().by[method].error);
    for (std::size_t i = 0; i < sweep.steps.size(); ++i)
        if (!(sweep.steps[i].by[method].error <= limit)) return i;
    return std::nullopt;
}

std::optional<std::size_t> blindness(const Sweep& sweep, std::size_t method) noexcept {
    std::size_t from = sweep.steps.size();
    while (from > 0 && sweep.steps[from - 1].by[method].bias <= -0.999) --from;
    return from < sweep.steps.size() ? std::optional(from) : std::nullopt;
}

std::optional<std::size_t> certainBias(const Sweep& sweep, std::size_t method) noexcept {
    for (std::size_t i = 0; i < sweep.steps.size(); ++i) {
        const SweepFigures& f = sweep.steps[i].by[method];
        if (f.bias > -0.999 && std::fabs(f.bias) > std::max(kSmallBias, kCertainly * f.interval)) return i;
    }
    return std::nullopt;
}

std::vector<std::string_view> sweepNames() {
    std::vector<std::string_view> names;
    for (const Dial& dial : dials()) names.emplace_back(dial.name);
    return names;
}

std::vector<Sweep> runSweeps(const CheckContext& context, std::string_view filter,
                             const std::function<void(const Sweep&)>& done) {
    std::vector<Sweep> sweeps;
    for (const Dial& dial : dials()) {
        if (std::string_view(dial.name).find(filter) == std::string_view::npos) continue;
        Sweep sweep{dial.name, dial.dial, dial.scene, dial.reference, dial.source, {}};
        for (const double value : dial.values) {
            sweep.steps.push_back(measureStep(context, value, dial.make(value)));
            if (done) done(sweep);
        }
        sweeps.push_back(std::move(sweep));
    }
    return sweeps;
}

}  // namespace pellucid

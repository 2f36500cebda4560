#include "check_measure.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <pellucid/math/hash.h>
#include <pellucid/study/record_json.h>
#include <pellucid/study/statistics.h>
#include <pellucid/transport/emission_guide.h>
#include <pellucid/transport/photon_trace.h>

namespace pellucid::check {

namespace {

/// Whether a render begins with photons: a pilot, maps, a cache.
[[nodiscard]] bool prepares(Method method, const Scene& scene) noexcept {
    const bool lightPaths = method == Method::Light || method == Method::Reference;
    return method == Method::Photon || (lightPaths && (scene.lobeKinds() & kSpecular) != kNoLobe);
}

}  // namespace

std::uint64_t seedOf(const CheckContext& context, int repetition) {
    return hashCombine(context.seed, static_cast<std::uint64_t>(repetition));
}

Estimate estimate(std::span<const double> values) {
    const auto n = static_cast<double>(values.size());
    double mean = 0.0, square = 0.0;
    for (const double v : values) mean += v / n;
    for (const double v : values) square += (v - mean) * (v - mean);
    const double student = studentQuantile(1.0 - 0.5 * kStrayLevel, static_cast<int>(values.size()) - 1);
    return {mean, student * std::sqrt(square / (n * (n - 1.0)))};
}

Finding findingOf(std::string quantity, double expected, double allowance, double resolution,
                  std::span<const double> values) {
    const Estimate e = estimate(values);
    const double unit = expected != 0.0 ? std::fabs(expected) : 1.0;
    return {std::move(quantity), expected, e.mean, e.interval, (allowance + kFloatAllowance) * unit, resolution * unit};
}

Finding measureSeeds(const CheckContext& context, std::string quantity, double expected, double allowance,
                     double resolution, const std::function<double(std::uint64_t)>& once, int seeds) {
    return findingOf(std::move(quantity), expected, allowance, resolution, forSeeds(context, seeds, once));
}

Finding exact(std::string quantity, double expected, double measured, double allowance) {
    return {std::move(quantity), expected, measured, 0.0, allowance, 0.0};
}

Settings smallSettings() {
    Settings s;
    s.globalPhotons = 30'000;
    s.gatherRays = 256;
    return s;
}

Scene makeScene(const CheckContext& context, SceneDescription description,
                std::optional<EnvironmentDescription> environment) {
    return Scene(std::move(description), std::move(environment), SceneOptions{}, context.workers);
}

RenderResult renderOnce(const CheckContext& context, const Scene& scene, const By& by, const Settings& settings,
                        int size, std::uint64_t seed) {
    RenderRequest request;
    request.method = by.method;
    request.width = request.height = size;
    request.seed = seed;
    request.budget.samples = by.samples;
    request.settings = settings;
    return render(scene, request, context.workers);
}

glm::dvec3 channelsOf(const Image& image, const std::string& layer) {
    const int first = image.channel(layer.empty() ? "R" : layer + ".R");
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < image.pixels(); ++i)
        for (int c = 0; c < 3; ++c) sum[c] += static_cast<double>(image.at(i, first + c));
    return sum / static_cast<double>(image.pixels());
}

double meanOf(const Image& image, const std::string& layer) {
    const glm::dvec3 channels = channelsOf(image, layer);
    return (channels.r + channels.g + channels.b) / 3.0;
}

std::vector<Finding> measure(const CheckContext& context, Rendered what) {
    const Scene scene = makeScene(context, std::move(what.scene), std::move(what.environment));
    struct Once {
        double value = 0.0;
        std::uint64_t nonfinite = 0;
        double lost = 0.0;  // of the energy of a photon pass
    };
    std::vector<Finding> findings;
    std::uint64_t nonfinite = 0;
    double lost = 0.0;
    for (const By& by : what.by) {
        const std::string layer = by.layer.empty() ? "" : ", " + by.layer;
        const auto all = forSeeds(context, prepares(by.method, scene) ? kSeeds : kManySeeds, [&](std::uint64_t seed) {
            const RenderResult result = renderOnce(context, scene, by, what.settings, what.size, seed);
            Once once{meanOf(result.image, by.layer) * what.toQuantity, result.record.nonfinite.count};
            for (const StageRecord& s : result.record.stages)
                if (s.photonPasses > 0) once.lost = std::max(once.lost, std::fabs(s.energy.residual()));
            return once;
        });
        std::vector<double> values;
        for (const Once& once : all) {
            values.push_back(once.value);
            nonfinite += once.nonfinite;
            lost = std::max(lost, once.lost);
        }
        findings.push_back(findingOf(fmt::format("{}, {}{}", what.quantity, methodName(by.method), layer),
                                     what.expected, by.bias, by.resolution, values));
    }
    if (nonfinite > 0)
        findings.push_back(exact("samples that are not finite", 0.0, static_cast<double>(nonfinite), 0.0));
    if (!(lost < 1e-9)) findings.push_back(exact("energy of a photon pass unaccounted for, share", 0.0, lost, 1e-9));
    return findings;
}

std::vector<Finding> measureByAll(const CheckContext& context, Rendered what) {
    const auto unbiased = std::ranges::find_if(
        what.by, [](const By& by) { return by.method == Method::Path || by.method == Method::Light; });
    if (unbiased == what.by.end()) return measure(context, std::move(what));
    const By model = *unbiased;
    for (const Method method : {Method::Bdpt, Method::Reference}) {
        if (std::ranges::any_of(what.by, [method](const By& by) { return by.method == method; })) continue;
        By twin = model;
        twin.method = method;
        twin.samples = std::max(1U, model.samples / 4);
        twin.resolution = std::max(0.06, 3.0 * model.resolution);
        if (model.method == Method::Light && method == Method::Bdpt) {
            twin.samples = 128;
            twin.resolution = std::max(0.2, twin.resolution);
        }
        what.by.push_back(std::move(twin));
    }
    return measure(context, std::move(what));
}

PhotonList causticPhotons(const CheckContext& context, const Scene& scene, std::uint32_t paths, std::uint64_t seed) {
    const EmissionGuide unguided(scene.lights(), {});
    const CausticPass pilot =
        traceCausticPhotons(scene, unguided, {hash64(seed ^ 0x70696c6f74ULL), 0, paths}, nullptr, context.workers);
    const EmissionGuide guide(scene.lights(), pilot.useful);
    CausticPass pass = traceCausticPhotons(scene, guide, {seed, 1, paths}, nullptr, context.workers);
    const Normalisation& n = scene.normalisation();
    const double s = n.scale();
    for (Photon& p : pass.photons) {
        p.position = glm::vec3(glm::dvec3(p.position) / s + n.centre);
        p.flux *= static_cast<float>(1.0 / (s * s));
    }
    return std::move(pass.photons);
}

}  // namespace pellucid::check

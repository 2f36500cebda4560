/// Who serves caustics best: relMSE of the indirect and caustic light at equal CPU time by photons alone (photon.caustic_map=on), photons and
/// eye paths that meet the lamp (on), eye paths alone (photon.caustic_map=off) and by what the plan chooses, over the size of
/// the lamp and the roughness of a glass ball and of a metal ring. One thread; time is this process's CPU time from the end of
/// the first iteration on: what is done once (pilot, cache) is left out, as it would be in a longer render. relMSE is against two independent references, mean((I - R1) (I - R2) / (P^2 + 0.01 mean(P)^2)), so that their noise
/// drops out on average; P is the whole picture, so that it is what the picture's relMSE has of it. All roughnesses cast, as
/// --cast says. A way that shows less than half of the light has its share of it beside, and is never the better one; with 0.3, the default of surface.cast_roughness, the last one is left to path tracing and cache.
///
///     caustic_share_bench [--seconds 0.4] [--reference 3] [--seeds 2] [--only metal] [--cast 0.5] [--size 1] [--roughness 0.3] [--keep FOLDER]
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <pellucid/io/image_file.h>
#include <pellucid/math/constants.h>
#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>

#include "../../src/study/check_scenes.h"

namespace pellucid {
namespace {

constexpr int kWidth = 64, kHeight = 48;
constexpr std::array kSizes{1e-3, 1e-2, 0.1, 1.0};
const std::vector kRoughness{0.0F, 0.1F, 0.3F, 0.5F};
/// A way that shows less of the light than this is blind, however small its error: it has not met the lamp yet.
constexpr double kLeastSeen = 0.5;

struct Arguments {
    double seconds = 0.4, reference = 3.0;
    std::uint64_t seeds = 2;
    std::string only, keep;
    double cast = 0.5, size = 0.0, roughness = -1.0;
};

struct Way {
    const char *name, *setting, *value;
};
constexpr std::array kWays{Way{"photons", "photon.caustic_map", "on"}, Way{"both", "photon.chance", "on"},
                           Way{"chance", "photon.caustic_map", "off"}, Way{"default", nullptr, nullptr}};

[[nodiscard]] double cpuSeconds() {
    struct rusage used {};
    getrusage(RUSAGE_SELF, &used);
    return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

/// A floor of 2 m, the caster above it, a lamp of constant power to one side. `size`: half width of the lamp in metres.
[[nodiscard]] SceneDescription sceneOf(std::string_view caster, double size, float roughness) {
    check::SceneBuilder b;
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, check::lambert(0.6F));
    const glm::dvec3 at(0.6, 1.8, 0.4), target(0, 0.2, 0);
    b.square(at, target - at, size, check::lamp(static_cast<float>(4.0 / (4.0 * size * size))));
    if (caster == "glass") {
        b.sphere({0, 0.35, 0}, 0.3, 24, check::glass(1.5F, 0.0F, roughness), true);
    } else {
        constexpr double kRadius = 0.4, kTall = 0.25;
        b.surface(
            64, 1,
            [](double u, double v) {
                const double phi = kPiD * (0.75 + 1.2 * u);
                const glm::dvec3 out(std::cos(phi), 0.0, std::sin(phi));
                return check::SurfaceSpot{out * kRadius + glm::dvec3(0, 0.01 + kTall * v, 0), -out};
            },
            check::mirror(0.9F, roughness), true);
    }
    b.perspective({0.2, 1.7, 2.4}, {0, 0.05, 0}, 0.7);
    return b.description();
}

[[nodiscard]] RenderResult renderFor(const Scene& scene, RenderRequest request, double seconds,
                                     const Workers& workers) {
    request.width = kWidth;
    request.height = kHeight;
    request.budget.seconds = 1e6;
    double began = 0.0;
    Progress progress;
    progress.interrupted = [&] {
        if (!(began > 0.0)) began = cpuSeconds();
        return cpuSeconds() - began >= seconds;
    };
    return render(scene, request, workers, progress);
}

[[nodiscard]] std::vector<Rgb> sumOf(const Image& image, std::initializer_list<const char*> layers) {
    std::vector<Rgb> values(image.pixels());
    for (const char* layer : layers)
        for (std::size_t i = 0; i < values.size(); ++i) values[i] += image.rgb(i, image.channel(layer));
    return values;
}

/// What is compared.
[[nodiscard]] std::vector<Rgb> shown(const Image& image) { return sumOf(image, {"caustic.R", "indirect.R"}); }

[[nodiscard]] double meanOf(const std::vector<Rgb>& values) {
    double sum = 0.0;
    for (const Rgb& v : values) sum += static_cast<double>(luminance(v));
    return sum / static_cast<double>(values.size());
}

struct Reference {
    std::array<std::vector<Rgb>, 2> values;
    std::vector<Rgb> picture;

    [[nodiscard]] double relMse(const std::vector<Rgb>& image) const {
        const double mean = meanOf(picture);
        double sum = 0.0;
        for (std::size_t i = 0; i < image.size(); ++i) {
            const double a = luminance(values[0][i]), b = luminance(values[1][i]), v = luminance(image[i]),
                         r = luminance(picture[i]);
            sum += (v - a) * (v - b) / (r * r + 0.01 * mean * mean);
        }
        return sum / static_cast<double>(image.size());
    }
};

/// A picture of one layer, its mean at middle grey.
void keep(const std::vector<Rgb>& values, const std::string& file) {
    Image image(kWidth, kHeight, {"R", "G", "B"});
    for (std::size_t i = 0; i < values.size(); ++i)
        image.setRgb(i, values[i] * static_cast<float>(0.2 / meanOf(values)));
    writePng(file, image, 0.0F);
}

void measure(std::string_view caster, double size, float roughness, const Arguments& arguments) {
    const Workers workers(1);
    SceneOptions options;
    options.lobeRules.castRoughness = options.lobeRules.glassCastRoughness = static_cast<float>(arguments.cast);
    const Scene scene(sceneOf(caster, size, roughness), std::nullopt, options, workers);
    Reference reference;
    for (std::uint64_t i = 0; i < 2; ++i) {
        RenderRequest request;
        request.method = Method::Reference;
        request.seed = 1000 + i;
        const Image image = renderFor(scene, request, 0.5 * arguments.reference, workers).image;
        reference.values[i] = shown(image);
        const std::vector<Rgb> picture = sumOf(image, {"emission.R", "direct.R", "caustic.R", "indirect.R"});
        reference.picture.resize(picture.size());
        for (std::size_t p = 0; p < picture.size(); ++p) reference.picture[p] += 0.5F * picture[p];
    }
    const auto file = [&](std::string_view way) {
        return fmt::format("{}/{}_{:g}_{:g}_{}.png", arguments.keep, caster, size, static_cast<double>(roughness), way);
    };
    if (!arguments.keep.empty()) keep(reference.values[0], file("reference"));
    std::string row = fmt::format("| {} | {:g} | {:g} |", caster, size, static_cast<double>(roughness));
    double best = std::numeric_limits<double>::infinity(), chosen = 0.0;
    for (const Way& way : kWays) {
        double mean = 0.0, seen = 0.0;
        for (std::uint64_t seed = 0; seed < arguments.seeds; ++seed) {
            RenderRequest request;
            request.seed = seed;
            request.settings.castRoughness = arguments.cast;
            if (way.setting != nullptr) setParameter(request.settings, way.setting, way.value);
            const std::vector<Rgb> values = shown(renderFor(scene, request, arguments.seconds, workers).image);
            if (!arguments.keep.empty()) keep(values, file(way.name));
            mean += reference.relMse(values) / static_cast<double>(arguments.seeds);
            seen += meanOf(values) / (meanOf(reference.values[0]) * static_cast<double>(arguments.seeds));
        }
        const std::string_view name = way.name;
        if (name == "default") chosen = mean;
        if ((name == "photons" || name == "chance") && seen >= kLeastSeen) best = std::min(best, mean);
        row += seen >= kLeastSeen ? fmt::format(" {:.2e} |", mean)
                                  : fmt::format(" {:.2e} ({:.0f} %) |", mean, 100.0 * seen);
    }
    fmt::print("{} {:.2f} |\n", row, chosen / best);
    std::fflush(stdout);
}

}  // namespace
}  // namespace pellucid

int main(int argc, char** argv) {
    using namespace pellucid;
    Arguments arguments;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string_view name = argv[i];
        if (name == "--seconds") arguments.seconds = std::atof(argv[i + 1]);
        if (name == "--reference") arguments.reference = std::atof(argv[i + 1]);
        if (name == "--seeds") arguments.seeds = static_cast<std::uint64_t>(std::atoi(argv[i + 1]));
        if (name == "--only") arguments.only = argv[i + 1];
        if (name == "--roughness") arguments.roughness = std::atof(argv[i + 1]);
        if (name == "--size") arguments.size = std::atof(argv[i + 1]);
        if (name == "--keep") arguments.keep = argv[i + 1];
        if (name == "--cast") arguments.cast = std::atof(argv[i + 1]);
    }
    fmt::print("| caster | lamp | roughness | photons | both | chance | default | default / better of the two |\n");
    fmt::print("|---|---|---|---|---|---|---|---|\n");
    for (const std::string_view caster : {"glass", "metal"})
        for (const double size : kSizes)
            for (const float roughness :
                 arguments.roughness < 0.0 ? kRoughness : std::vector{static_cast<float>(arguments.roughness)})
                if ((arguments.only.empty() || arguments.only == caster) &&
                    (!(arguments.size > 0.0) || arguments.size == size))
                    measure(caster, size, roughness, arguments);
    return 0;
}

#include <pellucid/render/settings.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include <pellucid/base/error.h>
#include <pellucid/base/nearest_name.h>
#include <pellucid/io/settings_file.h>

namespace pellucid {
namespace {

constexpr double kBillion = 1e9;

constexpr auto kParameters = std::to_array<Parameter>({
    {"path.mis", &Settings::misHeuristic, 0, 0, false, false, "balance|power", "",
     "heuristic that weights light sampling against surface sampling"},
    {"path.directions", &Settings::directions, 0, 0, false, false, "uniform|cosine|bsdf", "",
     "how directions are drawn at surfaces that are no perfect mirrors; what the lobes are worth"},
    {"path.lights", &Settings::lightStrategy, 0, 0, false, false, "none|nee|mis", "",
     "lamps are met by chance alone, sampled at every vertex, or both with weights"},
    {"path.sampler", &Settings::sampler, 0, 0, false, false, "independent|stratified|halton|sobol", "",
     "the numbers that the samples of a pixel use; all unbiased"},
    {"path.roulette", &Settings::rouletteThreshold, 0, 1e6, false, true, "", "throughput",
     "throughput below which Russian roulette may end a path; 0: never"},
    {"path.max_depth", &Settings::maxDepth, 0, 1e6, false, true, "", "vertices",
     "surface vertices of the longest path; 0: no limit. A limit loses light"},
    {"path.split", &Settings::split, 0, 0, true, false, "auto|on|off", "",
     "where the eye sees smooth glass reflection and refraction are both followed (by bdpt and sppm to the lamps "
     "alone); "
     "auto: not by path and bdpt, the plain baselines"},
    {"path.adaptive", &Settings::adaptive, 0, 0, true, false, "auto|on|off", "",
     "more samples for noisier pixels; auto: by photon and by reference where it path traces, unless --spp counts "
     "them"},
    {"surface.cast_roughness",
     &Settings::castRoughness,
     0,
     1,
     false,
     false,
     "",
     "roughness",
     "metal, coats and thin panes up to this roughness cast caustics by photons; rougher ones are path-traced",
     ParameterPass::CausticMap,
     {0.1, 0.6, false, 0.1}},
    {"surface.glass_cast_roughness", &Settings::glassCastRoughness, 0, 1, false, false, "", "roughness",
     "the same for bodies of glass, through which eye paths find lamps by chance alone"},
    {"photon.caustic",
     &Settings::causticPhotons,
     0,
     kBillion,
     true,
     true,
     "",
     "paths",
     "photon paths an iteration for the caustic map",
     ParameterPass::CausticMap,
     {0.1, 8, true}},
    {"photon.global",
     &Settings::globalPhotons,
     0,
     kBillion,
     true,
     true,
     "",
     "paths",
     "photon paths a generation of the cache, for the global map; sppm: an iteration, for all but caustics",
     ParameterPass::GlobalMap,
     {0.1, 8, true}},
    {"photon.radius",
     &Settings::causticRadius,
     0.01,
     1000,
     true,
     true,
     "",
     "pixels",
     "first radius of the caustic kernel, one for all pixels, in footprints; auto: chosen by place from the photons",
     ParameterPass::CausticMap,
     {0.5, 10}},
    {"photon.alpha",
     &Settings::alpha,
     0.01,
     1,
     false,
     false,
     "",
     "",
     "reduction of the radius, r^2 (i + alpha)/(i + 1); 1: the radius stays and so does its bias",
     ParameterPass::CausticMap,
     {0.4, 1}},
    {"photon.shrink", &Settings::shrink, 0, 0, false, false, "alpha|chi2", "",
     "what makes a kernel smaller. alpha: photon.alpha, by iterations (photon) or by the photons that the pixel has "
     "met (sppm); chi2: a test that tells the photons in it from even light",
     ParameterPass::CausticMap},
    {"photon.kernel", &Settings::kernel, 0, 0, false, false, "epanechnikov|uniform|cone|biweight", "",
     "how the caustic kernel weighs photons by distance; each is 1 over its disc", ParameterPass::CausticMap},
    {"photon.edges", &Settings::edges, 0, 0, false, false, "auto|on|off", "",
     "near an edge or a wall an estimate is divided by the part of its kernel that lies on the surface; auto: that of "
     "sppm's other photons than the caustics', whose kernels are wide",
     ParameterPass::CausticMap},
    {"photon.memory", &Settings::photonMemory, 1, 1e9, true, true, "", "MB",
     "memory that photons and their maps may take: fewer paths are shot, none is dropped; auto: no limit. Scene, image "
     "and cache come on top"},
    {"photon.guiding", &Settings::guiding, 0, 0, true, false, "auto|on|off", "",
     "emission of photons guided towards what the image uses", ParameterPass::CausticMap},
    {"photon.caustic_map", &Settings::causticMap, 0, 0, true, false, "auto|on|off", "",
     "caustics by photon map, or left to path tracing"},
    {"photon.chance", &Settings::chance, 0, 0, false, false, "on|off", "",
     "eye paths that go on over casters and meet the lamp share the caustics with the photons: for large lamps over "
     "rough casters",
     ParameterPass::CausticMap},
    {"reference.texel", &Settings::texelWidth, 0, 1000, false, true, "", "pixels",
     "width of the texels by which --method reference shows caustics in mirrors and through glass; 0: by eye paths"},
    {"reference.eye_paths", &Settings::referencePaths, 0, 0, false, false, "auto|path|bdpt", "",
     "what carries every other class of --method reference: path tracing or bidirectional paths; auto: path tracing "
     "where nothing point-like shines and there is an environment or no diffuse surface in view"},
    {"cache.mode", &Settings::cache, 0, 0, true, false, "auto|on|off", "",
     "indirect diffuse light by irradiance cache, or traced at every pixel"},
    {"cache.metric", &Settings::cacheMetric, 0, 0, false, false, "ward|tabellion|hessian", "",
     "how far a record speaks: by the mean distance of what it sees, by the nearest, or by the second derivatives of "
     "the "
     "irradiance",
     ParameterPass::Cache},
    {"cache.choice", &Settings::cacheChoice, 0, 0, false, false, "on|off", "",
     "where records would serve hardly a pixel each (fine leaves, bumpy normals) light is gathered pixel by pixel",
     ParameterPass::Cache},
    {"cache.guide", &Settings::cacheGuide, 0, 0, false, false, "on|off", "",
     "more gather rays where the photons near a record came from: a bright spot seen through a glass ball",
     ParameterPass::Cache},
    {"cache.error",
     &Settings::cacheError,
     0.001,
     10,
     true,
     true,
     "",
     "",
     "error that a record may have before a new one is made. Larger: fewer records and more bias",
     ParameterPass::Cache,
     {0.05, 1}},
    {"cache.rays",
     &Settings::gatherRays,
     16,
     1e6,
     true,
     true,
     "",
     "rays",
     "gather rays a record",
     ParameterPass::Cache,
     {64, 4096}},
    {"cache.min_spacing",
     &Settings::minSpacing,
     0,
     1000,
     true,
     true,
     "",
     "pixels",
     "least radius of a record, in pixel footprints",
     ParameterPass::Cache,
     {0.5, 16}},
    {"cache.max_spacing",
     &Settings::maxSpacing,
     0.1,
     1e6,
     true,
     true,
     "",
     "pixels",
     "largest radius of a record, in pixel footprints",
     ParameterPass::Cache,
     {5, 200}},
    {"camera.aperture", &Settings::aperture, 0, 1e6, false, true, "", "m", "diameter of the lens; 0: a pinhole"},
    {"camera.focus", &Settings::focus, 1e-6, 1e9, false, true, "", "m", "distance to the plane in focus"},
});

constexpr std::string_view kAutomaticWord = "auto";
constexpr std::string_view kTunedTable = "tuned.";

[[nodiscard]] std::string shortest(double value) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

[[nodiscard]] const Parameter& find(std::string_view name) {
    const auto row = std::ranges::find(kParameters, name, &Parameter::name);
    if (row != kParameters.end()) return *row;
    std::array<std::string_view, kParameters.size()> names;
    std::ranges::transform(kParameters, names.begin(), &Parameter::name);
    throw Error(ErrorKind::Usage, "there is no setting '" + std::string(name) + "'", "--set " + std::string(name),
                "the nearest name is '" + std::string(nearestName(name, names)) + "'");
}

/// A number with nothing before or after it; empty otherwise, and for one that is not finite.
[[nodiscard]] std::optional<double> parseNumber(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0.0;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

[[nodiscard]] bool isChoice(std::string_view choices, std::string_view word) {
    while (!choices.empty()) {
        const std::size_t end = std::min(choices.find('|'), choices.size());
        if (choices.substr(0, end) == word) return true;
        choices.remove_prefix(std::min(end + 1, choices.size()));
    }
    return false;
}

[[nodiscard]] std::string allowedValues(const Parameter& row) {
    if (!row.choices.empty()) return "one of " + std::string(row.choices);
    const bool whole = std::holds_alternative<int Settings::*>(row.member);
    std::string text = std::string(whole ? "a whole number" : "a number") + " from " + shortest(row.lower) + " to " +
                       shortest(row.upper);
    if (row.automatic) text += ", or auto";
    return text;
}

[[noreturn]] void refuse(const Parameter& row, std::string_view value) {
    throw Error(ErrorKind::Usage, "'" + std::string(value) + "' is no value of " + std::string(row.name),
                "--set " + std::string(row.name) + "=" + std::string(value), "give " + allowedValues(row));
}

/// The number that `value` states, checked against the row; -1 for an automatic choice.
[[nodiscard]] double checkedNumber(const Parameter& row, std::string_view value) {
    if (row.automatic && value == kAutomaticWord) return -1.0;
    const std::optional<double> number = parseNumber(value);
    if (!number) refuse(row, value);
    if (row.automatic && *number == -1.0) return -1.0;
    if (*number < row.lower || *number > row.upper) refuse(row, value);
    return *number;
}

struct Assign {
    Settings& settings;
    const Parameter& row;
    std::string_view value;

    void operator()(double Settings::*member) const { settings.*member = checkedNumber(row, value); }
    void operator()(int Settings::*member) const {
        const double number = checkedNumber(row, value);
        if (number != std::floor(number)) refuse(row, value);
        settings.*member = static_cast<int>(number);
    }
    void operator()(std::string Settings::*member) const {
        if (!isChoice(row.choices, value)) refuse(row, value);
        settings.*member = value;
    }
};

struct AsText {
    const Settings& settings;

    std::string operator()(double Settings::*member) const { return shortest(settings.*member); }
    std::string operator()(int Settings::*member) const { return std::to_string(settings.*member); }
    std::string operator()(std::string Settings::*member) const { return settings.*member; }
};

}  // namespace

std::span<const Parameter> parameters() noexcept { return kParameters; }

void setParameter(Settings& settings, std::string_view name, std::string_view value) {
    const Parameter& row = find(name);
    std::visit(Assign{settings, row, value}, row.member);
}

void loadSettings(Settings& settings, const std::string& file) {
    for (const SettingsFileEntry& entry : readSettingsFile(file)) {
        if (entry.key.starts_with(kTunedTable)) continue;
        try {
            setParameter(settings, entry.key, entry.value);
        } catch (const Error& error) {
            throw Error(ErrorKind::BadInput, error.problem(), file + ", line " + std::to_string(entry.line),
                        error.mend());
        }
    }
}

std::string tunedSceneHash(const std::string& file) {
    for (const SettingsFileEntry& entry : readSettingsFile(file))
        if (entry.key == std::string(kTunedTable) + "scene_hash") return entry.value;
    return "";
}

std::vector<std::pair<std::string, std::string>> settingsAsText(const Settings& settings) {
    std::vector<std::pair<std::string, std::string>> rows;
    rows.reserve(kParameters.size());
    for (const Parameter& row : kParameters)
        rows.emplace_back(std::string(row.name), std::visit(AsText{settings}, row.member));
    return rows;
}

}  // namespace pellucid

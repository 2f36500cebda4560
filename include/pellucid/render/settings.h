/// Every parameter by name: one table gives --set, --config, record.json, docs/options.md and the tuner the same names,
/// defaults, ranges and scales.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace pellucid {

/// Automatic choices are written as -1 (numbers) or "auto" (words): the plan resolves them.
struct Settings {
    // path tracing
    std::string misHeuristic = "power";  ///< path.mis: balance | power
    std::string directions = "bsdf";     ///< path.directions: uniform | cosine | bsdf
    std::string lightStrategy = "mis";   ///< path.lights: none | nee | mis
    std::string sampler = "sobol";       ///< path.sampler: independent | stratified | halton | sobol
    /// path.roulette: throughput below which Russian roulette may end a path; 0: never
    double rouletteThreshold = 1.0;
    int maxDepth = 0;               ///< path.max_depth: number of surface vertices; 0: no limit
    std::string split = "auto";     ///< path.split: auto | on | off
    std::string adaptive = "auto";  ///< path.adaptive: auto | on | off
    // surfaces
    double castRoughness = 0.3;       ///< surface.cast_roughness
    double glassCastRoughness = 1.0;  ///< surface.glass_cast_roughness
    // photons
    int causticPhotons = -1;              ///< photon.caustic: photon paths an iteration; -1: the plan sizes it
    int globalPhotons = -1;               ///< photon.global
    double causticRadius = -1.0;          ///< photon.radius: in pixel footprints
    double alpha = 2.0 / 3.0;             ///< photon.alpha: radius reduction
    std::string shrink = "alpha";         ///< photon.shrink: alpha | chi2
    std::string kernel = "epanechnikov";  ///< photon.kernel: epanechnikov | uniform | cone | biweight
    std::string edges = "auto";           ///< photon.edges: auto | on | off
    double photonMemory = -1.0;           ///< photon.memory: MB for photons and their maps; -1: no limit
    std::string guiding = "auto";         ///< photon.guiding: auto | on | off
    std::string causticMap = "auto";      ///< photon.caustic_map: auto | on | off
    std::string chance = "off";           ///< photon.chance: on | off
    // reference
    double texelWidth = 1.0;              ///< reference.texel: in pixel footprints; 0: off
    std::string referencePaths = "auto";  ///< reference.eye_paths: auto | path | bdpt
    // irradiance cache and gather
    std::string cache = "auto";           ///< cache.mode: auto | on | off
    std::string cacheMetric = "hessian";  ///< cache.metric: ward | tabellion | hessian
    std::string cacheChoice = "on";       ///< cache.choice: on | off
    std::string cacheGuide = "on";        ///< cache.guide: on | off
    double cacheError = -1.0;             ///< cache.error: Ward's a
    int gatherRays = -1;                  ///< cache.rays: gather rays a record
    double minSpacing = -1.0;             ///< cache.min_spacing: in pixel footprints
    double maxSpacing = -1.0;             ///< cache.max_spacing
    // camera
    double aperture = 0.0;  ///< camera.aperture: lens diameter in metres
    double focus = 1.0;     ///< camera.focus: in metres
};

/// The pass that a parameter belongs to: where the plan leaves the pass out, the parameter does nothing.
enum class ParameterPass { Any, CausticMap, GlobalMap, Cache };

/// Where the tuner looks for a better value. Both 0: only when it is told where.
struct TuningRange {
    double low = 0.0, high = 0.0;
    bool timesPlan = false;  ///< the range is in multiples of what the plan chose
    double step = 0.0;       ///< where each value costs a scene of its own; 0: any value
};

/// One row of the table.
struct Parameter {
    std::string_view name;  ///< as --set takes it, e.g. "cache.error"
    std::variant<double Settings::*, int Settings::*, std::string Settings::*> member;
    double lower, upper;       ///< allowed range of numbers (automatic -1 apart)
    bool automatic;            ///< -1 / "auto" allowed
    bool logScale;             ///< how the tuner steps through it
    std::string_view choices;  ///< words, separated by '|'
    std::string_view unit, help;
    ParameterPass pass = ParameterPass::Any;
    TuningRange tuning{};
};

[[nodiscard]] std::span<const Parameter> parameters() noexcept;

/// "name", "value" as typed. Throws Error{Usage} with the nearest name, or the range.
void setParameter(Settings& settings, std::string_view name, std::string_view value);

/// A TOML file of `section.key = value`; unknown names are errors that name file and line. The table [tuned], in which the
/// tuner says what it found and where, sets nothing.
void loadSettings(Settings& settings, const std::string& file);

/// Hash of the scene that a file of the tuner is for; empty for any other file.
[[nodiscard]] std::string tunedSceneHash(const std::string& file);

/// All parameters as (name, value) in the table's order.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> settingsAsText(const Settings& settings);

}  // namespace pellucid

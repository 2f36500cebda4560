/// The command line as values: parsed and checked for form, so that the commands see no text, and only the
/// files of options see CLI11.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <pellucid/render/render.h>
#include <pellucid/study/compare.h>
#include <pellucid/study/metrics.h>
#include <pellucid/study/tune.h>

namespace pellucid {

/// What means the same for every command that renders.
struct SceneArguments {
    std::string scene;
    std::string environment;  ///< file or "R,G,B"; empty: none
    std::string camera;
    int width = 0, height = 0;
    std::uint64_t seed = 0;
    int threads = 0;
    Method method = Method::Photon;
    Budget budget;
    Settings settings;             ///< defaults, then --config, then each --set in turn
    std::string config, tunedFor;  ///< the --config file, and the hash of the scene it was tuned for
    bool quiet = false;
};

/// One sample of a render.
struct SampleName {
    int x = 0, y = 0;
    std::uint32_t sample = 0;
};

struct RenderArguments {
    SceneArguments common;
    std::vector<std::string> outputs;
    float exposure = 0.0F;
    std::vector<std::string> layers;
    std::string record, checkpoint, cache, pointsFolder;
    std::string views;  ///< file of cameras, or "all": those of the scene; empty: one image
    bool resume = false;
    std::optional<SampleName> debugSample;  ///< replay this one instead of rendering
};

struct PlanArguments {
    SceneArguments common;
    bool json = false;
};

struct InfoArguments {
    SceneArguments common;  ///< scene, environment and threads only
    bool json = false;
};

struct DiffArguments {
    std::string reference;
    std::vector<std::string> images;
    bool json = false;
    std::optional<CropBox> crop;
    std::string map;
    std::vector<std::pair<std::string, double>> failAbove;
    bool exposureInvariant = false;
};

struct CompareArguments {
    SceneArguments common;  ///< its method and budget are not used
    std::vector<CompareMethod> methods;
    std::vector<double> times;
    int seeds = 8;  ///< common.seed is the first
    std::string folder, reference;
    double referenceTime = 0.0;
    std::string command;  ///< as typed, for the report
};

struct TuneArguments {
    SceneArguments common;  ///< its method and budget are not used
    double time = 0.0, budget = 0.0;
    int iterations = 0;  ///< in place of the budget when above 0
    std::vector<TuneOver> over;
    std::optional<TuneGoal> goal;
    std::string folder, reference;
    std::string command;  ///< as typed, for the report
};

struct CheckArguments {
    std::string filter;
    bool json = false, markdown = false, quick = false, quiet = false;
    bool list = false;         ///< names and what they guard, nothing is run
    bool sweeps = false;       ///< the sweeps of stiffness instead of the cases
    bool convergence = false;  ///< error against photons instead of the cases
    std::string plot;          ///< SVG of the sweeps or of the convergence; empty: none
    int threads = 0;
    std::uint64_t seed = 0;
};

/// --help, --version and options: text for standard output, and done.
struct TextArguments {
    std::string text;
};

using Arguments = std::variant<RenderArguments, PlanArguments, InfoArguments, DiffArguments, CompareArguments,
                               TuneArguments, CheckArguments, TextArguments>;

/// Throws Error{Usage}; Error{BadInput} for what is wrong inside of the --config file.
[[nodiscard]] Arguments parseArguments(int count, const char* const* values);

}  // namespace pellucid

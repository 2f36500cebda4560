/// Measuring for the checks: means over independent seeds with their confidence, by any method of the renderer.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>
#include <pellucid/study/check.h>
#include <pellucid/transport/photon.h>

#include "check_scenes.h"

namespace pellucid::check {

/// Independent repetitions of a measurement; more of them, each of fewer samples, where a render does not begin with
/// photons: Student's factor falls from 7.9 to 5.2 with twice the seeds, so that the same interval takes half the samples.
inline constexpr int kSeeds = 8, kManySeeds = 16;
/// Two-sided level of an interval: of the whole suite's figures together about one in a hundred runs with another seed
/// strays by chance.
inline constexpr double kStrayLevel = 1e-4;
/// What single precision and the ray offset may do to a mean, relative.
inline constexpr double kFloatAllowance = 1e-4;

struct Estimate {
    double mean = 0.0, interval = 0.0;
};
/// Mean of independent values with its confidence interval, by Student's t.
[[nodiscard]] Estimate estimate(std::span<const double> values);

/// The seed of a repetition.
[[nodiscard]] std::uint64_t seedOf(const CheckContext& context, int repetition);
/// once(seed) for each of `seeds` seeds, in their order. Tiny images occupy few threads, so the seeds run side by side:
/// `once` is called by several threads at a time.
template <class Once>
[[nodiscard]] auto forSeeds(const CheckContext& context, int seeds, Once&& once) {
    std::vector<decltype(once(context.seed))> values(static_cast<std::size_t>(seeds));
    context.workers.forEach(values.size(), 1,
                            [&](std::size_t i) { values[i] = once(seedOf(context, static_cast<int>(i))); });
    return values;
}

/// A finding from independent values. Allowance and resolution are relative to `expected` (absolute where that is 0).
[[nodiscard]] Finding findingOf(std::string quantity, double expected, double allowance, double resolution,
                                std::span<const double> values);
/// The same from forSeeds().
[[nodiscard]] Finding measureSeeds(const CheckContext& context, std::string quantity, double expected, double allowance,
                                   double resolution, const std::function<double(std::uint64_t seed)>& once,
                                   int seeds = kSeeds);

/// An exact figure: no statistics, an absolute allowance.
[[nodiscard]] Finding exact(std::string quantity, double expected, double measured, double allowance);

/// One method's share of a rendered case.
struct By {
    Method method = Method::Path;
    std::uint32_t samples = 16;  ///< a pixel and seed: kSeeds where photons come first, else kManySeeds
    double bias = 0.0;           ///< relative allowance; 0 for unbiased methods
    double resolution = 0.02;    ///< relative
    std::string layer = {};      ///< "direct", "caustic", ...; empty: all light
};

/// A scene that is rendered, and what the mean over its image must be.
struct Rendered {
    SceneDescription scene = {};
    std::optional<EnvironmentDescription> environment = {};
    double expected = 0.0;
    double toQuantity = 1.0;  ///< measured = mean radiance x this (pi / reflectance gives irradiance)
    std::string quantity = "radiance";
    std::vector<By> by = {};
    int size = 16;
    Settings settings = {};
};

/// Settings for tiny images: few global photons, so that a case takes a moment.
[[nodiscard]] Settings smallSettings();

/// One finding a method; one more where samples were not finite.
[[nodiscard]] std::vector<Finding> measure(const CheckContext& context, Rendered what);

/// The same by every method: those of bidirectional paths and the reference (paths and light tracing by class) that are not
/// listed join the others, under the claims of the first unbiased one, with a fourth of its samples and so coarser intervals.
/// Of caustics, where light paths that nothing guides must find the glass first, bidirectional paths take more of them.
[[nodiscard]] std::vector<Finding> measureByAll(const CheckContext& context, Rendered what);

/// One render of a scene that stands already.
[[nodiscard]] RenderResult renderOnce(const CheckContext& context, const Scene& scene, const By& by,
                                      const Settings& settings, int size, std::uint64_t seed);
[[nodiscard]] Scene makeScene(const CheckContext& context, SceneDescription description,
                              std::optional<EnvironmentDescription> environment = std::nullopt);
/// Mean over the image of a layer (empty: RGB), channel by channel, and the average of those.
[[nodiscard]] glm::dvec3 channelsOf(const Image& image, const std::string& layer = {});
[[nodiscard]] double meanOf(const Image& image, const std::string& layer = {});

/// Caustic photons of one pass, emission guided by what an earlier one found, back in metres and watts.
[[nodiscard]] PhotonList causticPhotons(const CheckContext& context, const Scene& scene, std::uint32_t paths,
                                        std::uint64_t seed);

}  // namespace pellucid::check

/// How the error of photon density estimation falls with the number of photons, on a caustic whose picture is known: a point
/// lamp near a plane mirror, whose light on the floor is that of its image, E = I cos / d^2. With radii that shrink as
/// n^(-1/6) variance and squared bias fall as n^(-2/3) [KnausZwicker2011]; with a radius that stays the bias does.
/// `pellucid check --convergence` measures, docs/benchmarks.md shows.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <pellucid/render/render.h>
#include <pellucid/study/check.h>
#include <pellucid/study/statistics.h>

namespace pellucid {

struct ConvergenceMethod {
    std::string label;
    Method method = Method::Photon;
    std::vector<std::pair<std::string, std::string>> settings;  ///< beyond those that all share
};

struct ConvergenceCurve {
    std::string label;
    std::vector<double> photons;  ///< paths a pixel
    std::vector<double> relmse;   ///< mean over seeds
    Interval slope;               ///< of log relmse over log photons, with the 95 % interval of the seeds
};

struct ConvergenceOptions {
    std::vector<std::uint32_t> iterations;  ///< each one emits a path for every pixel
    int seeds = 4;
    std::vector<ConvergenceMethod> methods;
};

/// Three decades, every way to shrink a kernel and one that does not.
[[nodiscard]] ConvergenceOptions wholeConvergence();

/// `done` is called after each curve.
[[nodiscard]] std::vector<ConvergenceCurve> measureConvergence(
    const CheckContext& context, const ConvergenceOptions& options,
    const std::function<void(const ConvergenceCurve&)>& done = {});

[[nodiscard]] std::string convergenceTable(const std::vector<ConvergenceCurve>& curves);
[[nodiscard]] std::string convergenceJson(const std::vector<ConvergenceCurve>& curves);
/// Both axes logarithmic, with a line of slope -2/3 beside the curves.
[[nodiscard]] std::string convergenceSvg(const std::vector<ConvergenceCurve>& curves);

}  // namespace pellucid

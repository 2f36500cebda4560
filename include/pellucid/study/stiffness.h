/// Stiffness: where a method breaks down. A dial (the size of a lamp, an albedo, a gap) is turned over decades in a scene
/// whose picture is known, and the error and the time of path tracing and of the photon method are noted at each step.
/// Nothing passes or fails here: `pellucid check --sweeps` measures, docs/validation.md shows.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <pellucid/study/check.h>

namespace pellucid {

/// The two methods that every sweep measures, in the order of SweepStep::by.
inline constexpr std::array<std::string_view, 2> kSweepMethods{"path", "photon"};

struct SweepFigures {
    double error = 0.0;     ///< root of the mean over pixels and seeds of ((I - R)/R)^2
    double bias = 0.0;      ///< mean(I)/mean(R) - 1 over all seeds
    double interval = 0.0;  ///< 95 % half width of the bias, over the seeds
    double seconds = 0.0;   ///< of one render, mean
    double rays = 0.0;      ///< of one render, mean
};

struct SweepStep {
    double value = 0.0;  ///< of the dial
    std::array<SweepFigures, kSweepMethods.size()> by{};
};

struct Sweep {
    std::string name, dial;  ///< "lamp size"; what the values are, with their unit
    std::string scene;       ///< one sentence
    std::string reference;   ///< what the picture must be
    std::string source;
    std::vector<SweepStep> steps;
};

/// A method breaks down at a step where its error is this many times that of the tame end, the first step, or of
/// kSmallError where that one is smaller: noise that was there from the start is no breakdown, but told as what it is.
inline constexpr double kBrokenFactor = 3.0, kSmallError = 0.1;

/// The first step where the method has broken down; empty: none.
[[nodiscard]] std::optional<std::size_t> breakdown(const Sweep& sweep, std::size_t method) noexcept;
/// The first step from which on no sample of any seed finds light: a black picture, whatever its error bar says.
[[nodiscard]] std::optional<std::size_t> blindness(const Sweep& sweep, std::size_t method) noexcept;
/// The first step whose bias is kCertainly times its interval and above kSmallBias; empty: none.
[[nodiscard]] std::optional<std::size_t> certainBias(const Sweep& sweep, std::size_t method) noexcept;
inline constexpr double kCertainly = 2.0, kSmallBias = 0.02;

/// One sentence about a method: that it holds over the whole sweep, or every way in which it does not.
[[nodiscard]] std::string sweepVerdict(const Sweep& sweep, std::size_t method);

[[nodiscard]] std::vector<std::string_view> sweepNames();

/// All sweeps whose name holds `filter`. `done` is called after each step, with those so far.
[[nodiscard]] std::vector<Sweep> runSweeps(const CheckContext& context, std::string_view filter,
                                           const std::function<void(const Sweep&)>& done = {});

[[nodiscard]] std::string sweepsTable(const std::vector<Sweep>& sweeps);
[[nodiscard]] std::string sweepsJson(const std::vector<Sweep>& sweeps);
/// A section of docs/validation.md; `picture`: the file that sweepsSvg was written to, as the page names it; empty: none.
[[nodiscard]] std::string sweepsMarkdown(const std::vector<Sweep>& sweeps, std::string_view picture);
/// One panel a dial: error above, seconds below, both axes logarithmic.
[[nodiscard]] std::string sweepsSvg(const std::vector<Sweep>& sweeps);

}  // namespace pellucid

/// What the tuner may change and how: each parameter is a coordinate from 0 to 1 along its own scale, and a candidate
/// is the list of the settings in which it departs from those asked for.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <pellucid/render/render.h>
#include <pellucid/study/tune.h>

namespace pellucid {

/// Settings by name, in the order of the parameter table; empty: as asked for, which is the default.
using SettingList = std::vector<std::pair<std::string, std::string>>;

[[nodiscard]] std::string textOf(const SettingList& list);  ///< "cache.error=0.2; cache.rays=640", or "default"
void inTableOrder(SettingList& list);
[[nodiscard]] Settings withSettings(Settings settings, const SettingList& list);

struct Candidate {
    std::string origin;  ///< where it comes from: "default", "Radiance", "Sobol point", ...
    SettingList set;
};

/// One coordinate of the search.
struct Dimension {
    const Parameter* row = nullptr;
    double low = 0.0, high = 0.0;
    std::vector<std::string> words;
    std::string standard;  ///< what the plan chose; "auto" where it chose no number (a radius pixel by pixel, say)

    [[nodiscard]] bool hasStandard() const noexcept { return standard != "auto"; }
    /// As --set takes it, with three significant digits; `position` 0 .. 1 along the range.
    [[nodiscard]] std::string valueAt(double position) const;
    /// Clamped to the range; the middle for "auto".
    [[nodiscard]] double positionOf(const std::string& value) const;
};

class SearchSpace {
public:
    /// `plan` is what the renderer decided for the settings asked for. Without `over` the parameters with a declared
    /// range are searched whose pass the plan uses. Throws Error{Usage} when nothing is left to search.
    SearchSpace(const std::vector<TuneOver>& over, const Settings& asked, const RenderRecord& plan, bool glossy);

    [[nodiscard]] const std::vector<Dimension>& dimensions() const noexcept { return dimensions_; }
    [[nodiscard]] std::size_t size() const noexcept { return dimensions_.size(); }

    /// A candidate for each point of the unit cube: a parameter that the plan can choose is left to it in the lower half of
    /// its coordinate (what it does there may be more than a number: growing counts, say), and runs through its range in
    /// the upper half.
    [[nodiscard]] Candidate at(const std::vector<double>& coordinates, std::string origin) const;
    /// Where a candidate's values lie in their ranges; the plan's value where it does not depart.
    [[nodiscard]] std::vector<double> positions(const Candidate& candidate) const;
    /// Whether the candidate departs in searched parameters only.
    [[nodiscard]] bool contains(const Candidate& candidate) const;
    /// Whether it may be the result: with --over only what that names may be changed.
    [[nodiscard]] bool allows(const Candidate& candidate) const;

private:
    std::vector<Dimension> dimensions_;
    bool byPlan_;
};

/// Whether the plan runs the pass.
[[nodiscard]] bool usesPass(const RenderRecord& plan, ParameterPass pass);

/// Customary settings of other renderers, in this renderer's terms; what belongs to passes left out is dropped, and so
/// is what then has nothing left.
[[nodiscard]] std::vector<Candidate> peersSettings(const RenderRecord& plan, std::size_t pixels);

}  // namespace pellucid

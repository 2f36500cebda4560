/// The indirect side of a render: generations of global photons and cache records, each better than the last. A generation
/// serves many iterations; it can come from a file or from other views, and be handed on to them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <pellucid/base/progress.h>

#include "cache_builder.h"
#include "cache_file.h"
#include "checkpoint.h"
#include "learnt_light.h"
#include "pacing.h"
#include "point_cloud.h"
#include "prepared_view.h"
#include "stages.h"

namespace pellucid {

class IndirectLight {
public:
    explicit IndirectLight(const PreparedView& view) : view_(view) {}

    /// Reads the request's cache file: what is there is where the first generation begins.
    void load();
    /// Writes it, unless that was done as soon as the first generation had added to it.
    void saveAtEnd() const {
        if (!loaded_) save();
    }
    /// The next generation adds to `known`, or where nothing is known has this number.
    void startFrom(std::optional<LearntLight> known, std::uint32_t generation);
    /// All iterations read `light` as it is.
    void freeze(const LearntLight& light) { frozen_ = light; }

    /// Whether a new generation should be made before the next iteration. `eyes`: what eye passes have cost.
    [[nodiscard]] bool due(const Pace& pace, const StageRecord& eyes) const;
    /// Makes it: fresh global photons and fresh records, with an error bound that tightens; or what is known, and more of it.
    /// `maps`: those of the caustic side. A budget of time cuts it short, and so does `progress`: false, and records and
    /// state() are as they were before, but that the first one's records stay as far as they came.
    bool renew(const Maps& maps, RenderClock& clock, const Progress& progress);
    /// How many times as many gather rays the running generation's records should have had, by what noise they and the eye
    /// leave in the image; 1: as they are. Asked before an iteration that makes no new generation.
    [[nodiscard]] double refinement(const Pace& pace, const StageRecord& eyes) const;
    /// Makes the running generation's records anew, with so many times as many gather rays of the same map. Where `progress`
    /// cuts it short: false, and records and state() are as they were before.
    bool refine(double factor, const Maps& maps, RenderClock& clock, const Progress& progress);
    /// Tells it of eye rays that the running generation has served.
    void served(std::uint64_t rays) noexcept {
        state_.raysSince += static_cast<double>(rays);
        state_.raysServed += static_cast<double>(rays);
    }

    /// What was decided on the way, beyond the plan.
    [[nodiscard]] const std::optional<Decision>& decision() const noexcept { return decision_; }
    /// What of Maps is the indirect side's.
    void giveTo(Maps& maps) const noexcept;
    [[nodiscard]] const LearntLight& light() const noexcept { return light_; }
    [[nodiscard]] LearntLight takeLight() noexcept { return std::move(light_); }
    /// Of the running generation, for point clouds.
    [[nodiscard]] StoredPoints stored() const;
    /// Adds what the request's layers ask of the cache.
    void addLayers(Image& image) const;
    [[nodiscard]] const ReuseReport& reuse() const noexcept { return reuse_; }
    [[nodiscard]] const StageRecord& globalStage() const noexcept { return globalStage_; }
    [[nodiscard]] const StageRecord& cacheStage() const noexcept { return cacheStage_; }
    [[nodiscard]] double seconds() const noexcept { return globalStage_.seconds + cacheStage_.seconds; }
    [[nodiscard]] std::uint64_t rays() const noexcept { return globalStage_.rays + cacheStage_.rays; }

    [[nodiscard]] const GenerationState& state() const noexcept { return state_; }
    /// Makes the running generation again: keyed by seed and number, it is the same. False where `progress` cut it short.
    bool restoreFrom(const GenerationState& state, const Maps& maps, RenderClock& clock, const Progress& progress);

private:
    void save() const;
    void useFrozen();
    [[nodiscard]] LearntLight nextGeneration();
    /// The next one, with its records made again so often at once.
    bool makeGeneration(std::uint32_t refinements, const Maps& maps, RenderClock& clock, const Progress& progress);
    [[nodiscard]] double patience(const Pace& pace) const;
    [[nodiscard]] bool hasRoomForNext(const Pace& pace, const StageRecord& eyes, double raysBefore) const;
    [[nodiscard]] std::unique_ptr<const GatherGuide> makeMap(LearntLight& light, const Maps& maps);
    [[nodiscard]] CacheBuild makeRecords(const LearntLight& light, const GatherGuide* guide, const Maps& maps,
                                         RenderClock& clock, const std::function<bool()>& cut);

    const PreparedView& view_;
    LearntLight light_;                         ///< of the running generation
    std::optional<LearntLight> known_;          ///< to start from
    std::optional<LearntLight> frozen_;         ///< for the whole render
    std::unique_ptr<const GatherGuide> guide_;  ///< from the photons of its map
    std::vector<std::uint8_t> plain_;           ///< pixels that the last records made leave to plain gather
    bool loaded_ = false;
    double raysLoaded_ = 0.0;
    std::optional<Decision> decision_;
    ReuseReport reuse_;
    GenerationState state_;
    double recordRaysOfGeneration_ = 0.0, secondsOfGeneration_ = 0.0;
    StageRecord globalStage_{"global photons"}, cacheStage_{"irradiance cache"};
};

/// What a cache file of this view has to match.
[[nodiscard]] CacheKey fileKey(const PreparedView& view);

}  // namespace pellucid

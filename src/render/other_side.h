/// The other side of progressive photon mapping: fresh photons in every iteration that came neither directly nor over S alone,
/// and a kernel for each pixel. Its first radius is fitted to the photons of the first iteration; then the pixel's own
/// statistics shrink it. [HachisukaJensen2009] Without work where the plan has no such photons.
#pragma once

#include <cstdint>
#include <memory>

#include <pellucid/transport/caustic_map.h>
#include <pellucid/transport/kernel_radius.h>
#include <pellucid/transport/progressive_radii.h>

#include "checkpoint.h"
#include "prepared_view.h"

namespace pellucid {

/// Of the first kernel of these photons: indirect light is soft, and the photons are few.
[[nodiscard]] KernelRadiusOptions otherRadiusOptions(const Settings& settings);
/// Of the scene's radius: the largest of these kernels.
constexpr float kMaxOtherRadius = 0.1F;
/// Where these photons are of use: their kernels reach farther than those of caustics.
[[nodiscard]] VisibleCells visibleToOthers(const Scene& scene, const Survey& seen, const Settings& settings);

class OtherSide {
public:
    explicit OtherSide(const PreparedView& view);

    /// The map of this iteration.
    void pass(std::uint32_t iteration);
    /// What of Maps is this side's.
    void giveTo(Maps& maps) const noexcept;

    /// Radius of the kernel that a pixel looks up with, in footprints.
    [[nodiscard]] float kernelFootprints(int x, int y) const noexcept;
    /// What the pixel's first look-up of this iteration met. Only the thread that owns the pixel.
    void met(std::size_t pixel, const KernelTally& tally) noexcept {
        if (shrink_) shrink_->update(pixel, tally);
    }

    [[nodiscard]] const StageRecord& stage() const noexcept { return stage_; }

    void saveTo(CheckpointState& state) const;
    /// False when the bytes do not fit.
    [[nodiscard]] bool restoreFrom(const CheckpointState& state);

private:
    const PreparedView& view_;
    std::unique_ptr<VisibleCells> visible_;
    std::unique_ptr<KernelRadii> first_;  ///< none: one radius for all pixels
    std::unique_ptr<ProgressiveRadii> shrink_;
    std::unique_ptr<CausticMap> map_;
    StageRecord stage_{"other photons"};
};

}  // namespace pellucid

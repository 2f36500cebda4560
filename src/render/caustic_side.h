/// The caustic side of a render: fresh photons for the caustic map in every iteration, and kernels that fit them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <pellucid/render/film.h>
#include <pellucid/transport/caustic_map.h>
#include <pellucid/transport/kernel_radius.h>
#include <pellucid/transport/progressive_radii.h>

#include "caustic_use.h"
#include "checkpoint.h"
#include "photon_source.h"
#include "prepared_view.h"

namespace pellucid {

class CausticSide {
public:
    explicit CausticSide(const PreparedView& view);

    /// The map of this iteration. Kernels learn from its photons and from what `film` shows so far, the source from both.
    void pass(PhotonSource& source, const Film& film, std::uint32_t iteration);

    /// What eye paths know of the caustics: all of Maps but the indirect side's part.
    [[nodiscard]] Maps maps(const PhotonSource& source) const noexcept;
    /// Radius of the kernel that a pixel looks up with, in footprints.
    [[nodiscard]] float kernelFootprints(int x, int y) const noexcept;

    /// What the pixel's first look-up of this iteration met. Only the thread that owns the pixel.
    void met(std::size_t pixel, const KernelTally& tally) noexcept {
        if (shrink_) shrink_->update(pixel, tally);
    }
    [[nodiscard]] bool wantsTally() const noexcept { return shrink_ != nullptr; }

    /// Of all passes, with those before a break, which decide alike after it.
    [[nodiscard]] std::uint64_t raysSoFar() const noexcept { return raysBefore_ + stage_.rays; }
    /// Light paths for the iterations to come: `factor` times the mean of the first `iterations`, within the plan's bounds.
    [[nodiscard]] std::uint32_t pathsFor(double factor, std::uint32_t iterations) const noexcept;

    /// After the eye pass of an iteration.
    void countUse();
    /// How many photons of the first iteration were used, pair by pair of lamp and caster.
    void tellUse(std::vector<CausticLink>& links) const {
        if (use_) use_->tell(links);
    }

    /// Of the last pass.
    [[nodiscard]] PhotonList photons() const { return map_ ? map_->photons() : PhotonList(); }
    [[nodiscard]] const StageRecord& stage() const noexcept { return stage_; }

    void saveTo(CheckpointState& state) const;
    /// False when the bytes do not fit.
    [[nodiscard]] bool restoreFrom(const CheckpointState& state);

private:
    void shrinkKernels(std::uint32_t iteration) noexcept;
    void fitRadii(const Film& film, std::uint32_t iteration);
    void weighByNeed(std::vector<UsefulEmission>& useful, const Film& film) const;
    [[nodiscard]] std::uint64_t emittedSoFar() const noexcept { return emittedBefore_ + stage_.photonsEmitted; }

    const PreparedView& view_;
    std::unique_ptr<KernelRadii> radii_;        ///< none: one radius for all pixels
    std::unique_ptr<ProgressiveRadii> shrink_;  ///< none: all pixels alike, by radiusScale_
    std::unique_ptr<CausticMap> map_;
    std::optional<CausticUse> use_;                     ///< from the first pass on
    bool watching_ = false;                             ///< in this iteration
    double radiusScale_ = 1.0;                          ///< squared
    std::uint64_t raysBefore_ = 0, emittedBefore_ = 0;  ///< before a break
    StageRecord stage_{"caustic photons"};
};

}  // namespace pellucid

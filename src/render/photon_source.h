/// Where light paths start: how many of an iteration, and the guide that learns from those that were of use.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <pellucid/transport/emission_guide.h>

#include "checkpoint.h"
#include "prepared_view.h"

namespace pellucid {

/// Iterations 0, 1, 3, 7, ...: guide and kernels learn from their photons.
[[nodiscard]] constexpr bool isLearningIteration(std::uint32_t iteration) noexcept {
    return (iteration & (iteration + 1)) == 0;
}

class PhotonSource {
public:
    /// `training`: what the plan's pilot has learnt.
    PhotonSource(const PreparedView& view, std::vector<UsefulEmission> training);

    /// Only where the plan has a pass of photons.
    [[nodiscard]] const EmissionGuide& guide() const noexcept { return *guide_; }
    /// Of an iteration to come.
    [[nodiscard]] std::uint32_t paths() const noexcept { return paths_; }
    void setPaths(std::uint32_t paths) noexcept { paths_ = paths; }
    /// As Maps wants it.
    [[nodiscard]] float photonsPerEtendue() const noexcept;

    /// Whether what was useful in this iteration is wanted.
    [[nodiscard]] bool learnsFrom(std::uint32_t iteration) const noexcept;
    void learn(std::vector<UsefulEmission> useful);
    [[nodiscard]] bool guided() const noexcept { return !training_.empty(); }

    void saveTo(CheckpointState& state) const;
    /// False when the bytes do not fit.
    [[nodiscard]] bool restoreFrom(const CheckpointState& state);

private:
    void makeGuide();

    const PreparedView& view_;
    std::vector<UsefulEmission> training_;
    std::uint32_t paths_;
    std::unique_ptr<EmissionGuide> guide_;
};

}  // namespace pellucid

/// The light side of a render: light tracing for the caustics that the camera sees directly, and for a reference texels for
/// those that it sees in mirrors and through glass.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <pellucid/transport/light_trace.h>
#include <pellucid/transport/texel_irradiance.h>

#include "photon_source.h"
#include "prepared_view.h"

namespace pellucid {

class LightSide {
public:
    explicit LightSide(const PreparedView& view);

    /// What the light paths of this iteration leave on the film. The source learns from them.
    [[nodiscard]] std::vector<LightSplat> pass(PhotonSource& source, std::uint32_t iteration);

    [[nodiscard]] TexelReport texels() const;
    [[nodiscard]] const StageRecord& stage() const noexcept { return stage_; }

private:
    const PreparedView& view_;
    std::unique_ptr<TexelIrradiance> texels_;   ///< none: the plan has none
    std::unique_ptr<TexelIrradiance> bounced_;  ///< beside them, for what caustics make in turn
    StageRecord stage_{"light tracing"};
};

}  // namespace pellucid

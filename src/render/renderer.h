/// The loop of iterations: each one makes the maps, traces light and eye paths, and leaves a usable image. It holds the
/// parts and hands each what it needs of the others; what a part knows is in its own header.
#pragma once

#include <cstdint>
#include <string_view>

#include <pellucid/base/progress.h>
#include <pellucid/render/film.h>
#include <pellucid/render/render.h>

#include "caustic_side.h"
#include "eye_side.h"
#include "indirect_light.h"
#include "light_side.h"
#include "other_side.h"
#include "pacing.h"
#include "photon_source.h"
#include "prepared_view.h"
#include "stages.h"

namespace pellucid {

class Renderer {
public:
    /// Prepares the view. Keeps references to all four.
    Renderer(const Scene& scene, const RenderRequest& request, const Workers& workers, const Progress& progress);

    /// For a flythrough: all iterations read `light` and nothing is added.
    void freeze(const LearntLight& light) { indirect_.freeze(light); }

    [[nodiscard]] RenderResult run();
    /// The record of one iteration, for what each pass costs.
    [[nodiscard]] RenderRecord plan();
    [[nodiscard]] SampleReplay replay(PixelAt at, std::uint32_t sample);

private:
    /// False where a stop cut its records short: then it is left out, but for the first, whose picture is all that there is.
    [[nodiscard]] bool iterate();
    /// Of the indirect side, where they are due. False where a stop cut them short.
    [[nodiscard]] bool makeRecords();
    void shootPhotons();
    void renewShares();
    void tracePixels();
    [[nodiscard]] TransportContext eyeContext() const noexcept;
    [[nodiscard]] PhotonSides photons() noexcept { return {caustics_, others_}; }
    [[nodiscard]] SampleReplay replayBidirectional(PixelAt at) const;
    [[nodiscard]] SampleReplay replayWalk(PixelAt at);

    [[nodiscard]] Pace pace() const;
    [[nodiscard]] std::uint32_t samplesPerPixel() const;
    void tell(std::string_view stage) const;
    [[nodiscard]] RenderResult result(bool interrupted) const;
    [[nodiscard]] RenderRecord record() const;
    void save() const;
    void saveWhenDue(bool now);
    /// False where a stop cut the records short that it makes again.
    [[nodiscard]] bool resume();

    const Progress& progress_;
    RenderClock clock_;
    PreparedView view_;
    Film film_;
    PhotonSource source_;
    CausticSide caustics_;
    OtherSide others_;
    IndirectLight indirect_;
    LightSide lights_;
    EyeSide eyes_;
    std::uint32_t iteration_ = 0;
    bool cutShort_ = false;  ///< by a stop, in the first iteration: no render may go on from it
    double secondsOfIteration_ = 0.0, lastSave_ = 0.0;
};

}  // namespace pellucid

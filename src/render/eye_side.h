/// The eye side of a render: samples of every pixel, and how many each takes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <pellucid/render/film.h>
#include <pellucid/transport/bidirectional.h>
#include <pellucid/transport/walk.h>

#include "caustic_side.h"
#include "checkpoint.h"
#include "other_side.h"
#include "penumbrae.h"
#include "prepared_view.h"
#include "stages.h"

namespace pellucid {

struct PixelAt {
    int x = 0, y = 0;
};

/// Whose photons eye paths look up, and who learns what they met.
struct PhotonSides {
    CausticSide& caustics;
    OtherSide& others;
};

class EyeSide {
public:
    explicit EyeSide(const PreparedView& view) : view_(view), penumbrae_(view.camera.width(), view.camera.height()) {}

    /// Whether the samples are shared out anew after so many iterations: after 2, 4, 8, ...
    [[nodiscard]] bool renewsShares(std::uint32_t samples) const noexcept;
    /// Then samples go where the noise is. Returns how many times more photon paths would serve best; empty: their number
    /// stays.
    [[nodiscard]] std::optional<double> renewShares(Film& film, const CausticSide& caustics, std::uint32_t iteration);

    /// The samples of one iteration, all that `film` has as shares. Returns the rays, of the whole image.
    std::uint64_t pass(const TransportContext& context, const PhotonSides& photons, Film& film, RenderClock& clock);
    /// An eye path and a light path for every pixel. `splats`: of a light pass before this one.
    void bidirectionalPass(std::vector<LightSplat> splats, Film& film);

    /// How a pixel's samples of this iteration look up photons.
    [[nodiscard]] PixelKernels kernelsAt(const PhotonSides& photons, PixelAt at) const;
    /// Sample `number` of a pixel in this iteration: keyed by seed, pixel and how many went before, whatever was sampled
    /// elsewhere.
    [[nodiscard]] LayeredRadiance sample(Walk& walk, const Film& film, const PixelKernels& kernels, PixelAt at,
                                         int number, FirstHit& first, StringSums* strings = nullptr,
                                         ShadowTally* shadows = nullptr) const;
    /// The same, with a light path of its own number beside the eye path.
    [[nodiscard]] LayeredRadiance sample(Bidirectional& paths, const Film& film, PixelAt at,
                                         std::vector<LightSplat>& splats, FirstHit& first,
                                         StringSums* strings = nullptr) const;
    [[nodiscard]] Bidirectional bidirectional() const noexcept;

    [[nodiscard]] const StageRecord& stage() const noexcept { return stage_; }

    void saveTo(CheckpointState& state) const { state.penumbrae = penumbrae_.save(); }
    [[nodiscard]] bool restoreFrom(const CheckpointState& state) { return penumbrae_.restore(state.penumbrae); }

private:
    /// Calls body(tile, pixels of the tile as callback) in parallel.
    template <class Body>
    void forTiles(const Body& body) const;
    [[nodiscard]] std::size_t tiles() const noexcept;
    struct Strings {
        StringSums ofPixel, ofSample;
    };
    /// All samples of one pixel in this iteration.
    void addSamples(Walk& walk, Strings& strings, PixelAt at, const PhotonSides& photons, Film& film);

    const PreparedView& view_;
    Penumbrae penumbrae_;  ///< where maps serve receivers
    StageRecord stage_{"eye pass"};
};

}  // namespace pellucid

/// The ledger: which class a light path belongs to and which estimator carries it. Written down here and nowhere else.
///
/// Each lobe is Specular (S: casts caustics), Glossy (G: neither) or Diffuse (D: receives), a fixed property in every pass.
/// For the four layers G counts as a non-casting surface, written X for "G or D":
///   emission  E S* L            direct  E S* X L            caustic  E S* X S+ L            indirect  everything else
///
/// Estimators of the photon method, by the first D vertex x seen from the eye and, behind it, the next D vertex y:
///   no x                        E (S|G)* L                path tracing (next-event estimation with MIS at every G)
///   light reaches x at once     E (S|G)* D L              next-event estimation at x
///   light comes over S only     E (S|G)* D S+ L           the caustic map, which holds L S+ D photons only; a path from x
///                                                         that meets a lamp over S alone adds 0
///   over S and at least one G   E (S|G)* D S* G (S|G)* L  path tracing inside the gather
///   over another D vertex y     E (S|G)* D (S|G)* D ...   irradiance cache / gather; at y the global map (all photons)
/// A pass that the plan leaves out hands its class back to path tracing, never to nothing.
#pragma once

#include <array>
#include <cstdint>

#include <pellucid/math/rgb.h>

namespace pellucid {

enum class PathClass : std::uint8_t { Emission, Direct, Caustic, Indirect };
inline constexpr int kPathClasses = 4;

/// Radiance by path class; their sum is the pixel.
struct LayeredRadiance {
    std::array<Rgb, kPathClasses> layer{Rgb(0.0F), Rgb(0.0F), Rgb(0.0F), Rgb(0.0F)};

    [[nodiscard]] Rgb& operator[](PathClass c) noexcept { return layer[static_cast<std::size_t>(c)]; }
    [[nodiscard]] const Rgb& operator[](PathClass c) const noexcept { return layer[static_cast<std::size_t>(c)]; }
    [[nodiscard]] Rgb total() const noexcept { return layer[0] + layer[1] + layer[2] + layer[3]; }
};

/// Reads a path's vertices from the eye on.
class EyeLedger {
public:
    /// The path goes over a vertex by a lobe that casts caustics (S) or not (X).
    void pass(bool casts) noexcept {
        if (casts)
            state_ = state_ == State::DirectReceiver ? State::CausticChain : state_;
        else
            state_ = state_ == State::Eye ? State::DirectReceiver : State::Other;
    }

    /// The class if the path ends at a light now.
    [[nodiscard]] PathClass atLight() const noexcept { return static_cast<PathClass>(state_); }
    /// The class if it goes over one more vertex and then ends at a light.
    [[nodiscard]] PathClass atLightAfter(bool casts) const noexcept {
        EyeLedger next = *this;
        next.pass(casts);
        return next.atLight();
    }

private:
    /// In the order of PathClass: E S*, E S* X, E S* X S+, all else.
    enum class State : std::uint8_t { Eye, DirectReceiver, CausticChain, Other };
    State state_ = State::Eye;
};

}  // namespace pellucid

/// Dispersion: the ior of a body of smooth glass by wavelength, and wavelengths for paths that meet one.
///
/// A path has no wavelength until it meets such a body. There one is drawn, and each channel is weighted by how much of it
/// that wavelength makes up; it holds along one chain of delta lobes and is forgotten at the first other one, so that what
/// passes between two such chains is RGB as everywhere. A path from the eye and one from a light thus mean the same.
#pragma once

#include <pellucid/math/rgb.h>

namespace pellucid {

/// A wavelength in nm, or (0) none yet.
struct Wave {
    float nanometres = 0.0F;
    [[nodiscard]] bool chosen() const noexcept { return nanometres > 0.0F; }
};

inline constexpr float kShortestWave = 390.0F, kLongestWave = 720.0F;  ///< nm

/// Cauchy's two terms by the ior at 587.6 nm and the Abbe number 20 / dispersion [KHR_materials_dispersion]; at least 1.
[[nodiscard]] float iorAt(float ior, float dispersion, Wave wave) noexcept;

/// What of linear Rec.709 light of one watt a channel lies at this wavelength, per nm: each channel's integral from
/// kShortestWave to kLongestWave is 1. The observer of [WymanSloanShirley2013]; what spectral colours have below 0 is cut off,
/// so that they come out a little pale.
[[nodiscard]] Rgb channelsAt(float nanometres) noexcept;

struct WaveSample {
    Wave wave;
    Rgb weight;  ///< channelsAt() over the density: means 1 in each channel, at most 3, its sum always 3
};
/// Drawn in proportion to the mean of channelsAt(). `u` in [0,1).
[[nodiscard]] WaveSample sampleWave(float u) noexcept;

}  // namespace pellucid

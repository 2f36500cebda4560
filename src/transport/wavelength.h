/// Where a path that has no wavelength yet takes one: at the first body of glass that disperses, before it scatters there.
#pragma once

#include <pellucid/math/sampler.h>
#include <pellucid/scene/scene.h>
#include <pellucid/surface/dispersion.h>

namespace pellucid::wavelength {

[[nodiscard]] inline bool isDue(const Scene& scene, const SurfacePoint& point, Wave wave) noexcept {
    return !wave.chosen() && scene.surfaces().disperses(point);
}

/// Draws it with the sampler's next number. Returns what the path's light is to be multiplied with.
[[nodiscard]] inline Rgb choose(Wave& wave, Sampler& sampler) noexcept {
    const WaveSample sample = sampleWave(sampler.next1D());
    wave = sample.wave;
    return sample.weight;
}

/// Of samplers: beyond what paths use elsewhere; one a vertex.
inline constexpr std::uint64_t kDimension = 5ULL << 20U;

}  // namespace pellucid::wavelength

/// A few path-traced samples before the render, to see whether indirect diffuse light is worth a pass of its own.
#pragma once

#include <cstdint>

#include <pellucid/base/parallel.h>
#include <pellucid/scene/camera.h>
#include <pellucid/transport/walk.h>

namespace pellucid {

struct EyePilot {
    /// Of the variance that path tracing leaves to this method, relative to each pixel's brightness as relmse counts it: the
    /// part that goes if light from E .. D on, but for direct light and caustics, is known.
    double indirectShare = 1.0;
    std::uint64_t rays = 0;
    double seconds = 0.0;
};

/// `pixels`: how many are looked at, or fewer where paths are long. `causticsApart`: a map holds the caustics.
[[nodiscard]] EyePilot pilotEyePaths(const TransportContext& context, const Camera& camera, std::uint64_t seed,
                                     bool causticsApart, std::size_t pixels, const Workers& workers);

}  // namespace pellucid

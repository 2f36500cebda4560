/// Which medium a segment of a path runs in: absorbing bodies as both the eye's and the lights' paths must see them, so
/// that one path has the same transmittance from either end.
#pragma once

#include <cmath>

#include <pellucid/scene/scene.h>

namespace pellucid::medium {

/// Absorption (per scene unit) of the segment that ended at this hit. Whoever meets a body's face from inside has come
/// through that body, whatever was carried along; nested bodies and cameras inside of one come out right by this.
[[nodiscard]] inline Rgb beforeHit(const Scene& scene, const SurfacePoint& point, const Bsdf& bsdf,
                                   const Rgb& carried) noexcept {
    if (!bsdf.bordersVolume()) return carried;
    if (bsdf.backSide()) return scene.surfaces().materials()[point.material].absorption;
    return point.beyond == kAir ? carried : scene.surfaces().absorptionBefore(point);
}

/// Absorption of a segment that leaves this surface, on the side that `bsdf` was asked from or, `transmitted`, beyond it.
[[nodiscard]] inline Rgb afterHit(const Scene& scene, const SurfacePoint& point, const Bsdf& bsdf, const Rgb& before,
                                  bool transmitted) noexcept {
    if (!transmitted || !bsdf.bordersVolume()) return before;
    return bsdf.backSide() ? scene.surfaces().absorptionBefore(point)
                           : scene.surfaces().materials()[point.material].absorption;
}

/// Beer's law. Infinite distances count as a million scene radii.
[[nodiscard]] inline Rgb transmittance(const Rgb& absorption, float distance) noexcept {
    if (isBlack(absorption)) return Rgb(1.0F);
    const float d = std::fmin(distance, 1e6F);
    return {std::exp(-absorption.r * d), std::exp(-absorption.g * d), std::exp(-absorption.b * d)};
}

}  // namespace pellucid::medium

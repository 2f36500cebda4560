/// The six dials of stiffness: scenes that grow harder with one number, and whose picture is known in closed form.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/glm.hpp>

#include <pellucid/render/settings.h>
#include <pellucid/scene/description.h>

#include "check_measure.h"

namespace pellucid {

/// A step's scene and its picture: radiance at a point that a pixel's centre sees, in metres.
struct Known {
    SceneDescription scene;
    std::function<double(const glm::dvec3&)> radiance;
    Settings settings = check::smallSettings();
    std::uint32_t pathSamples = 32, photonSamples = 8;
};

struct Dial {
    const char *name, *dial, *scene, *reference, *source;
    std::vector<double> values;  ///< from the tame end on
    Known (*make)(double);
};

[[nodiscard]] const std::vector<Dial>& dials();

}  // namespace pellucid

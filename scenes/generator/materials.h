/// glTF materials that mean exactly one lobe, or the rough ones by name.
#pragma once

#include <string>

#include <glm/glm.hpp>

#include "glb_writer.h"

namespace scenes {

/// Exact Lambertian: metallic 0 and specular factor 0.
[[nodiscard]] Json lambert(const std::string& name, const glm::dvec3& reflectance);
/// Lambertian that emits `radiance` (W m^-2 sr^-1) from its front and reflects nothing.
[[nodiscard]] Json lamp(const std::string& name, const glm::dvec3& radiance);
/// Metal; roughness 0 with white is the perfect mirror.
[[nodiscard]] Json metal(const std::string& name, const glm::dvec3& color, double roughness);
/// Closed dielectric body that refracts; roughness 0 is an exact delta lobe.
[[nodiscard]] Json dielectric(const std::string& name, double ior, double roughness = 0.0);
/// The same with an Abbe number: its ior is that at 587.6 nm.
[[nodiscard]] Json dispersing(Json material, double abbe);
/// The same with Beer's absorption: `color` is left of white light after `distance` metres.
[[nodiscard]] Json absorbing(Json material, const glm::dvec3& color, double distance);

}  // namespace scenes

/// The closed forms that the checks expect, in double and apart from the renderer's own code.
#pragma once

#include <functional>
#include <span>

#include <glm/glm.hpp>

namespace pellucid::check {

/// Mean of f over the unit square (midpoints of a grid).
[[nodiscard]] double meanOverSquare(const std::function<double(double, double)>& f, int steps = 16);
/// Integral over [a, b] (midpoints).
[[nodiscard]] double integral(double a, double b, const std::function<double(double)>& f, int steps = 20000);
/// A root of f in [a, b], where its sign changes.
[[nodiscard]] double root(double a, double b, const std::function<double(double)>& f);

/// Unpolarised reflectance; n is the ratio of the far side's index to the near side's. [Hecht2002, eqs. 4.34-4.40]
[[nodiscard]] double fresnel(double cosine, double n);
/// Schlick's metal with F90 = 1 (glTF). [Schlick1994]
[[nodiscard]] double schlick(double cosine, double f0);
/// Sine of the refracted ray.
[[nodiscard]] inline double refractedSine(double sine, double n) noexcept { return sine / n; }

/// Transmittance of a slab, all internal bounces summed: (1-R)^2 e / (1 - R^2 e^2), e = exp(-depth / cos').
[[nodiscard]] double slabTransmittance(double cosine, double n, double opticalDepth = 0.0);

/// Irradiance at `point` from a polygon of uniform radiance 1 wholly above its horizon, by Lambert's formula
/// E = 1/2 sum gamma_i (n . Gamma_i), whatever its winding. [Lambert1760], [Arvo1994]
[[nodiscard]] double polygonIrradiance(const glm::dvec3& point, const glm::dvec3& normal,
                                       std::span<const glm::dvec3> polygon);

/// Irradiance from a parallel disc of radiance 1 and radius R at height h, its axis at distance a. [Walsh1958]
[[nodiscard]] double discIrradiance(double height, double offset, double radius);

/// Irradiance from a point light at `light`: I cos / d^2.
[[nodiscard]] double pointIrradiance(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& light,
                                     double intensity);

}  // namespace pellucid::check

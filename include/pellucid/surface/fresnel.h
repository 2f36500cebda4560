/// Fresnel reflectance of smooth interfaces: what part of the light an interface sends back. Pure functions of the
/// cosine against the (micro)facet's normal; the lobes of surface/lobes.h call them for every facet.
#pragma once

#include <algorithm>
#include <cmath>

#include <pellucid/math/rgb.h>

namespace pellucid {

/// The unpolarised reflectance of a dielectric interface for light at |cos| = `cosTheta`; `eta` is the index of the far
/// side over that of the near side. [Hecht2002, eqs. 4.34-4.40] 1 from the critical angle on, 0 for eta = 1; eta <= 0
/// reflects all (KHR_materials_ior's special value). In double: near eta = 1 the result is a square of a small
/// difference.
[[nodiscard]] inline float fresnelDielectric(float cosTheta, float eta) noexcept {
    if (eta <= 0.0F) return 1.0F;
    if (eta == 1.0F) return 0.0F;
    const double n = eta, c = std::min(1.0, std::fabs(static_cast<double>(cosTheta)));
    const double cos2T = 1.0 - (1.0 - c * c) / (n * n);
    if (cos2T <= 0.0) return 1.0F;
    const double t = std::sqrt(cos2T);
    const double perpendicular = (c - n * t) / (c + n * t), parallel = (n * c - t) / (n * c + t);
    return static_cast<float>(0.5 * (perpendicular * perpendicular + parallel * parallel));
}

/// Reflectance at normal incidence; 1 for the special value 0.
[[nodiscard]] inline float fresnelNormal(float eta) noexcept {
    if (eta <= 0.0F) return 1.0F;
    const float root = (eta - 1.0F) / (eta + 1.0F);
    return root * root;
}

/// Cosine of the refracted ray: Snell's law, 0 at and beyond the critical angle. `sin2` is the squared sine on the near
/// side.
[[nodiscard]] inline float refractedCosine(double sin2, float eta) noexcept {
    const double n = eta;
    return static_cast<float>(std::sqrt(std::max(0.0, 1.0 - sin2 / (n * n))));
}

/// (1 - c)^5, the shape of Schlick's approximation. [Schlick1994, eq. 15]
[[nodiscard]] inline float schlickWeight(float cosTheta) noexcept {
    const float s = 1.0F - std::min(1.0F, std::max(0.0F, cosTheta)), s2 = s * s;
    return s2 * s2 * s;
}

/// Schlick's conductor with F90 = 1, as glTF's metal. [Schlick1994, eq. 15]
[[nodiscard]] inline Rgb fresnelSchlick(float cosTheta, const Rgb& f0) noexcept {
    return f0 + (Rgb{1.0F} - f0) * schlickWeight(cosTheta);
}

/// The exact curve as a mixing factor from F0 (value 0) to 1 (value 1): (F(cos) - F0) / (1 - F0). A little below zero
/// at mid angles for eta > 2 + sqrt(3). Schlick's curve stands in where F0 is 1 and leaves none.
[[nodiscard]] inline float fresnelCurve(float cosTheta, float eta) noexcept {
    if (eta <= 0.0F) return schlickWeight(cosTheta);
    const float f0 = fresnelNormal(eta);
    return (fresnelDielectric(cosTheta, eta) - f0) / (1.0F - f0);
}

/// Reflectance of an infinite slab with interfaces of reflectance R, all internal bounces summed incoherently.
[[nodiscard]] inline float slabReflectance(float interfaceReflectance) noexcept {
    return 2.0F * interfaceReflectance / (1.0F + interfaceReflectance);
}

}  // namespace pellucid

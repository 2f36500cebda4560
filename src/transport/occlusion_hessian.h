/// Second derivatives of the irradiance under translation, with the parallax between near and far surfaces: the gather's hit
/// points become a mesh whose triangles shine with the radiance of their farthest corner, and each edge between different
/// radiances moves when the receiver does. [JaroszSchonefeldKobbeltJensen2012; SchwarzhauptJensenJarosz2012] They decide
/// how far a record may speak, not what it says: the mesh's own gradient is biased low, so that stays Ward and Heckbert's.
#pragma once

#include <glm/glm.hpp>

#include <pellucid/math/frame.h>

#include "gather_grid.h"

namespace pellucid {

/// What one directed edge adds to the derivatives of a polygon's form factor F = 1/(2 pi) sum gamma_i n.Gamma_i [Lambert1760]
/// as the receiver moves. `from`, `to`: its ends as seen from the receiver. Zero for an edge that points at the receiver.
struct EdgeDerivatives {
    glm::dvec3 gradient{0.0};
    glm::dmat3 hessian{0.0};
};
[[nodiscard]] EdgeDerivatives edgeDerivatives(const glm::dvec3& from, const glm::dvec3& to,
                                              const glm::dvec3& normal) noexcept;

/// Hessian of the mean over the colour channels, W m^-2 per scene unit squared. What was not hit lies `farthest` away, what
/// is nearer than `nearest` counts as that.
[[nodiscard]] glm::dmat3 occlusionHessian(const GatherGrid& g, const Frame& frame, float nearest, float farthest);

/// The tangent plane's part: eigenvalues by size, |first| >= |second|, and the unit direction of the first.
struct TangentCurvature {
    double first = 0.0, second = 0.0;
    glm::vec3 axis{1.0F, 0.0F, 0.0F};
};
[[nodiscard]] TangentCurvature tangentCurvature(const glm::dmat3& hessian, const Frame& frame) noexcept;

}  // namespace pellucid

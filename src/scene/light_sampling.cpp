#include "light_sampling.h"

#include <algorithm>
#include <cmath>

#include <pellucid/math/constants.h>
#include <pellucid/math/warps.h>

namespace pellucid {

namespace {

/// A triangle counts as large where its farthest corner is more than 0.22 of the viewing distance from its centroid:
/// below that the area density varies by less than a factor 2.5 over the triangle and costs a third of the time.
constexpr float kLargeRatio2 = 0.05F;
/// Scene units. A point closer to the plane of a large triangle than this lies in it but for rounding, which has no say over
/// which side it is on: a lamp would light its own back, or itself. Rays start farther off.
constexpr double kLeastHeight = 1e-6;

/// The triangle projected on the unit sphere around the shading point, in double: exact differences of float input.
struct SphericalTriangle {
    glm::dvec3 a{0.0}, b{0.0}, c{0.0};  ///< unit vectors to the corners
    double volume = 0.0;                ///< |a . (b x c)|
    double solidAngle = 0.0;
};

[[nodiscard]] bool looksLarge(const EmissiveTriangle& t, const glm::vec3& point) noexcept {
    const glm::vec3 centroid = (t.corner[0] + t.corner[1] + t.corner[2]) * (1.0F / 3.0F);
    float reach2 = 0.0F;
    for (const glm::vec3& corner : t.corner) reach2 = std::max(reach2, glm::dot(corner - centroid, corner - centroid));
    return reach2 >= kLargeRatio2 * glm::dot(centroid - point, centroid - point);
}

[[nodiscard]] bool inPlane(const EmissiveTriangle& t, const glm::vec3& point) noexcept {
    return std::fabs(glm::dot(glm::dvec3(t.normal), glm::dvec3(point) - glm::dvec3(t.corner[0]))) < kLeastHeight;
}

/// Empty where the triangle's projection is degenerate: then it is to be sampled by area, as where it looks small.
/// Solid angle: tan(Omega/2) = |a.(b x c)| / (1 + a.b + b.c + c.a). [VanOosteromStrackee1983, eq. 8]
std::optional<SphericalTriangle> onSphere(const EmissiveTriangle& t, const glm::vec3& point) noexcept {
    const glm::dvec3 p(point);
    SphericalTriangle s{glm::dvec3(t.corner[0]) - p, glm::dvec3(t.corner[1]) - p, glm::dvec3(t.corner[2]) - p};
    for (glm::dvec3* v : {&s.a, &s.b, &s.c}) {
        const double length = glm::length(*v);
        if (!(length > 0.0)) return std::nullopt;
        *v /= length;
    }
    s.volume = std::fabs(glm::dot(s.a, glm::cross(s.b, s.c)));
    const double denominator = 1.0 + glm::dot(s.a, s.b) + glm::dot(s.b, s.c) + glm::dot(s.c, s.a);
    s.solidAngle = 2.0 * std::atan2(s.volume, denominator);
    if (s.volume < 1e-7 || s.solidAngle < 1e-5) return std::nullopt;
    return s;
}

/// A direction uniform in solid angle within the spherical triangle. [Arvo1995]
glm::dvec3 sampleSphericalTriangle(const SphericalTriangle& s, const glm::dvec2& u) noexcept {
    const double cosAB = glm::dot(s.a, s.b);
    // The angle at A, by its sine and cosine times |a x b| |a x c|.
    const double cosScaled = glm::dot(s.b, s.c) - cosAB * glm::dot(s.a, s.c);
    const double alpha = std::atan2(s.volume, cosScaled);
    const double cosAlpha = std::cos(alpha), sinAlpha = std::sin(alpha);
    const double part = u.x * s.solidAngle - alpha;
    const double sinPart = std::sin(part), cosPart = std::cos(part);
    const double p = cosPart - cosAlpha, q = sinPart + sinAlpha * cosAB;
    const double numerator = (q * cosPart - p * sinPart) * cosAlpha - q;
    const double denominator = (q * sinPart + p * cosPart) * sinAlpha;
    const double cosB = denominator != 0.0 ? std::clamp(numerator / denominator, -1.0, 1.0) : 1.0;
    const glm::dvec3 towardsC = glm::normalize(s.c - glm::dot(s.c, s.a) * s.a);
    const glm::dvec3 newC = cosB * s.a + std::sqrt(1.0 - cosB * cosB) * towardsC;
    const glm::dvec3 across = newC - glm::dot(newC, s.b) * s.b;
    const double acrossLength = glm::length(across);
    const double z = 1.0 - u.y * (1.0 - glm::dot(newC, s.b));
    if (!(acrossLength > 0.0)) return s.b;
    return z * s.b + std::sqrt(std::max(0.0, 1.0 - z * z)) * (across / acrossLength);
}

/// Where a direction known to meet the triangle does so. [MoellerTrumbore1997]
bool meet(const EmissiveTriangle& t, const glm::vec3& point, const glm::dvec3& direction,
          TrianglePoint& result) noexcept {
    const glm::dvec3 origin(point), first(t.corner[0]);
    const glm::dvec3 edge1 = glm::dvec3(t.corner[1]) - first, edge2 = glm::dvec3(t.corner[2]) - first;
    const glm::dvec3 p = glm::cross(direction, edge2), s = origin - first, q = glm::cross(s, edge1);
    const double determinant = glm::dot(p, edge1);
    const double distance = glm::dot(q, edge2) / determinant;
    if (!std::isfinite(distance) || distance <= 0.0) return false;
    const double b1 = std::clamp(glm::dot(p, s) / determinant, 0.0, 1.0);
    const double b2 = std::clamp(glm::dot(q, direction) / determinant, 0.0, 1.0 - b1);
    result.wi = glm::vec3(direction);
    result.distance = static_cast<float>(distance);
    result.barycentric = glm::vec2(glm::dvec2(b1, b2));
    return true;
}

/// Area density 1/A seen as a density of directions: d^2 / (A |cos|). 0 where it is not finite.
float areaPdf(const EmissiveTriangle& triangle, float cosLight, float distance) noexcept {
    const float pdf = distance * distance / (triangle.area * std::fabs(cosLight));
    return std::isfinite(pdf) ? pdf : 0.0F;
}

}  // namespace

SpotSolidAngle spotSolidAngle(const SpotEmitter& spot) noexcept {
    const auto inner = static_cast<double>(spot.cosInner), outer = static_cast<double>(spot.cosOuter);
    return {2.0 * kPiD * (1.0 - inner), 2.0 * kPiD * (inner - outer) / 3.0};
}

/// In the outer part the density of t = (cos - cosOuter) / (cosInner - cosOuter) is 3 t^2: inverted by a cube root.
float sampleSpotCosine(const SpotEmitter& spot, float u) noexcept {
    const SpotSolidAngle angle = spotSolidAngle(spot);
    const double x = static_cast<double>(u) * angle.total();
    const auto inner = static_cast<double>(spot.cosInner), outer = static_cast<double>(spot.cosOuter);
    if (x < angle.inner) return static_cast<float>(1.0 - (1.0 - inner) * (x / angle.inner));
    const double t = std::cbrt(std::clamp(1.0 - (x - angle.inner) / angle.outer, 0.0, 1.0));
    return static_cast<float>(outer + t * (inner - outer));
}

std::optional<TrianglePoint> sampleTriangle(const EmissiveTriangle& triangle, const glm::vec3& point,
                                            const glm::vec2& u) noexcept {
    TrianglePoint result;
    const bool large = looksLarge(triangle, point);
    if (large && inPlane(triangle, point)) return std::nullopt;
    if (const auto sphere = large ? onSphere(triangle, point) : std::nullopt) {
        if (!meet(triangle, point, sampleSphericalTriangle(*sphere, glm::dvec2(u)), result)) return std::nullopt;
        result.cosLight = -glm::dot(triangle.normal, result.wi);
        result.pdfSolidAngle = static_cast<float>(1.0 / sphere->solidAngle);
        return result;
    }
    result.barycentric = sampleUniformTriangle(u);
    const float b1 = result.barycentric.x, b2 = result.barycentric.y;
    const glm::vec3 to =
        (1.0F - b1 - b2) * triangle.corner[0] + b1 * triangle.corner[1] + b2 * triangle.corner[2] - point;
    const float distance2 = glm::dot(to, to);
    if (!(distance2 > kMinDistance2)) return std::nullopt;
    result.distance = std::sqrt(distance2);
    result.wi = to / result.distance;
    result.cosLight = -glm::dot(triangle.normal, result.wi);
    result.pdfSolidAngle = areaPdf(triangle, result.cosLight, result.distance);
    if (!(result.pdfSolidAngle > 0.0F)) return std::nullopt;
    return result;
}

float pdfTriangleSolidAngle(const EmissiveTriangle& triangle, const glm::vec3& point, const glm::vec3& wi,
                            float distance) noexcept {
    if (looksLarge(triangle, point)) {
        if (inPlane(triangle, point)) return 0.0F;
        if (const auto sphere = onSphere(triangle, point)) return static_cast<float>(1.0 / sphere->solidAngle);
    }
    return areaPdf(triangle, glm::dot(triangle.normal, wi), distance);
}

}  // namespace pellucid

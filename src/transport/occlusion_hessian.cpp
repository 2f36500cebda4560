#include "occlusion_hessian.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <pellucid/math/constants.h>

namespace pellucid {

namespace {

/// Below this share of the larger squared length an edge counts as a point, or as pointing at the receiver.
constexpr double kDegenerate = 1e-14;

/// The gather's mesh. Ring 0 encloses the cap around the normal; ring M lies on the horizon, as far away as ring M - 1 and as
/// bright. Its outer edges are no edges of anything: what they bound goes on below the horizon, where the cosine is 0.
class HitMesh {
public:
    HitMesh(const GatherGrid& g, const Frame& frame, float nearest, float farthest)
        : rings_(g.elevations + 1), azimuths_(g.azimuths) {
        corners_.resize(static_cast<std::size_t>(rings_) * static_cast<std::size_t>(azimuths_));
        for (int j = 0; j < rings_; ++j)
            for (int k = 0; k < azimuths_; ++k) {
                const GatherCell& cell = g.at(std::min(j, g.elevations - 1), k);
                Corner& c = corner(j, k);
                c.distance = static_cast<double>(std::clamp(cell.distance, nearest, farthest));
                glm::vec3 direction = cell.direction;
                if (j == g.elevations) {
                    direction -= frame.normal * glm::dot(direction, frame.normal);
                    direction = glm::normalize(direction);
                }
                c.position = glm::dvec3(direction) * c.distance;
                c.radiance = static_cast<double>(average(cell.radiance));
            }
    }

    /// Calls visit(from, to, radiance on the left - radiance on the right) for every edge above the horizon.
    template <class Visit>
    void forEdges(Visit&& visit) const {
        for (int j = 0; j + 1 < rings_; ++j)
            for (int k = 0; k < azimuths_; ++k) {
                visit(at(j, k).position, at(j, k + 1).position, (j > 0 ? outer(j - 1, k) : cap()) - inner(j, k));
                visit(at(j, k).position, at(j + 1, k).position, outer(j, k) - inner(j, k - 1));
                visit(at(j, k).position, at(j + 1, k + 1).position, inner(j, k) - outer(j, k));
            }
    }

private:
    struct Corner {
        glm::dvec3 position{0.0};
        double distance = 0.0, radiance = 0.0;
    };
    [[nodiscard]] Corner& corner(int j, int k) noexcept {
        return corners_[static_cast<std::size_t>(j) * static_cast<std::size_t>(azimuths_) +
                        static_cast<std::size_t>(k)];
    }
    [[nodiscard]] const Corner& at(int j, int k) const noexcept {
        return corners_[static_cast<std::size_t>(j) * static_cast<std::size_t>(azimuths_) +
                        static_cast<std::size_t>((k + azimuths_) % azimuths_)];
    }
    [[nodiscard]] static double farther(const Corner& a, const Corner& b, const Corner& c) noexcept {
        const Corner& ab = b.distance > a.distance ? b : a;
        return c.distance > ab.distance ? c.radiance : ab.radiance;
    }
    /// The two triangles of the cell between rings j, j + 1 and azimuths k, k + 1: at its outer and at its inner ring.
    [[nodiscard]] double outer(int j, int k) const noexcept {
        return farther(at(j, k), at(j + 1, k), at(j + 1, k + 1));
    }
    [[nodiscard]] double inner(int j, int k) const noexcept {
        return farther(at(j, k), at(j + 1, k + 1), at(j, k + 1));
    }
    [[nodiscard]] double cap() const noexcept {
        const Corner* farthest = &at(0, 0);
        for (int k = 1; k < azimuths_; ++k)
            if (at(0, k).distance > farthest->distance) farthest = &at(0, k);
        return farthest->radiance;
    }

    int rings_, azimuths_;
    std::vector<Corner> corners_;
};

}  // namespace

EdgeDerivatives edgeDerivatives(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& normal) noexcept {
    const glm::dvec3 &r = from, e = to - from, c = glm::cross(from, to);
    const double r2 = glm::dot(r, r), s2 = glm::dot(to, to), e2 = glm::dot(e, e), c2 = glm::dot(c, c);
    const double most = std::max(r2, s2);
    if (e2 <= kDegenerate * most || c2 <= kDegenerate * most * most) return {};
    const double er = glm::dot(e, r), es = glm::dot(e, to), height = glm::dot(normal, c);
    // Integrals over the edge, s in [0, 1], of 1, s and s^2 over |r + s e|^2, ^4 and ^6: I, J and K by the power.
    const double i1 = std::atan2(std::sqrt(c2), glm::dot(r, to)) / std::sqrt(c2);
    const double i2 = (es / s2 - er / r2 + e2 * i1) / (2.0 * c2);
    const double j2 = (0.5 * (1.0 / r2 - 1.0 / s2) - er * i2) / e2;
    const double i3 = (es / (s2 * s2) - er / (r2 * r2) + 3.0 * e2 * i2) / (4.0 * c2);
    const double j3 = (0.25 * (1.0 / (r2 * r2) - 1.0 / (s2 * s2)) - er * i3) / e2;
    const double k3 = (i2 - r2 * i3 - 2.0 * er * j3) / e2;
    const glm::dvec3 across = glm::cross(normal, e), q = i2 * r + j2 * e;
    EdgeDerivatives d;
    d.gradient = (i1 * across + 2.0 * height * q) / (2.0 * kPiD);
    d.hessian = (glm::outerProduct(across, q) + glm::outerProduct(q, across) +
                 4.0 * height *
                     (i3 * glm::outerProduct(r, r) + k3 * glm::outerProduct(e, e) +
                      j3 * (glm::outerProduct(r, e) + glm::outerProduct(e, r))) -
                 height * i2 * glm::dmat3(1.0)) /
                kPiD;
    return d;
}

glm::dmat3 occlusionHessian(const GatherGrid& g, const Frame& frame, float nearest, float farthest) {
    const HitMesh mesh(g, frame, nearest, farthest);
    const glm::dvec3 normal(frame.normal);
    glm::dmat3 sum(0.0);
    mesh.forEdges([&](const glm::dvec3& from, const glm::dvec3& to, double step) {
        if (step != 0.0) sum += kPiD * step * edgeDerivatives(from, to, normal).hessian;
    });
    return sum;
}

TangentCurvature tangentCurvature(const glm::dmat3& hessian, const Frame& frame) noexcept {
    const glm::dvec3 u(frame.tangent), v(frame.bitangent);
    const double a = glm::dot(u, hessian * u), b = glm::dot(u, hessian * v), c = glm::dot(v, hessian * v);
    const double mean = 0.5 * (a + c), half = std::hypot(0.5 * (a - c), b);
    TangentCurvature t{mean + half, mean - half, {}};
    double angle = 0.5 * std::atan2(2.0 * b, a - c);  // of mean + half
    if (std::fabs(t.second) > std::fabs(t.first)) {
        std::swap(t.first, t.second);
        angle += 0.5 * kPiD;
    }
    t.axis =
        frame.tangent * static_cast<float>(std::cos(angle)) + frame.bitangent * static_cast<float>(std::sin(angle));
    return t;
}

}  // namespace pellucid

#include <pellucid/transport/kernel_mass.h>

#include <algorithm>
#include <cmath>

#include <pellucid/math/constants.h>
#include <pellucid/math/frame.h>

namespace pellucid {

namespace {

constexpr int kPlaces = 8;
constexpr float kGoldenTurn = 0.38196601F;  ///< of places on a sunflower
constexpr float kLeastMass = 0.1F;

}  // namespace

bool surfaceUnder(const Scene& scene, const glm::vec3& start, const glm::vec3& normal, float depth,
                  float leastCosine) noexcept {
    const auto hit = scene.intersect(Ray{start, -normal, depth}, 0.0F);
    return hit && std::fabs(glm::dot(hit->point.geometricNormal, normal)) >= leastCosine;
}

float kernelMass(const Scene& scene, const glm::vec3& point, const glm::vec3& normal, float radius, PhotonKernel kernel,
                 float turn, std::uint64_t& rays) noexcept {
    const Frame frame(normal);
    const glm::vec3 above = normal * (kMostPlaneDistance * radius), start = offsetOrigin(point, normal) + above;
    float whole = 0.0F, there = 0.0F;
    for (int i = 0; i < kPlaces; ++i) {
        const float t = (static_cast<float>(i) + 0.5F) / kPlaces, distance = radius * std::sqrt(t),
                    phi = kTwoPi * (turn + kGoldenTurn * static_cast<float>(i)),
                    weight = withShape(kernel, [t](auto shape) { return shape.shape(t); });
        const glm::vec3 along = frame.tangent * std::cos(phi) + frame.bitangent * std::sin(phi);
        whole += weight;
        ++rays;
        if (scene.intersect(Ray{start, along, distance}, 0.0F)) continue;
        ++rays;
        if (surfaceUnder(scene, start + along * distance, normal, 2.0F * kMostPlaneDistance * radius,
                         kLeastNormalCosine))
            there += weight;
    }
    return std::max(kLeastMass, there / whole);
}

}  // namespace pellucid

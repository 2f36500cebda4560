#include "endless.h"

#include <algorithm>
#include <limits>

#include <pellucid/math/sampler.h>

namespace pellucid {

namespace {

constexpr int kPaths = 64, kBounces = 64;
constexpr std::uint64_t kDimensionsPerVertex = 4;
constexpr float kEverything = 0.99995F;

[[nodiscard]] bool reflectsEverything(const Material& m) noexcept {
    return m.baseColor.r >= kEverything || m.baseColor.g >= kEverything || m.baseColor.b >= kEverything;
}

/// Whether light could go on for ever along this path as far as it was followed: it neither escaped nor weakened.
[[nodiscard]] bool goesOn(const Scene& scene, const Camera& camera, std::uint32_t index) {
    Sampler sampler(0x656e646cULL, index, 0);
    const glm::vec2 place = sampler.next2D(), lens = sampler.next2D();
    const CameraRay start =
        camera.ray(place * glm::vec2(static_cast<float>(camera.width()), static_cast<float>(camera.height())), lens);
    Ray ray = start.ray;
    float kept = 1.0F;
    for (int bounce = 0; bounce < kBounces; ++bounce) {
        sampler.setDimension(4 + kDimensionsPerVertex * static_cast<std::uint64_t>(bounce));
        const auto hit = scene.intersect(ray, sampler.next1D());
        if (!hit) return false;
        const glm::vec3 wo = -ray.direction;
        const Bsdf bsdf = scene.surfaces().bsdf(hit->point, wo);
        if (bsdf.bordersVolume() && !isBlack(scene.surfaces().materials()[hit->point.material].absorption))
            return false;
        const float choice = sampler.next1D();
        const auto sample = bsdf.sample(wo, choice, sampler.next2D(), kAllLobes, TransportMode::Flux);
        if (!sample) return false;
        kept *= std::min(1.0F, maxComponent(sample->weight));
        if (kept < 0.99F) return false;
        const glm::vec3& ng = bsdf.geometricNormal();
        ray = Ray{offsetOrigin(hit->point.position, glm::dot(sample->wi, ng) < 0.0F ? -ng : ng), sample->wi,
                  std::numeric_limits<float>::infinity()};
    }
    return true;
}

}  // namespace

std::optional<std::string> endlessRemark(const Scene& scene, const Camera& camera) {
    if (std::ranges::none_of(scene.description().materials, reflectsEverything)) return std::nullopt;
    for (std::uint32_t i = 0; i < kPaths; ++i)
        if (!goesOn(scene, camera, i)) return std::nullopt;
    return "endless light: the room is closed and absorbs nothing, so there is no steady state; paths are ended by "
           "chance and "
           "the picture is no answer (lower a base colour below 1)";
}

}  // namespace pellucid

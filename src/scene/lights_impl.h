/// What the list of lights holds, and the samplings by kind of light.
#pragma once

#include <cstdint>
#include <vector>

#include <pellucid/math/constants.h>
#include <pellucid/math/distribution.h>
#include <pellucid/scene/lights.h>

#include "light_choice.h"
#include "light_list.h"

namespace pellucid {

struct Lights::Impl {
    Parts parts;
    TriangleRadiance radiance;
    const void* scene;
    std::vector<LightEntry> entries;
    LightChoice choice;
    TriangleLookup lookup;
    std::vector<double> powers;
    Distribution1D byPower;

    [[nodiscard]] Rgb triangleRadiance(const EmissiveTriangle& t, const glm::vec2& barycentric,
                                       const glm::vec3& wo) const {
        if (!t.twoSided && glm::dot(t.normal, wo) <= 0.0F) return Rgb(0.0F);
        return radiance != nullptr ? radiance(scene, t.geometry, t.primitive, barycentric, wo) : t.meanRadiance;
    }

    /// Photons from infinity cross this disc. Seen along any direction it covers the scene's bounding sphere.
    [[nodiscard]] double discArea() const noexcept {
        return kPiD * static_cast<double>(parts.sceneRadius) * static_cast<double>(parts.sceneRadius);
    }

    [[nodiscard]] double powerOf(const LightEntry& entry) const noexcept;
    void towardsPunctual(const LightEntry& entry, const glm::vec3& point, LightSample& sample) const noexcept;
    void towardsTriangle(const EmissiveTriangle& t, const glm::vec3& point, const glm::vec2& u,
                         LightSample& sample) const noexcept;
    void towardsEnvironment(const glm::vec2& u, LightSample& sample) const noexcept;
    void emitFromPunctual(const LightEntry& entry, const glm::vec2& u, EmissionSample& e) const noexcept;
    void emitFromTriangle(const EmissiveTriangle& t, const glm::vec2& position, const glm::vec2& direction,
                          EmissionSample& e) const noexcept;
    void emitFromInfinity(const LightEntry& entry, const glm::vec2& position, const glm::vec2& direction,
                          EmissionSample& e) const noexcept;
};

}  // namespace pellucid

#include "light_list.h"

#include <algorithm>
#include <cmath>

#include "light_sampling.h"

namespace pellucid {

namespace {

bool emits(const Rgb& c) noexcept { return isFinite(c) && average(c) > 0.0F; }

/// Normalises what the rest relies on; false for a triangle that cannot be a light.
bool prepare(EmissiveTriangle& t) noexcept {
    const glm::dvec3 edge1 = glm::dvec3(t.corner[1]) - glm::dvec3(t.corner[0]);
    const glm::dvec3 edge2 = glm::dvec3(t.corner[2]) - glm::dvec3(t.corner[0]);
    const glm::dvec3 across = glm::cross(edge1, edge2);
    const double length = glm::length(across);
    t.area = static_cast<float>(0.5 * length);
    if (!(t.area > 0.0F) || !std::isfinite(t.area) || !emits(t.meanRadiance)) return false;
    const float side =
        glm::dot(t.normal, glm::vec3(across)) < 0.0F ? -1.0F : 1.0F;  // a mirroring transform turns the winding
    t.normal = side * glm::vec3(across / length);
    return true;
}

}  // namespace

void dropDark(Lights::Parts& parts) {
    std::erase_if(parts.points, [](const PointEmitter& l) { return !emits(l.intensity) || !isFinite(l.position); });
    for (SpotEmitter& l : parts.spots) l.cosInner = std::max(l.cosInner, l.cosOuter);
    std::erase_if(parts.spots, [](const SpotEmitter& l) {
        return !emits(l.intensity) || !isFinite(l.position) || !(spotSolidAngle(l).total() > 0.0);
    });
    std::erase_if(parts.directionals, [](const DirectionalEmitter& l) { return !emits(l.irradiance); });
    std::erase_if(parts.triangles, [](EmissiveTriangle& t) { return !prepare(t); });
    if (parts.environment != nullptr && parts.environment->black()) parts.environment = nullptr;
}

std::vector<LightEntry> listLights(const Lights::Parts& parts) {
    std::vector<LightEntry> entries;
    const auto add = [&entries](LightKind kind, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) entries.push_back({kind, static_cast<std::uint32_t>(i)});
    };
    add(LightKind::Point, parts.points.size());
    add(LightKind::Spot, parts.spots.size());
    add(LightKind::Triangle, parts.triangles.size());
    add(LightKind::Directional, parts.directionals.size());
    add(LightKind::Environment, parts.environment != nullptr ? 1 : 0);
    return entries;
}

TriangleLookup::TriangleLookup(const std::vector<EmissiveTriangle>& triangles, std::uint32_t firstLight) {
    for (const EmissiveTriangle& t : triangles) {
        if (t.geometry >= spans_.size()) spans_.resize(std::size_t{t.geometry} + 1);
        Span& span = spans_[t.geometry];
        span.first = std::min(span.first, t.primitive);
        span.last = std::max(span.last, t.primitive);
    }
    std::size_t size = 0;
    for (Span& span : spans_) {
        span.offset = size;
        if (span.first <= span.last) size += std::size_t{span.last - span.first} + 1;
    }
    lights_.assign(size, kNoLight);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Span& span = spans_[triangles[i].geometry];
        lights_[span.offset + (triangles[i].primitive - span.first)] = firstLight + static_cast<std::uint32_t>(i);
    }
}

}  // namespace pellucid

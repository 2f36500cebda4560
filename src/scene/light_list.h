/// What the constructor of Lights does with its parts: drops lights that emit nothing, numbers the rest, and finds the
/// light that a triangle of the scene is. Private to the room.
#pragma once

#include <cstdint>
#include <vector>

#include <pellucid/scene/lights.h>

namespace pellucid {

inline constexpr std::uint32_t kNoLight = Lights::kNoLight;

/// A light by its kind and its place in that kind's array of Lights::Parts.
struct LightEntry {
    LightKind kind;
    std::uint32_t index;
};

/// Drops lights that are black, not finite or without extent, and computes each triangle's area and unit normal.
void dropDark(Lights::Parts& parts);

/// All lights by number: the finite ones (points, spots, triangles), then directionals and the environment.
[[nodiscard]] std::vector<LightEntry> listLights(const Lights::Parts& parts);

/// For each geometry a table over the span of its emissive primitives.
class TriangleLookup {
public:
    TriangleLookup() = default;
    TriangleLookup(const std::vector<EmissiveTriangle>& triangles, std::uint32_t firstLight);

    /// kNoLight when the triangle does not emit.
    [[nodiscard]] std::uint32_t find(std::uint32_t geometry, std::uint32_t primitive) const noexcept {
        if (geometry >= spans_.size()) return kNoLight;
        const Span& span = spans_[geometry];
        if (primitive < span.first || primitive > span.last) return kNoLight;
        return lights_[span.offset + (primitive - span.first)];
    }

private:
    struct Span {
        std::uint32_t first = kNoLight, last = 0;
        std::size_t offset = 0;
    };
    std::vector<Span> spans_;
    std::vector<std::uint32_t> lights_;
};

}  // namespace pellucid

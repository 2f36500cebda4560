/// Faces that lie in one place: a glass that stands on a table, a lamp in the plane of the ceiling, a label on a bottle, wine
/// in a goblet. Rounding decides which of them a ray hits, and a ray that leaves one starts beyond the other, so that light
/// would be lost at random, from the eye and from the lamps alike. Here such faces are found when a scene is built; Scene then
/// meets them in one order from either side.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <pellucid/geometry/accel.h>
#include <pellucid/scene/description.h>
#include <pellucid/surface/surface_point.h>

#include "placement.h"

namespace pellucid {

/// What a face is to others in its place, in the order in which they are met.
enum class FaceRank : std::uint8_t {
    Cover,  ///< has holes (alpha), through which the next is met
    Lamp,   ///< opaque and emits
    Solid,  ///< opaque
    Body,   ///< of glass, its inside behind the face: where it lies in something opaque it is not met at all
    Pane,   ///< transmits straight on: where it lies in the face of a body it is not met either
};

struct FaceId {
    std::uint32_t geometry = 0, primitive = 0;
    auto operator<=>(const FaceId&) const = default;
};

class CoincidentFaces {
public:
    CoincidentFaces() = default;
    /// Of two faces of one rank in one place neither is looked for, but for bodies of clear glass that touch. Work is
    /// n log n in the triangles near covers, lamps and glass; none in scenes without.
    CoincidentFaces(const SceneDescription& description, std::span<const Placement> placements);

    [[nodiscard]] bool none() const noexcept { return others_.empty(); }
    /// Whether `face` may share its place, somewhere on it.
    [[nodiscard]] bool shares(const FaceId& face) const noexcept { return othersOf(face) != 0; }

    /// A face of this rank in the place of `at`, if any: of those that are met before it, and of all under a cover.
    [[nodiscard]] std::optional<RawHit> find(FaceRank rank, const SurfacePoint& at) const noexcept;
    /// The face of another body of clear glass in the place of `at`, which it faces.
    [[nodiscard]] std::optional<RawHit> touching(const SurfacePoint& at) const noexcept;

    [[nodiscard]] FaceRank rankOf(std::uint32_t material) const noexcept { return ranks_[material]; }
    /// Pairs of faces in one place.
    [[nodiscard]] std::size_t pairs() const noexcept { return pairs_; }
    /// Whether so many faces overlap somewhere that not all of them were looked at.
    [[nodiscard]] bool gaveUp() const noexcept { return gaveUp_; }

private:
    /// Those of a rank that share their place with faces of another, for looking them up there.
    struct Layer {
        std::vector<FaceId> faces;
        std::unique_ptr<Accel> accel;
    };
    static constexpr std::uint8_t kTouchesGlass = 1U << 5U;  ///< beside one bit a rank

    [[nodiscard]] std::uint8_t othersOf(const FaceId& face) const noexcept {
        return none() || others_[face.geometry].empty() ? std::uint8_t{0} : others_[face.geometry][face.primitive];
    }
    void note(const SceneDescription& description, const FaceId& face, std::uint8_t what);
    void relate(const SceneDescription& description, const FaceId& a, const FaceId& b);

    std::vector<FaceRank> ranks_;                    ///< by material
    std::vector<std::vector<std::uint8_t>> others_;  ///< by geometry and primitive: bits of ranks, and kTouchesGlass
    std::array<Layer, 5> layers_;                    ///< by rank
    std::unordered_map<std::uint64_t, std::vector<std::pair<FaceId, Corners>>>
        glass_;  ///< what a face of glass touches
    std::size_t pairs_ = 0;
    bool gaveUp_ = false;
};

/// How far a ray that leaves a surface at this point starts off it: faces nearer to each other than this are in one place.
[[nodiscard]] float rayOffset(const glm::vec3& point, const glm::vec3& normal) noexcept;

}  // namespace pellucid

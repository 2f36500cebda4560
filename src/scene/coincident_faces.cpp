#include "coincident_faces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <pellucid/math/ray.h>

#include "face_pairs.h"

namespace pellucid {

namespace {

/// Beyond this many triangles none of this is looked at: such scenes are forests of instances, not glasses on tables.
constexpr std::uint64_t kMostTriangles = 8'000'000;
/// Two outlines that overlap by less than this part of their coordinates share an edge or a corner, not an area.
constexpr double kLeastOverlap = 1e-6;
/// Cosine between the planes of faces that may lie in one, with room for the rounding of slivers: a quick look.
constexpr float kAlike = 0.9F;

[[nodiscard]] FaceRank rankOfMaterial(const Material& m) noexcept {
    if (m.alphaMode != AlphaMode::Opaque) return FaceRank::Cover;
    if (m.transmission > 0.0F && m.metallic < 1.0F) return m.thickness > 0.0F ? FaceRank::Body : FaceRank::Pane;
    return isBlack(m.emission) ? FaceRank::Solid : FaceRank::Lamp;
}

/// The triangle's box and as much more as rays start off it.
[[nodiscard]] Bounds boxOf(const Corners& corners) noexcept {
    Bounds box;
    for (const glm::vec3& p : corners) {
        const glm::vec3 apart = glm::abs(offsetOrigin(p, glm::vec3(1.0F)) - p);
        box.extend(p - apart);
        box.extend(p + apart);
    }
    return box;
}

/// A body of glass through whose whole face light comes.
[[nodiscard]] bool isClearBody(const Material& m) noexcept {
    return m.alphaMode == AlphaMode::Opaque && m.transmission >= 1.0F && !m.transmissionTexture && m.metallic <= 0.0F &&
           m.thickness > 0.0F && m.ior > 0.0F;
}

[[nodiscard]] std::uint8_t bit(FaceRank rank) noexcept {
    return static_cast<std::uint8_t>(1U << static_cast<unsigned>(rank));
}

[[nodiscard]] std::uint64_t keyOf(const FaceId& f) noexcept {
    return (static_cast<std::uint64_t>(f.geometry) << 32U) | f.primitive;
}

[[nodiscard]] glm::dvec3 crossOf(const Corners& t) noexcept {
    const glm::dvec3 a(t[0]), b(t[1]), c(t[2]);
    return glm::cross(b - a, c - a);
}

/// Unit; 0 for a triangle without area.
[[nodiscard]] glm::vec3 frontOf(const Corners& corners, bool mirrored) noexcept {
    const glm::dvec3 cross = crossOf(corners);
    const double length = glm::length(cross);
    return length > 0.0 ? glm::vec3(cross * ((mirrored ? -1.0 : 1.0) / length)) : glm::vec3(0.0F);
}

/// Whether the outlines of two triangles, seen along `n` (unit), share an area: no edge of either separates them.
[[nodiscard]] bool outlinesOverlap(const Corners& a, const Corners& b, const glm::dvec3& n) noexcept {
    for (const Corners* edgesOf : {&a, &b})
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3 from((*edgesOf)[i]), to((*edgesOf)[(i + 1) % 3]);
            const glm::dvec3 across = glm::cross(n, to - from);
            const double length = glm::length(across);
            if (!(length > 0.0)) continue;
            double lowA = std::numeric_limits<double>::infinity(), highA = -lowA, lowB = lowA, highB = highA;
            for (std::size_t k = 0; k < 3; ++k) {
                const double x = glm::dot(glm::dvec3(a[k]), across) / length,
                             y = glm::dot(glm::dvec3(b[k]), across) / length;
                lowA = std::min(lowA, x), highA = std::max(highA, x);
                lowB = std::min(lowB, y), highB = std::max(highB, y);
            }
            const double least = kLeastOverlap * std::max({std::fabs(lowA), std::fabs(highA), std::fabs(lowB)});
            if (std::min(highA, highB) - std::max(lowA, lowB) <= least) return false;
        }
    return true;
}

/// Whether two triangles lie in one plane, as near as rays can tell, and share an area of it.
[[nodiscard]] bool lieTogether(const Corners& a, const Corners& b) noexcept {
    const glm::dvec3 crossA = crossOf(a), crossB = crossOf(b);
    const bool aIsLarger = glm::dot(crossA, crossA) >= glm::dot(crossB, crossB);
    const glm::dvec3& cross = aIsLarger ? crossA : crossB;
    const double area = glm::length(cross);
    if (!(area > 0.0)) return false;
    const glm::dvec3 n = cross / area, origin((aIsLarger ? a : b)[0]);
    for (const glm::vec3& p : aIsLarger ? b : a)
        if (std::fabs(glm::dot(glm::dvec3(p) - origin, n)) > static_cast<double>(rayOffset(p, glm::vec3(n))))
            return false;
    return outlinesOverlap(a, b, n);
}

/// Where in the triangle the point's foot lies, by the weights of its second and third corner; empty: outside.
[[nodiscard]] std::optional<glm::dvec2> footIn(const Corners& t, const glm::vec3& point) noexcept {
    const glm::dvec3 origin(t[0]), e1 = glm::dvec3(t[1]) - origin, e2 = glm::dvec3(t[2]) - origin,
                                   n = glm::cross(e1, e2), p = glm::dvec3(point) - origin;
    const double area2 = glm::dot(n, n);
    const double u = glm::dot(glm::cross(p, e2), n) / area2, v = glm::dot(glm::cross(e1, p), n) / area2;
    constexpr double kEdge = -1e-6;
    if (!(u >= kEdge && v >= kEdge && u + v <= 1.0 - kEdge)) return std::nullopt;
    return glm::dvec2(u, v);
}

}  // namespace

float rayOffset(const glm::vec3& point, const glm::vec3& normal) noexcept {
    return std::fabs(glm::dot(offsetOrigin(point, normal) - point, normal));
}

void CoincidentFaces::note(const SceneDescription& description, const FaceId& face, std::uint8_t what) {
    if (others_.empty()) others_.resize(description.geometries.size());
    auto& flags = others_[face.geometry];
    if (flags.empty()) flags.resize(description.meshes[description.geometries[face.geometry].mesh].triangles.size());
    flags[face.primitive] |= what;
}

/// `a` is met before `b`.
void CoincidentFaces::relate(const SceneDescription& description, const FaceId& a, const FaceId& b) {
    const auto rank = [&](const FaceId& f) {
        return ranks_[description.meshes[description.geometries[f.geometry].mesh].material];
    };
    note(description, b, bit(rank(a)));
    layers_[static_cast<std::size_t>(rank(a))].faces.push_back(a);
    if (rank(a) != FaceRank::Cover) return;
    note(description, a, bit(rank(b)));  // through its holes `b` is met
    layers_[static_cast<std::size_t>(rank(b))].faces.push_back(b);
}

CoincidentFaces::CoincidentFaces(const SceneDescription& description, std::span<const Placement> placements) {
    for (const Material& m : description.materials) ranks_.push_back(rankOfMaterial(m));
    const auto meshOf = [&](std::uint32_t geometry) -> const Mesh& {
        return description.meshes[description.geometries[geometry].mesh];
    };
    const auto cornersOf = [&](const FaceId& f) {
        return cornersIn(placements[f.geometry], meshOf(f.geometry), f.primitive);
    };
    std::uint64_t triangles = 0;
    for (const Geometry& g : description.geometries) triangles += description.meshes[g.mesh].triangles.size();
    if (triangles > kMostTriangles) return;

    std::vector<FaceId> faces;
    std::vector<Bounds> boxes;
    std::vector<glm::vec3> normals;
    std::vector<std::uint32_t> seekers, all;
    Bounds sought;
    const auto take = [&](bool solid) {
        for (std::uint32_t g = 0; g < description.geometries.size(); ++g) {
            if ((ranks_[meshOf(g).material] == FaceRank::Solid) != solid) continue;
            for (std::uint32_t i = 0; i < meshOf(g).triangles.size(); ++i) {
                const Corners corners = cornersOf({g, i});
                const Bounds box = boxOf(corners);
                if (solid && !overlap(box, sought)) continue;
                all.push_back(static_cast<std::uint32_t>(faces.size()));
                faces.push_back({g, i});
                boxes.push_back(box);
                normals.push_back(frontOf(corners, placements[g].mirrored));
            }
        }
    };
    take(false);
    seekers = all;
    for (const Bounds& box : boxes) sought.extend(box);
    if (!seekers.empty()) take(true);

    gaveUp_ = !forOverlappingPairs(boxes, seekers, all, [&](std::uint32_t i, std::uint32_t j) {
        const FaceId &a = faces[i], &b = faces[j];
        const std::uint32_t materialA = meshOf(a.geometry).material, materialB = meshOf(b.geometry).material;
        const FaceRank rankA = ranks_[materialA], rankB = ranks_[materialB];
        const bool glass = rankA == FaceRank::Body && rankB == FaceRank::Body;
        // Each pair once: two seekers come both ways round.
        if (rankB != FaceRank::Solid && (glass ? b < a : rankB <= rankA)) return;
        if (glass && !(isClearBody(description.materials[materialA]) && isClearBody(description.materials[materialB])))
            return;
        const float turned = glm::dot(normals[i], normals[j]);
        if (glass ? turned > -kAlike : std::fabs(turned) < kAlike) return;
        const Corners cornersA = cornersOf(a), cornersB = cornersOf(b);
        if (!lieTogether(cornersA, cornersB)) return;
        if (glass) {
            glass_[keyOf(a)].emplace_back(b, cornersB);
            glass_[keyOf(b)].emplace_back(a, cornersA);
            note(description, a, kTouchesGlass);
            note(description, b, kTouchesGlass);
        } else if (rankA < rankB) {
            relate(description, a, b);
        } else {
            relate(description, b, a);
        }
        ++pairs_;
    });

    for (Layer& layer : layers_) {
        if (layer.faces.empty()) continue;
        std::sort(layer.faces.begin(), layer.faces.end());
        layer.faces.erase(std::unique(layer.faces.begin(), layer.faces.end()), layer.faces.end());
        Mesh mesh;
        for (const FaceId& f : layer.faces) {
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            for (const glm::vec3& p : cornersOf(f)) mesh.positions.push_back(p);
            mesh.triangles.emplace_back(first, first + 1, first + 2);
        }
        const std::uint32_t meshOfGeometry = 0;
        const glm::mat4 inPlace(1.0F);
        layer.accel =
            std::make_unique<Accel>(std::span(&mesh, 1), std::span(&meshOfGeometry, 1), std::span(&inPlace, 1));
    }
}

std::optional<RawHit> CoincidentFaces::find(FaceRank rank, const SurfacePoint& at) const noexcept {
    const Layer& layer = layers_[static_cast<std::size_t>(rank)];
    if ((othersOf({at.geometry, at.primitive}) & bit(rank)) == 0 || layer.accel == nullptr) return std::nullopt;
    const glm::vec3& n = at.geometricNormal;
    const float reach = 2.0F * rayOffset(at.position, n);
    RawHit hit;
    if (!layer.accel->intersect(Ray{at.position + reach * n, -n, 2.0F * reach}, hit)) return std::nullopt;
    const FaceId& f = layer.faces[hit.primitive];
    hit.geometry = f.geometry;
    hit.primitive = f.primitive;
    return hit;
}

std::optional<RawHit> CoincidentFaces::touching(const SurfacePoint& at) const noexcept {
    const FaceId face{at.geometry, at.primitive};
    if ((othersOf(face) & kTouchesGlass) == 0) return std::nullopt;
    for (const auto& [other, corners] : glass_.at(keyOf(face)))
        if (const auto foot = footIn(corners, at.position))
            return RawHit{other.geometry, other.primitive, static_cast<float>(foot->x), static_cast<float>(foot->y),
                          0.0F};
    return std::nullopt;
}

}  // namespace pellucid

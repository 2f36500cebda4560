#include <pellucid/transport/irradiance_cache.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid {

namespace {

/// The extrapolated irradiance stays within this factor of the record's own.
constexpr float kMinFactor = 0.05F, kMaxFactor = 4.0F;
constexpr int kMaxDepth = 20;
/// A record does not speak for points that lie behind it by more than this share of its radius.
constexpr float kBehind = 0.02F;

[[nodiscard]] Rgb extrapolate(const IrradianceRecord& r, const glm::vec3& offset, const glm::vec3& normal) noexcept {
    const glm::vec3 turn = glm::cross(r.normal, normal);
    Rgb e = r.irradiance;
    for (glm::length_t c = 0; c < 3; ++c) {
        const auto i = static_cast<std::size_t>(c);
        e[c] += glm::dot(turn, r.rotation[i]) + glm::dot(offset, r.translation[i]);
    }
    return glm::clamp(e, r.irradiance * kMinFactor, r.irradiance * kMaxFactor);
}

}  // namespace

IrradianceCache::IrradianceCache(const Bounds& scene, float error) : error_(error) {
    const glm::vec3 diagonal = scene.diagonal();
    size_ = 1.01F * std::max(diagonal.x, std::max(diagonal.y, diagonal.z));
    lower_ = scene.centre() - glm::vec3(0.5F * size_);
    nodes_.emplace_back();
}

template <class Visit>
void IrradianceCache::forNear(const glm::vec3& point, Visit&& visit) const {
    std::int32_t node = 0;
    glm::vec3 centre = lower_ + glm::vec3(0.5F * size_);
    float quarter = 0.25F * size_;
    while (node >= 0) {
        const Node& n = nodes_[static_cast<std::size_t>(node)];
        for (const std::uint32_t r : n.records) visit(r);
        std::size_t octant = 0;
        for (glm::length_t a = 0; a < 3; ++a) {
            const bool upper = point[a] >= centre[a];
            if (upper) octant |= std::size_t{1} << static_cast<unsigned>(a);
            centre[a] += upper ? quarter : -quarter;
        }
        quarter *= 0.5F;
        node = n.child[octant];
    }
}

/// Stores the record in every node of about its reach's size that its sphere touches.
void IrradianceCache::place(std::uint32_t node, const glm::vec3& lower, float size, std::uint32_t record, float reach) {
    float s = size;
    int depth = 0;
    while (s > 2.0F * reach && depth < kMaxDepth) s *= 0.5F, ++depth;
    const glm::vec3& p = records_[record].position;
    struct Open {
        std::uint32_t node;
        glm::vec3 lower;
        float size;
        int depth;
    };
    std::vector<Open> open{{node, lower, size, 0}};
    while (!open.empty()) {
        const Open o = open.back();
        open.pop_back();
        if (o.depth == depth) {
            nodes_[o.node].records.push_back(record);
            continue;
        }
        const float half = 0.5F * o.size;
        for (unsigned octant = 0; octant < 8; ++octant) {
            const glm::vec3 corner =
                o.lower + half * glm::vec3((octant & 1U) != 0 ? 1.0F : 0.0F, (octant & 2U) != 0 ? 1.0F : 0.0F,
                                           (octant & 4U) != 0 ? 1.0F : 0.0F);
            if (glm::any(glm::greaterThan(corner, p + reach)) || glm::any(glm::lessThan(corner + half, p - reach)))
                continue;
            std::int32_t child = nodes_[o.node].child[octant];
            if (child < 0) {
                child = static_cast<std::int32_t>(nodes_.size());
                nodes_[o.node].child[octant] = child;
                nodes_.emplace_back();
            }
            open.push_back({static_cast<std::uint32_t>(child), corner, half, o.depth + 1});
        }
    }
}

void IrradianceCache::adopt(const IrradianceRecord& record, float reach) {
    records_.push_back(record);
    reaches_.push_back(reach);
    place(0, lower_, size_, static_cast<std::uint32_t>(records_.size() - 1), reach);
}

void IrradianceCache::insert(IrradianceRecord record) {
    forNear(record.position, [&](std::uint32_t i) {
        const IrradianceRecord& other = records_[i];
        if (glm::dot(other.normal, record.normal) < 0.5F) return;
        record.radius = std::min(record.radius, other.radius + glm::length(other.position - record.position));
    });
    forNear(record.position, [&](std::uint32_t i) {
        IrradianceRecord& other = records_[i];
        if (glm::dot(other.normal, record.normal) < 0.5F) return;
        other.radius = std::min(other.radius, record.radius + glm::length(other.position - record.position));
    });
    adopt(record, record.radius * error_);
}

/// Ward's error of `record` at a point; infinite where it may not speak. [Ward1988]
static float wardError(const IrradianceRecord& r, const glm::vec3& offset, const glm::vec3& normal,
                       float limit) noexcept {
    constexpr float kSilent = std::numeric_limits<float>::infinity();
    const float distance2 = glm::dot(offset, offset);
    const float reach = limit * r.radius;
    if (distance2 >= reach * reach) return kSilent;
    if (glm::dot(offset, normal + r.normal) < -2.0F * kBehind * r.radius) return kSilent;
    const float error = std::sqrt(distance2) / r.radius + std::sqrt(std::max(0.0F, 1.0F - glm::dot(normal, r.normal)));
    return error < limit ? error : kSilent;
}

bool IrradianceCache::covers(const glm::vec3& position, const glm::vec3& normal, float limit, std::size_t old,
                             float largestOld) const noexcept {
    bool covered = false;
    forNear(position, [&](std::uint32_t i) {
        if (i < old && records_[i].radius > largestOld) return;
        covered = covered || wardError(records_[i], position - records_[i].position, normal, limit) < limit;
    });
    return covered;
}

std::optional<Irradiance> IrradianceCache::lookup(const glm::vec3& position, const glm::vec3& normal) const noexcept {
    Irradiance sum;
    float weights = 0.0F;
    forNear(position, [&](std::uint32_t i) {
        const IrradianceRecord& r = records_[i];
        const glm::vec3 offset = position - r.position;
        const float error = wardError(r, offset, normal, error_);
        if (error >= error_) return;
        // Falls to zero where the record stops to speak: no seam at its border.
        const float weight = 1.0F / std::max(error, 1e-4F) - 1.0F / error_;
        const Rgb e = extrapolate(r, offset, normal);
        sum.plain += weight * e;
        sum.grazing += weight * e * r.grazingShare;
        weights += weight;
        ++sum.records;
    });
    if (!(weights > 0.0F)) return std::nullopt;
    sum.plain /= weights;
    sum.grazing /= weights;
    return sum;
}

}  // namespace pellucid

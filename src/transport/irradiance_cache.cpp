#include <pellucid/transport/irradiance_cache.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <pellucid/math/constants.h>
#include <pellucid/math/frame.h>
#include <pellucid/scene/scene.h>

namespace pellucid {

namespace {

/// The extrapolated irradiance stays within this factor of the record's own.
constexpr float kMinFactor = 0.05F, kMaxFactor = 4.0F;
constexpr int kMaxDepth = 20;
/// A record does not speak for points that lie behind it by more than this share of its radius.
constexpr float kBehind = 0.02F;
/// Nor for points off its surface, above or below, by more than this share of their distance: another sheet, a step. (And by
/// what floats make of a flat surface, in scene units.)
constexpr float kStep = 0.02F, kRounding = 2e-6F;
/// 1 - n.n_i that Tabellion's error of the normals compares with: of 10 degrees, at the default error.
constexpr float kTabellionNormals = 0.0151922F, kTabellionError = 0.25F;
/// A shadow ray between a record and a point runs this share of their distance above both: over the surface's own bumps,
/// under what stands in the way.
constexpr float kLift = 0.1F;
/// Cosine of a degree: a normal that is mapped by less is as one of the surface, by the rotational gradient.
constexpr float kUnturned = 0.99985F;
constexpr float kSilent = std::numeric_limits<float>::infinity();

/// The azimuth's sector around the record's normal.
[[nodiscard]] unsigned sectorOf(const Frame& frame, const glm::vec3& offset) noexcept {
    const float turn = std::atan2(glm::dot(offset, frame.bitangent), glm::dot(offset, frame.tangent)) / kTwoPi;
    return static_cast<unsigned>(static_cast<int>(std::floor(turn * static_cast<float>(kBlockedSectors)))) %
           kBlockedSectors;
}

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

IrradianceCache::IrradianceCache(const Bounds& bounds, float error, CacheMetric metric, const Scene* scene)
    : error_(error), metric_(metric), scene_(scene) {
    const glm::vec3 diagonal = bounds.diagonal();
    size_ = 1.01F * std::max(diagonal.x, std::max(diagonal.y, diagonal.z));
    lower_ = bounds.centre() - glm::vec3(0.5F * size_);
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

void IrradianceCache::adopt(const IrradianceRecord& record, float reach, const LightByDirection* light) {
    records_.push_back(record);
    reaches_.push_back(reach);
    if (light != nullptr) lights_.push_back(*light);
    place(0, lower_, size_, static_cast<std::uint32_t>(records_.size() - 1), reach);
}

void IrradianceCache::insert(IrradianceRecord record, const LightByDirection* light) {
    clampWithNeighbours(record);
    adopt(record, record.radius * error_, light);
}

/// Each radius by the others' plus their distance: a record finds out from its neighbours what its own rays have missed.
/// [Krivanek2006] The Hessian sees the same from the edges around; by it only records of other views shrink, which would
/// speak beside the finer ones that this view has added.
void IrradianceCache::clampWithNeighbours(IrradianceRecord& record) {
    const bool bothWays = metric_ != CacheMetric::Hessian;
    if (bothWays)
        forNear(record.position, [&](std::uint32_t i) {
            const IrradianceRecord& other = records_[i];
            if (glm::dot(other.normal, record.normal) < 0.5F) return;
            record.radius = std::min(record.radius, other.radius + glm::length(other.position - record.position));
        });
    forNear(record.position, [&](std::uint32_t i) {
        IrradianceRecord& other = records_[i];
        if (glm::dot(other.normal, record.normal) < 0.5F || (!bothWays && other.born >= record.born)) return;
        other.radius = std::min(other.radius, record.radius + glm::length(other.position - record.position));
    });
}

/// Ward's sum of distance over radius and sqrt(1 - n.n_i) [Ward1988]; the larger of the two against 10 degrees
/// [TabellionLamorlette2004]; their root of squares over an ellipse for Hessian records.
IrradianceCache::Judged IrradianceCache::judge(const IrradianceRecord& r, const glm::vec3& offset,
                                               const glm::vec3& normal, float limit) const noexcept {
    const float along = glm::dot(offset, r.squeeze);
    const float distance2 = glm::dot(offset, offset) + along * along;
    const float reach = limit * r.radius;
    if (!(distance2 < reach * reach)) return {kSilent, Silence::Distance};
    const float height = 0.5F * glm::dot(offset, normal + r.normal),
                turn2 = std::max(0.0F, 1.0F - glm::dot(normal, r.normal));
    // Along an arc a chord is square to the mean normal: off it by more than its ends turn is another surface.
    const float step = kRounding + glm::length(offset) * (kStep + std::sqrt(turn2));
    if (height < -kBehind * r.radius || std::fabs(height) > step) return {kSilent, Silence::Behind};
    const float distance = std::sqrt(distance2) / r.radius;
    float error = 0.0F, ofNormals = std::sqrt(turn2);
    switch (metric_) {
        case CacheMetric::Ward:
            error = distance + ofNormals;
            break;
        case CacheMetric::Tabellion:
            ofNormals *= kTabellionError / std::sqrt(kTabellionNormals);
            error = std::max(distance, ofNormals);
            break;
        case CacheMetric::Hessian:
            error = std::sqrt(distance * distance + turn2);
            break;
    }
    if (error < limit) return {error, Silence::None};
    return {kSilent, ofNormals >= limit ? Silence::Normal : Silence::Error};
}

/// Falls to zero where the record stops to speak: no seam at its border.
float IrradianceCache::weightOf(float error) const noexcept {
    if (metric_ == CacheMetric::Ward) return 1.0F / std::max(error, 1e-4F) - 1.0F / error_;
    return 1.0F - error / error_;
}

/// Whether something stands between a record and a point of the same surface: looked for only in the azimuths where the
/// record's own rays met something near.
bool IrradianceCache::isBlocked(const IrradianceRecord& r, const glm::vec3& position, const glm::vec3& normal,
                                std::uint64_t* rays) const noexcept {
    if (r.blocked == 0 || scene_ == nullptr) return false;
    const glm::vec3 offset = position - r.position;
    if ((r.blocked >> sectorOf(Frame(r.normal), offset) & 1U) == 0) return false;
    const float lift = kLift * glm::length(offset);
    const glm::vec3 from = offsetOrigin(position + normal * lift, normal),
                    to = offsetOrigin(r.position + r.normal * lift, r.normal) - from;
    const float length = glm::length(to);
    if (!(length > 0.0F)) return false;
    if (rays != nullptr) ++*rays;
    return scene_->visibility(Ray{from, to / length, length}) <= 0.0F;
}

bool IrradianceCache::covers(const glm::vec3& position, const glm::vec3& normal, float limit, std::size_t old,
                             float largestOld) const noexcept {
    bool covered = false;
    forNear(position, [&](std::uint32_t i) {
        const IrradianceRecord& r = records_[i];
        if (covered || (i < old && r.radius > largestOld)) return;
        covered =
            judge(r, position - r.position, normal, limit).error < limit && !isBlocked(r, position, normal, nullptr);
    });
    return covered;
}

std::optional<Irradiance> IrradianceCache::lookup(const glm::vec3& position, const glm::vec3& normal,
                                                  std::uint64_t* rays) const noexcept {
    return lookup(position, normal, normal, rays);
}

std::optional<Irradiance> IrradianceCache::lookup(const glm::vec3& position, const glm::vec3& normal,
                                                  const glm::vec3& mapped, std::uint64_t* rays) const noexcept {
    const bool turned = !lights_.empty() && glm::dot(normal, mapped) < kUnturned;
    Irradiance sum;
    float weights = 0.0F;
    forNear(position, [&](std::uint32_t i) {
        const IrradianceRecord& r = records_[i];
        const glm::vec3 offset = position - r.position;
        const float error = judge(r, offset, normal, error_).error;
        if (error >= error_ || isBlocked(r, position, normal, rays)) return;
        const float weight = weightOf(error);
        Rgb e = extrapolate(r, offset, turned ? normal : mapped), grazing = r.grazingShare;
        if (turned) {
            const TurnedLight light = turnLight(lights_[i], Frame(r.normal).toLocal(mapped));
            e *= light.ratio;
            grazing = light.grazingShare;
        }
        sum.plain += weight * e;
        sum.grazing += weight * e * grazing;
        sum.noise += weight * r.noise;
        weights += weight;
        ++sum.records;
    });
    if (!(weights > 0.0F)) return std::nullopt;
    sum.plain /= weights;
    sum.grazing /= weights;
    sum.noise /= weights;
    return sum;
}

std::vector<IrradianceCache::Speaker> IrradianceCache::speakers(const glm::vec3& position, const glm::vec3& normal,
                                                                Silence& objection) const {
    std::vector<Speaker> list;
    objection = Silence::Nobody;
    forNear(position, [&](std::uint32_t i) {
        const IrradianceRecord& r = records_[i];
        Judged judged = judge(r, position - r.position, normal, error_);
        if (judged.silence == Silence::None && isBlocked(r, position, normal, nullptr))
            judged.silence = Silence::Blocked;
        objection = std::min(objection, judged.silence);
        if (judged.silence == Silence::None) list.push_back({i, weightOf(judged.error)});
    });
    return list;
}

}  // namespace pellucid

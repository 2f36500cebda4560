/// The irradiance cache: indirect irradiance at sparse records, interpolated with Ward's weights [Ward1988] and rotational
/// and translational gradients [WardHeckbert1992], radii clamped between neighbours [Krivanek2006]. Bias enters here: the
/// interpolation is of first order, and a record speaks for a region. How far is the metric's matter (cache_metric.h); what
/// stands in between is found by a short shadow ray where the record's gather rays met something near. Look-ups are
/// read-only and lock-free; records are added between rounds in one order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include <pellucid/math/bounds.h>
#include <pellucid/math/rgb.h>
#include <pellucid/surface/bsdf.h>
#include <pellucid/transport/cache_metric.h>
#include <pellucid/transport/light_by_direction.h>

namespace pellucid {

class Scene;

/// One gather. Gradients hold a column for each colour channel.
struct IrradianceRecord {
    glm::vec3 position{0.0F}, normal{0.0F};
    Rgb irradiance{0.0F};                 ///< W m^-2
    Rgb grazingShare{0.0F};               ///< E5 / E (surface/bsdf.h, DiffuseLobe)
    float noise = 0.0F;                   ///< W m^-2, luminance: a draw from the distribution of the irradiance's error
    std::array<glm::vec3, 3> rotation{};  ///< dE/d(rotation), rad^-1, as (n_i x n) . rotation
    std::array<glm::vec3, 3> translation{};  ///< dE/dx, per scene unit
    float harmonicDistance = 0.0F;           ///< R: mean distance of what is seen
    float radius = 0.0F;                     ///< R after bounds and neighbour clamping
    glm::vec3 squeeze{0.0F};  ///< distances along it count sqrt(1 + |squeeze|^2) times: across it the record is R long
    std::uint32_t blocked = 0;  ///< by azimuth: something stands within the record's reach
    std::uint32_t born = 0;     ///< views that had added to the cache before
};
/// Sectors of `blocked`, from the tangent of Frame(normal) on.
inline constexpr unsigned kBlockedSectors = 32;

/// What keeps a record from speaking at a point, from the mildest to the strongest objection.
enum class Silence : std::uint8_t {
    None,      ///< it speaks
    Blocked,   ///< something stands in between
    Error,     ///< within its reach, but distance and normal are too much together
    Normal,    ///< the normals differ too much, whatever the distance
    Behind,    ///< the point lies behind the record
    Distance,  ///< out of its reach
    Nobody     ///< there is no record anywhere near
};

struct Irradiance {
    Rgb plain{0.0F}, grazing{0.0F};  ///< E and E5
    float noise = 0.0F;              ///< as the records' own
    int records = 0;                 ///< that spoke

    /// int L T(wi) cos for a lobe: a E - b E5.
    [[nodiscard]] Rgb through(const DiffuseLobe& lobe) const noexcept {
        return glm::max(lobe.a * plain - lobe.b * grazing, Rgb(0.0F));
    }
};

class IrradianceCache {
public:
    /// A record speaks where its error by `metric` is below `error`; for Ward's: |x - x_i| / R_i + sqrt(1 - n.n_i) < a.
    /// `scene`: where shadow rays between records and points are traced; null: none are.
    explicit IrradianceCache(const Bounds& bounds, float error, CacheMetric metric = CacheMetric::Ward,
                             const Scene* scene = nullptr);

    /// Adds a record; clamps its radius and its neighbours' (each by the other's plus their distance);
    /// by Hessian only those of other views.
    /// `light`: what a record needs to answer for mapped normals; of all records or of none (null).
    void insert(IrradianceRecord record, const LightByDirection* light = nullptr);

    /// Adds a record as it is, found within `reach`: from records() and reaches(), in order, the same cache comes back.
    void adopt(const IrradianceRecord& record, float reach, const LightByDirection* light = nullptr);

    /// Empty where no record speaks. `rays` counts the shadow rays (null: nobody does). `normal`: without normal maps.
    [[nodiscard]] std::optional<Irradiance> lookup(const glm::vec3& position, const glm::vec3& normal,
                                                   std::uint64_t* rays = nullptr) const noexcept;
    /// The same on a normal that a map has turned to `mapped`: the same records speak.
    [[nodiscard]] std::optional<Irradiance> lookup(const glm::vec3& position, const glm::vec3& normal,
                                                   const glm::vec3& mapped,
                                                   std::uint64_t* rays = nullptr) const noexcept;

    /// For layers: the records that speak there, with their weights, and the mildest objection of one that does not.
    struct Speaker {
        std::uint32_t record;
        float weight;
    };
    [[nodiscard]] std::vector<Speaker> speakers(const glm::vec3& position, const glm::vec3& normal,
                                                Silence& objection) const;

    /// Whether some record speaks there with an error below `limit` (at most error()). Of the first `old` records only those
    /// count that have at most this radius: others were made for a view from farther away.
    [[nodiscard]] bool covers(const glm::vec3& position, const glm::vec3& normal, float limit, std::size_t old = 0,
                              float largestOld = std::numeric_limits<float>::infinity()) const noexcept;

    [[nodiscard]] const std::vector<IrradianceRecord>& records() const noexcept { return records_; }
    /// By record: how far it is looked for. Its radius may have shrunk since.
    [[nodiscard]] const std::vector<float>& reaches() const noexcept { return reaches_; }
    /// By record: empty where no normal is mapped.
    [[nodiscard]] const std::vector<LightByDirection>& lights() const noexcept { return lights_; }
    [[nodiscard]] float error() const noexcept { return error_; }
    [[nodiscard]] CacheMetric metric() const noexcept { return metric_; }

private:
    struct Node {
        std::array<std::int32_t, 8> child{-1, -1, -1, -1, -1, -1, -1, -1};
        std::vector<std::uint32_t> records;
    };
    template <class Visit>
    void forNear(const glm::vec3& point, Visit&& visit) const;
    /// A record's error and weight at a point; the error is infinite where it may not speak.
    struct Judged {
        float error;
        Silence silence;
    };
    [[nodiscard]] Judged judge(const IrradianceRecord& r, const glm::vec3& offset, const glm::vec3& normal,
                               float limit) const noexcept;
    [[nodiscard]] float weightOf(float error) const noexcept;
    [[nodiscard]] bool isBlocked(const IrradianceRecord& r, const glm::vec3& position, const glm::vec3& normal,
                                 std::uint64_t* rays) const noexcept;
    void clampWithNeighbours(IrradianceRecord& record);
    void place(std::uint32_t node, const glm::vec3& lower, float size, std::uint32_t record, float reach);

    float error_;
    CacheMetric metric_;
    const Scene* scene_;
    glm::vec3 lower_;
    float size_;
    std::vector<Node> nodes_;
    std::vector<IrradianceRecord> records_;
    std::vector<float> reaches_;
    std::vector<LightByDirection> lights_;
};

}  // namespace pellucid

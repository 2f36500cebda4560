// Each fast path against its simple twin: the kd-tree against the sum over all photons, the cache's index against every
// record by itself, guided emission against unguided, the ray tracer against all triangles one by one.
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/geometry/accel.h>
#include <pellucid/math/constants.h>
#include <pellucid/math/hash.h>
#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>
#include <pellucid/transport/caustic_map.h>
#include <pellucid/transport/irradiance_cache.h>
#include <pellucid/transport/photon_trace.h>

namespace pellucid {
namespace {

class Numbers {
public:
    explicit Numbers(std::uint64_t key) : key_(key) {}
    [[nodiscard]] float next() { return static_cast<float>(hashCombine(key_, counter_++) >> 40U) * 0x1p-24F; }
    [[nodiscard]] float between(float a, float b) { return a + (b - a) * next(); }

private:
    std::uint64_t key_, counter_ = 0;
};

const glm::vec3 kUp(0, 0, 1);

TEST(FastPaths, PhotonTreeIsTheSumOverAllPhotons) {
    Numbers random(1);
    PhotonList photons;
    for (int i = 0; i < 20'000; ++i) {
        Photon p;
        // Some lie in one point, some on the other side or off the plane: those must not count.
        const bool repeated = i % 7 == 0;
        p.position = repeated ? glm::vec3(0.25F, 0.5F, 0.0F) : glm::vec3(random.next(), random.next(), 0.0F);
        p.normal = i % 11 == 0 ? -kUp : kUp;
        if (i % 13 == 0) p.position.z = 0.2F;
        p.wi = p.normal;
        p.flux = Rgb(random.next(), random.next(), random.next());
        photons.push_back(p);
    }
    const DiffuseLobe lobe{Rgb(1.0F)};
    const CausticMap map(photons);
    const PhotonList kept = map.photons();  // their powers are rounded
    ASSERT_EQ(kept.size(), photons.size());
    for (int query = 0; query < 200; ++query) {
        const glm::vec3 at(random.next(), random.next(), 0.0F);
        const float radius = random.between(0.002F, 0.3F);
        glm::dvec3 sum(0.0);
        for (const Photon& p : kept) {
            const double d2 = static_cast<double>(glm::dot(p.position - at, p.position - at)),
                         r2 = static_cast<double>(radius) * static_cast<double>(radius);
            if (d2 < r2 && p.normal.z > 0.0F && p.position.z == 0.0F)
                sum += glm::dvec3(p.flux) * (1.0 - d2 / r2) * 2.0 / (kPiD * r2);
        }
        const Rgb found = map.irradiance(at, kUp, kUp, lobe, radius);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(static_cast<double>(found[c]), sum[c], 2e-4 * sum[c] + 1e-3) << query;
    }
}

TEST(FastPaths, CacheIndexFindsExactlyTheRecordsThatSpeak) {
    Numbers random(2);
    Bounds bounds;
    bounds.extend(glm::vec3(-1.0F));
    bounds.extend(glm::vec3(1.0F));
    constexpr float kError = 0.3F;
    IrradianceCache cache(bounds, kError);
    for (int i = 0; i < 400; ++i) {
        IrradianceRecord r;
        r.position = {random.between(-1, 1), random.between(-1, 1), i % 3 == 0 ? 0.0F : random.between(-1, 1)};
        r.normal = i % 5 == 0 ? -kUp : kUp;
        r.irradiance = Rgb(random.next());
        r.radius = r.harmonicDistance = std::exp(random.between(-5.0F, 0.0F));
        cache.insert(r);
    }
    std::vector<IrradianceCache> alone;  // one cache a record: nothing to be found in, nothing to be missed
    for (const IrradianceRecord& r : cache.records()) {
        alone.emplace_back(bounds, kError);
        alone.back().insert(r);
    }
    int spoken = 0;
    for (int query = 0; query < 1000; ++query) {
        const glm::vec3 at(random.between(-1, 1), random.between(-1, 1), query % 2 == 0 ? 0.0F : random.between(-1, 1));
        const auto found = cache.lookup(at, kUp);
        int expected = 0;
        float least = 1e30F, most = -1e30F;
        for (const IrradianceCache& one : alone)
            if (const auto e = one.lookup(at, kUp)) {
                ++expected;
                least = std::min(least, e->plain.g);
                most = std::max(most, e->plain.g);
            }
        ASSERT_EQ(found ? found->records : 0, expected) << query;
        ASSERT_EQ(cache.covers(at, kUp, kError), expected > 0) << query;
        if (!found) continue;
        ++spoken;
        EXPECT_GE(found->plain.g, least - 1e-5F);
        EXPECT_LE(found->plain.g, most + 1e-5F);
    }
    EXPECT_GT(spoken, 50);
}

/// Moeller and Trumbore's test in double: distance, and how far inside of the triangle's edges (barycentric) the hit lies.
struct SlowHit {
    double t = std::numeric_limits<double>::infinity(), inside = 0.0;
};
[[nodiscard]] std::optional<SlowHit> hitTriangle(const Ray& ray, const glm::dvec3& a, const glm::dvec3& b,
                                                 const glm::dvec3& c) {
    const glm::dvec3 d(ray.direction), ab = b - a, ac = c - a, p = glm::cross(d, ac);
    const double determinant = glm::dot(ab, p);
    if (determinant == 0.0) return std::nullopt;
    const glm::dvec3 to = glm::dvec3(ray.origin) - a, q = glm::cross(to, ab);
    const double u = glm::dot(to, p) / determinant, v = glm::dot(d, q) / determinant;
    if (u < 0.0 || v < 0.0 || u + v > 1.0) return std::nullopt;
    return SlowHit{glm::dot(ac, q) / determinant, std::min({u, v, 1.0 - u - v})};
}

TEST(FastPaths, RayTracerFindsWhatAllTrianglesOneByOneSay) {
    Numbers random(3);
    const auto point = [&random](float size) {
        return glm::vec3(random.between(-size, size), random.between(-size, size), random.between(-size, size));
    };
    std::vector<Mesh> meshes(2);
    for (Mesh& mesh : meshes)
        for (std::uint32_t i = 0; i < 300; ++i) {
            const glm::vec3 corner = point(1.0F);
            for (const glm::vec3& p : {corner, corner + point(0.2F), corner + point(0.2F)}) mesh.positions.push_back(p);
            mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
        }
    const std::vector<std::uint32_t> meshOf{0, 1, 1};
    std::vector<glm::mat4> toScene(3, glm::mat4(1.0F));
    toScene[2][3] = glm::vec4(0.5F, 0.0F, 0.0F, 1.0F);  // the second mesh once more, aside
    toScene[2][1][1] = -1.0F;                           // and mirrored
    const Accel accel(meshes, meshOf, toScene);
    int hits = 0;
    for (int i = 0; i < 3000; ++i) {
        const glm::vec3 origin = point(2.0F);
        const Ray ray{origin, glm::normalize(point(1.0F) - origin), std::numeric_limits<float>::infinity()};
        SlowHit nearest;
        double margin = std::numeric_limits<double>::infinity();  // of all that lies on the way: edges may round
        for (std::size_t g = 0; g < meshOf.size(); ++g)
            for (const glm::uvec3& t : meshes[meshOf[g]].triangles) {
                const auto corner = [&](std::uint32_t v) {
                    return glm::dvec3(glm::dmat4(toScene[g]) * glm::dvec4(meshes[meshOf[g]].positions[v], 1.0));
                };
                const auto hit = hitTriangle(ray, corner(t.x), corner(t.y), corner(t.z));
                if (!hit || hit->t <= 0.0) continue;
                margin = std::min({margin, hit->inside, hit->t});
                if (hit->t < nearest.t) nearest = *hit;
            }
        if (margin < 1e-4) continue;
        RawHit found;
        const bool any = accel.intersect(ray, found);
        ASSERT_EQ(any, std::isfinite(nearest.t)) << i;
        ASSERT_EQ(accel.occluded(ray), any) << i;
        if (!any) continue;
        ++hits;
        EXPECT_NEAR(static_cast<double>(found.t), nearest.t, 1e-5 * (1.0 + nearest.t)) << i;
        Ray shorter = ray;
        shorter.tMax = found.t * 0.999F;
        EXPECT_FALSE(accel.occluded(shorter)) << i;
    }
    EXPECT_GT(hits, 500);
}

/// A glass ball over a floor under a point light.
[[nodiscard]] SceneDescription ballOverFloor() {
    SceneDescription d;
    Material floor, ball;
    floor.metallic = ball.metallic = 0.0F;
    floor.specular = 0.0F;
    floor.baseColor = glm::vec4(0.5F, 0.5F, 0.5F, 1.0F);
    ball.roughness = 0.0F;
    ball.transmission = ball.thickness = 1.0F;
    d.materials = {floor, ball};
    Mesh plane;
    plane.positions = {{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}};
    plane.triangles = {{0, 1, 2}, {0, 2, 3}};
    Mesh sphere;
    sphere.material = 1;
    constexpr std::uint32_t kRings = 24, kColumns = 48;
    for (std::uint32_t j = 0; j <= kRings; ++j)
        for (std::uint32_t i = 0; i <= kColumns; ++i) {
            const double phi = i == kColumns ? 0.0 : 2.0 * kPiD * i / kColumns, theta = kPiD * j / kRings,
                         s = j == 0 || j == kRings ? 0.0 : std::sin(theta);
            sphere.positions.emplace_back(
                glm::dvec3(0.3 * s * std::cos(phi), 0.3 * s * std::sin(phi), 0.6 + 0.3 * std::cos(theta)));
        }
    for (std::uint32_t j = 0; j < kRings; ++j)
        for (std::uint32_t i = 0; i < kColumns; ++i) {
            const std::uint32_t a = j * (kColumns + 1) + i, b = a + kColumns + 1;
            if (j > 0) sphere.triangles.emplace_back(a, b, a + 1);
            if (j + 1 < kRings) sphere.triangles.emplace_back(a + 1, b, b + 1);
        }
    d.meshes = {plane, sphere};
    d.geometries.resize(2);
    d.geometries[1].mesh = 1;
    PunctualLight light;
    light.position = {0.5, 0.2, 2.5};
    d.lights = {light};
    return d;
}

TEST(FastPaths, GuidedEmissionBringsTheSameFluxAsUnguided) {
    const Workers workers(2);
    const Scene scene(ballOverFloor(), std::nullopt, SceneOptions{}, workers);
    const EmissionGuide unguided(scene.lights(), {});
    constexpr int kPasses = 16;
    const auto stored = [&](const EmissionGuide& guide, std::uint64_t pass, std::uint32_t paths) {
        return traceCausticPhotons(scene, guide, {5, pass, paths}, nullptr, workers).energy.stored;
    };
    const EmissionGuide guided(scene.lights(),
                               traceCausticPhotons(scene, unguided, {5, 1000, 20'000}, nullptr, workers).useful);
    const auto figures = [&](const EmissionGuide& guide, std::uint64_t first) {
        double mean = 0.0, square = 0.0;
        for (std::uint64_t i = 0; i < kPasses; ++i) {
            const double e = stored(guide, first + i, 20'000);
            mean += e / kPasses;
            square += e * e / kPasses;
        }
        return std::pair(mean, (square - mean * mean) / (kPasses - 1.0));  // and the variance of the mean
    };
    const auto [plainMean, plainVariance] = figures(unguided, 0);
    const auto [guidedMean, guidedVariance] = figures(guided, 100);
    EXPECT_GT(plainMean, 0.0);
    EXPECT_LT(std::fabs(plainMean - guidedMean), 4.5 * std::sqrt(plainVariance + guidedVariance))
        << plainMean << " " << guidedMean;
    EXPECT_LT(guidedVariance, 0.25 * plainVariance);  // what it is for
}

}  // namespace
}  // namespace pellucid

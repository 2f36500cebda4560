#include <pellucid/scene/scene.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <utility>

#include <pellucid/base/error.h>
#include <pellucid/math/hash.h>

#include "scene_impl.h"

namespace pellucid {

/// Beer's coefficients are per metre in the file and per normalised unit from here on.
void Scene::Impl::scaleMaterials() {
    for (Material& m : description.materials) m.absorption *= static_cast<float>(1.0 / normalisation.scale());
}

void Scene::Impl::placeGeometry() {
    std::vector<glm::mat4> toScene;
    std::vector<std::uint32_t> meshOf;
    std::vector<int> uses(description.meshes.size(), 0);
    for (const Geometry& g : description.geometries) ++uses[g.mesh];
    for (const Geometry& g : description.geometries) {
        placements.push_back(place(normalisation, g));
        if (uses[g.mesh] == 1) bake(placements.back(), description.meshes[g.mesh]);
        toScene.push_back(placements.back().toScene);
        meshOf.push_back(g.mesh);
        triangleCount += description.meshes[g.mesh].triangles.size();
    }
    accel = std::make_unique<Accel>(description.meshes, meshOf, toScene);
}

void Scene::Impl::buildSurfaces(const LobeRules& rules) {
    surfaces = std::make_unique<SurfaceModel>(description.materials, rules);
    for (const Material& m : description.materials) hasAlpha.push_back(m.alphaMode != AlphaMode::Opaque);
    for (const Geometry& g : description.geometries) {
        const std::uint32_t material = description.meshes[g.mesh].material;
        kinds = kinds | surfaces->possibleKinds(material);
        anyAlpha = anyAlpha || hasAlpha[material];
    }
}

void Scene::Impl::buildEnvironment(const EnvironmentDescription& sky, const LogSink& log) {
    environment = std::make_unique<Environment>(sky);
    if (sky.mendedTexels > 0)
        logTo(
            log, LogLevel::Warning,
            std::to_string(sky.mendedTexels) + " texels of the environment were negative or not finite and count as 0");
    if (environment->black()) environment.reset();
}

namespace {

[[nodiscard]] std::string hashOf(const std::string& contents, const LobeRules& rules) {
    std::uint64_t key = 0;
    for (const char ch : contents) key = hashCombine(key, static_cast<unsigned char>(ch));
    key = hashCombine(key, std::bit_cast<std::uint32_t>(rules.castRoughness));
    key = hashCombine(key, std::bit_cast<std::uint32_t>(rules.glassCastRoughness));
    std::array<char, 17> text{};
    std::to_chars(text.data(), text.data() + 16, key, 16);
    return text.data();
}

}  // namespace

Scene::Scene(SceneDescription description, std::optional<EnvironmentDescription> environment,
             const SceneOptions& options, const Workers& workers, const LogSink& log)
    : impl_(std::make_unique<Impl>()) {
    (void)workers;
    Impl& s = *impl_;
    s.description = std::move(description);
    s.normalisation = normalise(s.description);
    s.scaleMaterials();
    s.placeGeometry();
    s.buildSurfaces(options.lobeRules);
    if (environment) s.buildEnvironment(*environment, log), s.environmentHash = environment->contentHash;
    s.findCoincidentFaces(log);
    s.buildLights();
    if (options.requireLight && (s.lights->count() == 0 || !(s.lights->totalPower() > 0.0)))
        throw Error(ErrorKind::BadInput, "the scene has no light", s.description.name,
                    "add an emissive material or a KHR_lights_punctual light, or give --env FILE.hdr or --env R,G,B");
    if (s.description.cameras.empty())
        s.description.cameras.push_back(framingCamera(s.normalisation, s.accel->bounds()));
    s.hash =
        hashOf(s.description.contentHash + (environment ? environment->contentHash : std::string()), options.lobeRules);
}

Scene::~Scene() = default;

std::optional<SurfaceHit> Scene::intersect(const Ray& ray, float coin) const noexcept {
    const Impl& s = *impl_;
    Ray current = ray;
    float travelled = 0.0F;
    RawHit raw;
    while (s.accel->intersect(current, raw)) {
        SurfaceHit hit{s.surfacePoint(raw), travelled + raw.t};
        if (s.isAlone(hit.point)) return hit;
        const FacesMet met = s.meet(hit.point);
        for (int i = 0; i < met.count; ++i) {
            const float coverage = s.surfaces->coverage(met.face[static_cast<std::size_t>(i)]);
            if (coin < coverage) return SurfaceHit{met.face[static_cast<std::size_t>(i)], hit.distance, coverage};
            coin = std::min((coin - coverage) / std::max(1.0F - coverage, 1e-12F), 0x1.fffffep-1F);
        }
        const glm::vec3 n = glm::dot(hit.point.geometricNormal, ray.direction) < 0.0F ? -hit.point.geometricNormal
                                                                                      : hit.point.geometricNormal;
        current.origin = offsetOrigin(hit.point.position, n);
        travelled += raw.t;
        current.tMax = ray.tMax - travelled;
    }
    return std::nullopt;
}

float Scene::visibility(const Ray& ray) const noexcept {
    const Impl& s = *impl_;
    if (!s.anyAlpha && s.coincident.none()) return s.accel->occluded(ray) ? 0.0F : 1.0F;
    Ray current = ray;
    float transmittance = 1.0F;
    RawHit raw;
    while (transmittance > 0.0F && s.accel->intersect(current, raw)) {
        const SurfacePoint p = s.surfacePoint(raw);
        if (s.isAlone(p)) return 0.0F;
        const FacesMet met = s.meet(p);
        for (int i = 0; i < met.count; ++i)
            transmittance *= 1.0F - s.surfaces->coverage(met.face[static_cast<std::size_t>(i)]);
        const glm::vec3 n = glm::dot(p.geometricNormal, ray.direction) < 0.0F ? -p.geometricNormal : p.geometricNormal;
        current.origin = offsetOrigin(p.position, n);
        current.tMax -= raw.t;
    }
    return transmittance;
}

bool Scene::hasHoles() const noexcept { return impl_->anyAlpha; }
std::array<glm::vec3, 3> Scene::corners(std::uint32_t geometry, std::uint32_t primitive) const noexcept {
    return impl_->corners(geometry, primitive);
}

const SurfaceModel& Scene::surfaces() const noexcept { return *impl_->surfaces; }
const Lights& Scene::lights() const noexcept { return *impl_->lights; }
const Environment* Scene::environment() const noexcept { return impl_->environment.get(); }
const SceneDescription& Scene::description() const noexcept { return impl_->description; }
const Bounds& Scene::bounds() const noexcept { return impl_->accel->bounds(); }
const Normalisation& Scene::normalisation() const noexcept { return impl_->normalisation; }
std::uint64_t Scene::triangles() const noexcept { return impl_->triangleCount; }
const std::string& Scene::hash() const noexcept { return impl_->hash; }
LobeKinds Scene::lobeKinds() const noexcept { return impl_->kinds; }

}  // namespace pellucid

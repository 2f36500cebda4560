#include <pellucid/scene/scene.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <tuple>

#include <pellucid/base/error.h>
#include <pellucid/math/hash.h>

namespace pellucid {

double Normalisation::scale() const noexcept { return std::ldexp(1.0, exponent); }

namespace {

/// How a geometry stands in the normalised scene.
struct Placement {
    glm::mat4 toScene{1.0F};
    glm::mat3 normalToScene{1.0F};
    bool mirrored = false;  ///< negative determinant: the winding turns over
    bool baked = false;     ///< the mesh's own vertices stand in the scene already
};

[[nodiscard]] Normalisation normalise(const SceneDescription& description) {
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper(-lower);
    for (const Geometry& g : description.geometries)
        for (const glm::vec3& p : description.meshes[g.mesh].positions) {
            const glm::dvec3 world(g.toWorld * glm::dvec4(glm::dvec3(p), 1.0));
            lower = glm::min(lower, world);
            upper = glm::max(upper, world);
        }
    Normalisation n;
    n.centre = 0.5 * (lower + upper);
    const double radius = 0.5 * glm::length(upper - lower);
    if (!(radius > 0.0) || !std::isfinite(radius))
        throw Error(ErrorKind::BadInput, "the scene has no extent that a number can hold", description.name,
                    "give it geometry of finite, non-zero size");
    n.exponent = -static_cast<int>(std::lround(std::log2(radius)));
    return n;
}

[[nodiscard]] glm::dmat4 normalisedTransform(const Normalisation& n, const glm::dmat4& toWorld) {
    glm::dmat4 m = toWorld;
    m[3] = glm::dvec4(glm::dvec3(m[3]) - n.centre, 1.0);
    const double s = n.scale();
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 3; ++r) m[c][r] *= s;
    return m;
}

[[nodiscard]] Placement place(const Normalisation& n, const Geometry& geometry) {
    const glm::dmat4 m = normalisedTransform(n, geometry.toWorld);
    Placement p;
    p.toScene = glm::mat4(m);
    const glm::dmat3 linear(m);
    const double determinant = glm::determinant(linear);
    p.mirrored = determinant < 0.0;
    // The cofactor matrix is the inverse transpose up to its scale and exists for singular transforms too.
    const glm::dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                              glm::cross(linear[0], linear[1]));
    const double size =
        std::max({glm::length(cofactor[0]), glm::length(cofactor[1]), glm::length(cofactor[2]), 1e-300});
    p.normalToScene = glm::mat3(cofactor * ((determinant < 0.0 ? -1.0 : 1.0) / size));
    return p;
}

/// A mesh that stands in one place only is moved there once and for all.
void bake(Placement& placement, Mesh& mesh) {
    for (glm::vec3& p : mesh.positions) p = glm::vec3(placement.toScene * glm::vec4(p, 1.0F));
    for (glm::vec3& n : mesh.normals) n = placement.normalToScene * n;
    for (glm::vec4& t : mesh.tangents) t = glm::vec4(glm::mat3(placement.toScene) * glm::vec3(t), t.w);
    placement.toScene = glm::mat4(1.0F);
    placement.normalToScene = glm::mat3(1.0F);
    placement.baked = true;
}

/// A camera that frames the whole scene from the front, a little from the right and above.
[[nodiscard]] CameraSpec framingCamera(const Normalisation& n, const Bounds& bounds) {
    const glm::dvec3 toViewer = glm::normalize(glm::dvec3(0.45, 0.35, 1.0));
    CameraSpec spec;
    spec.name = "framing";
    spec.verticalFov = 0.7;
    const double distance = 1.05 * static_cast<double>(bounds.radius()) / std::sin(0.5 * spec.verticalFov);
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), toViewer));
    const glm::dvec3 up = glm::cross(toViewer, right);
    const glm::dvec3 position = (glm::dvec3(bounds.centre()) + distance * toViewer) / n.scale() + n.centre;
    spec.toWorld =
        glm::dmat4(glm::dvec4(right, 0), glm::dvec4(up, 0), glm::dvec4(toViewer, 0), glm::dvec4(position, 1));
    return spec;
}

}  // namespace

struct Scene::Impl {
    SceneDescription description;
    SceneOptions options;
    Normalisation normalisation;
    std::vector<Placement> placements;
    std::unique_ptr<Accel> accel;
    std::unique_ptr<SurfaceModel> surfaces;
    std::unique_ptr<Environment> environment;
    std::unique_ptr<Lights> lights;
    std::vector<bool> hasAlpha;  ///< by material
    bool anyAlpha = false;
    /// By geometry and primitive: one of two faces of the same glass that coincide. Rays pass: there is no interface.
    std::vector<std::vector<bool>> merged;
    bool anyMerged = false;
    std::uint64_t triangleCount = 0;
    LobeKinds kinds = kNoLobe;
    std::string hash;

    [[nodiscard]] SurfacePoint surfacePoint(const RawHit& hit) const noexcept;
    [[nodiscard]] std::array<glm::vec3, 3> corners(std::uint32_t geometry, std::uint32_t primitive) const noexcept;
    void addPunctual(Lights::Parts& parts) const;
    void addEmissive(Lights::Parts& parts) const;
    void buildLights();
    void scaleMaterials();
    void mergeCoincidentGlass();
    [[nodiscard]] bool isMerged(const SurfacePoint& p) const noexcept {
        return anyMerged && !merged[p.geometry].empty() && merged[p.geometry][p.primitive];
    }
};

std::array<glm::vec3, 3> Scene::Impl::corners(std::uint32_t geometry, std::uint32_t primitive) const noexcept {
    const Mesh& mesh = description.meshes[description.geometries[geometry].mesh];
    const glm::uvec3 t = mesh.triangles[primitive];
    if (placements[geometry].baked) return {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
    const glm::mat4& m = placements[geometry].toScene;
    return {glm::vec3(m * glm::vec4(mesh.positions[t.x], 1.0F)), glm::vec3(m * glm::vec4(mesh.positions[t.y], 1.0F)),
            glm::vec3(m * glm::vec4(mesh.positions[t.z], 1.0F))};
}

/// Recomputes the hit from its barycentrics in double, so that its error does not grow with the ray's length.
SurfacePoint Scene::Impl::surfacePoint(const RawHit& hit) const noexcept {
    const Mesh& mesh = description.meshes[description.geometries[hit.geometry].mesh];
    const Placement& placement = placements[hit.geometry];
    const glm::uvec3 t = mesh.triangles[hit.primitive];
    const auto [a, b, c] = corners(hit.geometry, hit.primitive);
    const double u = static_cast<double>(hit.u), v = static_cast<double>(hit.v), w = 1.0 - u - v;
    const float uf = hit.u, vf = hit.v, wf = static_cast<float>(w);
    SurfacePoint p;
    p.geometry = hit.geometry;
    p.primitive = hit.primitive;
    p.material = mesh.material;
    p.barycentric = {uf, vf};
    p.position = glm::vec3(glm::dvec3(a) * w + glm::dvec3(b) * u + glm::dvec3(c) * v);
    const glm::dvec3 cross = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
    const double length = glm::length(cross);
    p.geometricNormal = length > 0.0 ? glm::vec3(cross * (1.0 / length)) : glm::vec3(0.0F, 0.0F, 1.0F);
    if (placement.mirrored) p.geometricNormal = -p.geometricNormal;
    p.shadingNormal = p.geometricNormal;
    if (!mesh.normals.empty()) {
        glm::vec3 n = mesh.normals[t.x] * wf + mesh.normals[t.y] * uf + mesh.normals[t.z] * vf;
        if (!placement.baked) n = placement.normalToScene * n;
        const float size = glm::length(n);
        if (size > 1e-12F && std::isfinite(size)) p.shadingNormal = n * (1.0F / size);
        const float side = glm::dot(p.shadingNormal, p.geometricNormal);
        if (side <= 0.0F) p.shadingNormal = p.geometricNormal;  // turned or grazing: not a normal of this face
    }
    p.tangent = glm::vec3(0.0F);
    if (!mesh.tangents.empty() && description.materials[mesh.material].normalTexture) {
        const glm::vec4 tangent = mesh.tangents[t.x] * wf + mesh.tangents[t.y] * uf + mesh.tangents[t.z] * vf;
        const glm::vec3 world = glm::mat3(placement.toScene) * glm::vec3(tangent);
        const float size = glm::length(world);
        if (size > 0.0F && std::isfinite(size)) p.tangent = world / size;
        p.tangentSign = (tangent.w < 0.0F) != placement.mirrored ? -1.0F : 1.0F;
    }
    if (!mesh.uv0.empty()) p.uv[0] = mesh.uv0[t.x] * wf + mesh.uv0[t.y] * uf + mesh.uv0[t.z] * vf;
    if (!mesh.uv1.empty()) p.uv[1] = mesh.uv1[t.x] * wf + mesh.uv1[t.y] * uf + mesh.uv1[t.z] * vf;
    if (!mesh.colors.empty()) p.color = mesh.colors[t.x] * wf + mesh.colors[t.y] * uf + mesh.colors[t.z] * vf;
    if (mesh.tangents.empty() && !mesh.uv0.empty() && description.materials[mesh.material].normalTexture) {
        const auto& uvs =
            description.materials[mesh.material].normalTexture.uvSet == 1 && !mesh.uv1.empty() ? mesh.uv1 : mesh.uv0;
        const glm::vec2 d1 = uvs[t.y] - uvs[t.x], d2 = uvs[t.z] - uvs[t.x];
        const float det = d1.x * d2.y - d1.y * d2.x;
        glm::vec3 tangent = ((b - a) * d2.y - (c - a) * d1.y) * (det < 0.0F ? -1.0F : 1.0F);
        tangent -= p.shadingNormal * glm::dot(p.shadingNormal, tangent);
        const float size = glm::length(tangent);
        if (det != 0.0F && size > 0.0F) {
            p.tangent = tangent / size;
            // glTF's v grows downwards in the image: its bitangent is that of flipped v.
            p.tangentSign = (det < 0.0F) != placement.mirrored ? 1.0F : -1.0F;
        }
    }
    return p;
}

void Scene::Impl::addPunctual(Lights::Parts& parts) const {
    const double s = normalisation.scale();
    const auto area = static_cast<float>(s * s);
    for (const PunctualLight& light : description.lights) {
        const glm::vec3 position((light.position - normalisation.centre) * s);
        const glm::vec3 direction(light.direction);
        switch (light.kind) {
            case PunctualKind::Point:
                parts.points.push_back({position, light.intensity * area});
                break;
            case PunctualKind::Spot:
                parts.spots.push_back({position, direction, light.intensity * area,
                                       static_cast<float>(std::cos(light.innerCone)),
                                       static_cast<float>(std::cos(light.outerCone))});
                break;
            case PunctualKind::Directional:
                parts.directionals.push_back({direction, light.intensity});
                break;
        }
    }
}

void Scene::Impl::addEmissive(Lights::Parts& parts) const {
    for (std::uint32_t g = 0; g < description.geometries.size(); ++g) {
        const Mesh& mesh = description.meshes[description.geometries[g].mesh];
        const Material& material = description.materials[mesh.material];
        if (maxComponent(material.emission) <= 0.0F) continue;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            EmissiveTriangle e;
            const auto c = corners(g, i);
            for (int k = 0; k < 3; ++k) e.corner[k] = c[static_cast<std::size_t>(k)];
            const glm::vec3 cross = glm::cross(c[1] - c[0], c[2] - c[0]);
            const float length = glm::length(cross);
            if (!(length > 0.0F)) continue;
            e.area = 0.5F * length;
            e.normal = cross / (placements[g].mirrored ? -length : length);
            e.twoSided = material.doubleSided;
            e.geometry = g;
            e.primitive = i;
            e.meanRadiance = material.emission;
            if (material.emissiveTexture) {
                constexpr int kSteps = 8;
                Rgb sum(0.0F);
                int samples = 0;
                for (int y = 0; y < kSteps; ++y)
                    for (int x = 0; x + y < kSteps; ++x, ++samples)
                        sum += surfaces->emittedRadiance(surfacePoint({g, i, (static_cast<float>(x) + 0.33F) / kSteps,
                                                                       (static_cast<float>(y) + 0.33F) / kSteps, 0.0F}),
                                                         e.normal);
                // Never zero: between the samples the texture may still shine.
                e.meanRadiance = glm::max(sum / static_cast<float>(samples), material.emission * 1e-3F);
            }
            parts.triangles.push_back(e);
        }
    }
}

void Scene::Impl::buildLights() {
    Lights::Parts parts;
    addPunctual(parts);
    addEmissive(parts);
    parts.environment = environment.get();
    parts.sceneCentre = accel->bounds().centre();
    parts.sceneRadius = accel->bounds().radius() * 1.0001F;
    parts.geometries = static_cast<std::uint32_t>(description.geometries.size());
    lights = std::make_unique<Lights>(
        std::move(parts),
        [](const void* scene, std::uint32_t geometry, std::uint32_t primitive, const glm::vec2& barycentric,
           const glm::vec3& wo) {
            const auto* self = static_cast<const Impl*>(scene);
            const SurfacePoint point = self->surfacePoint({geometry, primitive, barycentric.x, barycentric.y, 0.0F});
            // A path that comes this way by itself meets a lamp of alpha only in this share of its tries.
            const float coverage = self->hasAlpha[point.material] ? self->surfaces->coverage(point) : 1.0F;
            return self->surfaces->emittedRadiance(point, wo) * coverage;
        },
        this);
}

namespace {

/// Whether light crosses from one body to the other as within one.
[[nodiscard]] bool sameGlass(const Material& a, const Material& b) noexcept {
    return a.ior == b.ior && a.absorption == b.absorption && a.transmission >= 1.0F && b.transmission >= 1.0F;
}

}  // namespace

/// Finds pairs of triangles of volume glass with the same three corners that face each other.
void Scene::Impl::mergeCoincidentGlass() {
    using Key = std::array<float, 9>;
    std::map<Key, std::pair<std::uint32_t, std::uint32_t>> open;
    merged.resize(description.geometries.size());
    for (std::uint32_t g = 0; g < description.geometries.size(); ++g) {
        const Mesh& mesh = description.meshes[description.geometries[g].mesh];
        const Material& material = description.materials[mesh.material];
        if (!(material.transmission > 0.0F && material.thickness > 0.0F)) continue;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            auto c = corners(g, i);
            std::sort(c.begin(), c.end(), [](const glm::vec3& a, const glm::vec3& b) {
                return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
            });
            const Key key{c[0].x, c[0].y, c[0].z, c[1].x, c[1].y, c[1].z, c[2].x, c[2].y, c[2].z};
            const auto [it, fresh] = open.try_emplace(key, g, i);
            if (fresh) continue;
            const auto [g2, i2] = it->second;
            const Material& other = description.materials[description.meshes[description.geometries[g2].mesh].material];
            const glm::vec3 n = surfacePoint({g, i, 0.3F, 0.3F, 0.0F}).geometricNormal,
                            n2 = surfacePoint({g2, i2, 0.3F, 0.3F, 0.0F}).geometricNormal;
            if (glm::dot(n, n2) >= 0.0F || !sameGlass(material, other)) continue;
            for (const auto& [geometry, primitive] : {std::pair(g, i), std::pair(g2, i2)}) {
                auto& flags = merged[geometry];
                flags.resize(description.meshes[description.geometries[geometry].mesh].triangles.size(), false);
                flags[primitive] = true;
            }
            anyMerged = true;
            open.erase(it);
        }
    }
}

/// Beer's coefficients are per metre in the file and per normalised unit from here on.
void Scene::Impl::scaleMaterials() {
    for (Material& m : description.materials) m.absorption *= static_cast<float>(1.0 / normalisation.scale());
}

Scene::Scene(SceneDescription description, std::optional<EnvironmentDescription> environment,
             const SceneOptions& options, const Workers& workers, const LogSink& log)
    : impl_(std::make_unique<Impl>()) {
    (void)workers;
    Impl& s = *impl_;
    s.description = std::move(description);
    s.options = options;
    s.normalisation = normalise(s.description);
    s.scaleMaterials();
    std::vector<glm::mat4> toScene;
    std::vector<std::uint32_t> meshOf;
    std::vector<int> uses(s.description.meshes.size(), 0);
    for (const Geometry& g : s.description.geometries) ++uses[g.mesh];
    for (const Geometry& g : s.description.geometries) {
        s.placements.push_back(place(s.normalisation, g));
        if (uses[g.mesh] == 1) bake(s.placements.back(), s.description.meshes[g.mesh]);
        toScene.push_back(s.placements.back().toScene);
        meshOf.push_back(g.mesh);
        s.triangleCount += s.description.meshes[g.mesh].triangles.size();
    }
    s.accel = std::make_unique<Accel>(s.description.meshes, meshOf, toScene);
    s.surfaces = std::make_unique<SurfaceModel>(s.description.materials, options.lobeRules);
    for (const Material& m : s.description.materials) s.hasAlpha.push_back(m.alphaMode != AlphaMode::Opaque);
    for (const Geometry& g : s.description.geometries) {
        const std::uint32_t material = s.description.meshes[g.mesh].material;
        s.kinds = s.kinds | s.surfaces->possibleKinds(material);
        s.anyAlpha = s.anyAlpha || s.hasAlpha[material];
    }
    if (environment) {
        s.environment = std::make_unique<Environment>(*environment);
        if (environment->mendedTexels > 0)
            logTo(log, LogLevel::Warning,
                  std::to_string(environment->mendedTexels) +
                      " texels of the environment were negative or not finite and count as 0");
        if (s.environment->black()) s.environment.reset();
    }
    s.mergeCoincidentGlass();
    s.buildLights();
    if (options.requireLight && (s.lights->count() == 0 || !(s.lights->totalPower() > 0.0)))
        throw Error(ErrorKind::BadInput, "the scene has no light", s.description.name,
                    "add an emissive material or a KHR_lights_punctual light, or give --env FILE.hdr or --env R,G,B");
    if (s.description.cameras.empty())
        s.description.cameras.push_back(framingCamera(s.normalisation, s.accel->bounds()));
    std::uint64_t key = 0;
    for (const char ch : s.description.contentHash + (environment ? environment->contentHash : std::string()))
        key = hashCombine(key, static_cast<unsigned char>(ch));
    key = hashCombine(key, std::bit_cast<std::uint32_t>(options.lobeRules.castRoughness));
    std::array<char, 17> text{};
    std::to_chars(text.data(), text.data() + 16, key, 16);
    s.hash = text.data();
}

Scene::~Scene() = default;

std::optional<SurfaceHit> Scene::intersect(const Ray& ray, float coin) const noexcept {
    const Impl& s = *impl_;
    Ray current = ray;
    float travelled = 0.0F;
    RawHit raw;
    while (s.accel->intersect(current, raw)) {
        SurfaceHit hit{s.surfacePoint(raw), travelled + raw.t};
        const bool passes = s.isMerged(hit.point);
        if (!passes && !s.hasAlpha[hit.point.material]) return hit;
        const float coverage = passes ? 0.0F : s.surfaces->coverage(hit.point);
        if (coin < coverage) return hit;
        coin = std::min((coin - coverage) / std::max(1.0F - coverage, 1e-12F), 0x1.fffffep-1F);
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
    if (!s.anyAlpha && !s.anyMerged) return s.accel->occluded(ray) ? 0.0F : 1.0F;
    Ray current = ray;
    float transmittance = 1.0F;
    RawHit raw;
    while (transmittance > 0.0F && s.accel->intersect(current, raw)) {
        const SurfacePoint p = s.surfacePoint(raw);
        const bool passes = s.isMerged(p);
        if (!passes && !s.hasAlpha[p.material]) return 0.0F;
        if (!passes) transmittance *= 1.0F - s.surfaces->coverage(p);
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

namespace {

[[nodiscard]] const CameraSpec& findCamera(const std::vector<CameraSpec>& cameras, const std::string& nameOrIndex) {
    if (nameOrIndex.empty()) return cameras.front();
    for (const CameraSpec& c : cameras)
        if (c.name == nameOrIndex) return c;
    std::size_t index = cameras.size();
    const auto [end, status] = std::from_chars(nameOrIndex.data(), nameOrIndex.data() + nameOrIndex.size(), index);
    if (status == std::errc() && end == nameOrIndex.data() + nameOrIndex.size() && index < cameras.size())
        return cameras[index];
    std::string known;
    for (std::size_t i = 0; i < cameras.size(); ++i)
        known += (i > 0 ? ", " : "") + std::to_string(i) + " '" + cameras[i].name + "'";
    throw Error(ErrorKind::Usage, "there is no camera '" + nameOrIndex + "'", "--camera", "choose one of " + known);
}

}  // namespace

Camera Scene::camera(const std::string& nameOrIndex, int width, int height, double aperture, double focus) const {
    CameraSpec spec = findCamera(impl_->description.cameras, nameOrIndex);
    constexpr int kDefaultWidth = 512;
    double aspect = spec.aspect > 0.0 ? spec.aspect : 1.0;
    if (spec.orthographic && spec.xmag > 0.0 && spec.ymag > 0.0) aspect = spec.xmag / spec.ymag;
    if (width <= 0 && height <= 0) width = kDefaultWidth;
    if (width <= 0) width = std::max(1, static_cast<int>(std::lround(height * aspect)));
    if (height <= 0) height = std::max(1, static_cast<int>(std::lround(width / aspect)));
    const double scale = impl_->normalisation.scale();
    spec.toWorld = normalisedTransform(impl_->normalisation, spec.toWorld);
    spec.xmag *= scale;
    spec.ymag *= scale;
    return Camera(spec, width, height, aperture * scale, focus * scale);
}

}  // namespace pellucid

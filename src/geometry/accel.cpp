#include <pellucid/geometry/accel.h>

#include <cmath>
#include <new>
#include <stdexcept>

#include <embree3/rtcore.h>

#include <pellucid/base/error.h>
#include <pellucid/base/fp_traps.h>

namespace pellucid {

namespace {

/// Beyond this many triangles with every placement counted, meshes become Embree instances instead of copies.
constexpr std::uint64_t kFlattenLimit = 8'000'000;
/// Embree's own bound on coordinates (its Debian build aborts beyond it).
constexpr float kMaxCoordinate = 1.8e18F;

[[nodiscard]] bool usable(const Ray& ray) noexcept {
    const glm::vec3& o = ray.origin;
    const glm::vec3& d = ray.direction;
    const bool finite = std::fabs(o.x) < kMaxCoordinate && std::fabs(o.y) < kMaxCoordinate &&
                        std::fabs(o.z) < kMaxCoordinate && std::isfinite(d.x) && std::isfinite(d.y) &&
                        std::isfinite(d.z);
    return finite && ray.tMax > 0.0F && (d.x != 0.0F || d.y != 0.0F || d.z != 0.0F);
}

[[nodiscard]] RTCGeometry makeTriangles(RTCDevice device, const Mesh& mesh, const glm::mat4& transform) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), mesh.positions.size()));
    auto* indices = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), mesh.triangles.size()));
    if (vertices == nullptr || indices == nullptr) throw std::bad_alloc();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        vertices[i] = glm::vec3(transform * glm::vec4(mesh.positions[i], 1.0F));
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), indices);
    rtcCommitGeometry(geometry);
    return geometry;
}

/// At time 0, for all masks.
[[nodiscard]] RTCRay embreeRay(const Ray& ray) noexcept {
    return {ray.origin.x,
            ray.origin.y,
            ray.origin.z,
            0.0F,
            ray.direction.x,
            ray.direction.y,
            ray.direction.z,
            0.0F,
            ray.tMax,
            0xffffffffU,
            0,
            0};
}

}  // namespace

struct Accel::Impl {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<RTCScene> meshScenes;
    bool instanced = false;
    Bounds bounds;

    ~Impl() {
        for (RTCScene s : meshScenes)
            if (s != nullptr) rtcReleaseScene(s);
        if (scene != nullptr) rtcReleaseScene(scene);
        if (device != nullptr) rtcReleaseDevice(device);
    }

    [[nodiscard]] RTCScene newScene() const {
        RTCScene s = rtcNewScene(device);
        rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(s, RTC_BUILD_QUALITY_MEDIUM);
        return s;
    }

    void attach(RTCScene target, RTCGeometry geometry, unsigned id) const {
        rtcAttachGeometryByID(target, geometry, id);
        rtcReleaseGeometry(geometry);
    }

    void addInstances(std::span<const Mesh> meshes, std::span<const std::uint32_t> meshOfGeometry,
                      std::span<const glm::mat4> toScene) {
        meshScenes.assign(meshes.size(), nullptr);
        for (std::size_t g = 0; g < meshOfGeometry.size(); ++g) {
            RTCScene& meshScene = meshScenes[meshOfGeometry[g]];
            if (meshScene == nullptr) {
                meshScene = newScene();
                attach(meshScene, makeTriangles(device, meshes[meshOfGeometry[g]], glm::mat4(1.0F)), 0);
                rtcCommitScene(meshScene);
            }
            RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
            rtcSetGeometryInstancedScene(instance, meshScene);
            rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &toScene[g][0][0]);
            rtcCommitGeometry(instance);
            attach(scene, instance, static_cast<unsigned>(g));
        }
    }
};

Accel::Accel(std::span<const Mesh> meshes, std::span<const std::uint32_t> meshOfGeometry,
             std::span<const glm::mat4> toScene)
    : impl_(std::make_unique<Impl>()) {
    impl_->device = rtcNewDevice("set_affinity=0");
    if (impl_->device == nullptr)
        throw Error(ErrorKind::CannotFinish, "Embree could not be started", "acceleration structure",
                    "check that libembree3 suits this machine and that memory is left");
    impl_->scene = impl_->newScene();
    std::uint64_t triangles = 0;
    for (const std::uint32_t m : meshOfGeometry) triangles += meshes[m].triangles.size();
    impl_->instanced = triangles > kFlattenLimit && meshOfGeometry.size() > meshes.size();
    if (impl_->instanced) {
        impl_->addInstances(meshes, meshOfGeometry, toScene);
    } else {
        for (std::size_t g = 0; g < meshOfGeometry.size(); ++g)
            impl_->attach(impl_->scene, makeTriangles(impl_->device, meshes[meshOfGeometry[g]], toScene[g]),
                          static_cast<unsigned>(g));
    }
    rtcCommitScene(impl_->scene);
    const RTCError error = rtcGetDeviceError(impl_->device);
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (error != RTC_ERROR_NONE)
        throw Error(ErrorKind::CannotFinish,
                    "the acceleration structure could not be built (Embree error " + std::to_string(error) + ")",
                    "scene geometry", "check the scene's coordinates and memory");
    RTCBounds b{};
    rtcGetSceneBounds(impl_->scene, &b);
    impl_->bounds.lower = {b.lower_x, b.lower_y, b.lower_z};
    impl_->bounds.upper = {b.upper_x, b.upper_y, b.upper_z};
}

Accel::~Accel() = default;

bool Accel::intersect(const Ray& ray, RawHit& hit) const noexcept {
    if (!usable(ray)) return false;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit rh;
    rh.ray = embreeRay(ray);
    rh.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rh.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    {
        const TrapsMasked masked;  // Embree computes with infinities and NaN on purpose
        rtcIntersect1(impl_->scene, &context, &rh);
    }
    if (rh.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit.geometry = impl_->instanced ? rh.hit.instID[0] : rh.hit.geomID;
    hit.primitive = rh.hit.primID;
    hit.u = rh.hit.u;
    hit.v = rh.hit.v;
    hit.t = rh.ray.tfar;
    return true;
}

bool Accel::occluded(const Ray& ray) const noexcept {
    if (!usable(ray)) return false;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay r = embreeRay(ray);
    {
        const TrapsMasked masked;
        rtcOccluded1(impl_->scene, &context, &r);
    }
    return r.tfar < 0.0F;
}

const Bounds& Accel::bounds() const noexcept { return impl_->bounds; }

}  // namespace pellucid

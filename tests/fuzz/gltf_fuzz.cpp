/// libFuzzer target: any bytes give a scene that keeps what description.h promises, or an Error.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include <pellucid/base/error.h>
#include <pellucid/io/gltf.h>

namespace {

void require(bool condition) {
    if (!condition) std::abort();
}

void checkMesh(const pellucid::Mesh& mesh, std::size_t materials) {
    const std::size_t count = mesh.positions.size();
    require(!mesh.triangles.empty() && mesh.material < materials);
    for (const std::size_t size :
         {mesh.normals.size(), mesh.tangents.size(), mesh.uv0.size(), mesh.uv1.size(), mesh.colors.size()})
        require(size == 0 || size == count);
    for (const glm::uvec3& t : mesh.triangles) require(t.x < count && t.y < count && t.z < count);
    for (const glm::vec3& p : mesh.positions) require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const pellucid::SceneDescription scene =
            pellucid::loadGltfFromMemory(std::as_bytes(std::span(data, size)), "fuzz");
        require(!scene.meshes.empty() && !scene.geometries.empty() && !scene.materials.empty());
        for (const pellucid::Mesh& mesh : scene.meshes) checkMesh(mesh, scene.materials.size());
        for (const pellucid::Geometry& geometry : scene.geometries) require(geometry.mesh < scene.meshes.size());
    } catch (const pellucid::Error&) {
    }
    return 0;
}

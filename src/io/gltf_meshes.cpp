#include "gltf_meshes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <tiny_gltf.h>

#include "gltf_accessors.h"

namespace pellucid {
namespace {

constexpr std::size_t kMaxVertices = std::size_t{1} << 28;
constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

/// Few triangles in a large vertex buffer: the work must grow with the triangles only.
[[nodiscard]] std::vector<std::uint32_t> keepFew(std::vector<glm::uvec3>& triangles) {
    std::vector<std::uint32_t> used;
    used.reserve(3 * triangles.size());
    for (const glm::uvec3& triangle : triangles)
        for (int k = 0; k < 3; ++k) used.push_back(triangle[k]);
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (glm::uvec3& triangle : triangles)
        for (int k = 0; k < 3; ++k)
            triangle[k] =
                static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), triangle[k]) - used.begin());
    return used;
}

/// Numbers the used vertices anew, in their order: exporters share one vertex buffer among many primitives.
[[nodiscard]] std::vector<std::uint32_t> keepUsed(std::vector<glm::uvec3>& triangles, std::size_t vertices) {
    if (triangles.size() < vertices / 64) return keepFew(triangles);
    std::vector<std::uint32_t> newNumber(vertices, kUnused), used;
    for (const glm::uvec3& triangle : triangles)
        for (int k = 0; k < 3; ++k) newNumber[triangle[k]] = 0;
    for (std::size_t i = 0; i < vertices; ++i) {
        if (newNumber[i] == kUnused) continue;
        newNumber[i] = static_cast<std::uint32_t>(used.size());
        used.push_back(static_cast<std::uint32_t>(i));
    }
    for (glm::uvec3& triangle : triangles)
        for (int k = 0; k < 3; ++k) triangle[k] = newNumber[triangle[k]];
    return used;
}

/// Fills `target` with convert(element) of the named attribute, if the primitive has it.
template <class T, class Convert>
void readAttribute(const GltfAsset& asset, const tinygltf::Primitive& primitive, const char* name,
                   const std::vector<std::uint32_t>& used, std::vector<T>& target, Convert convert) {
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) return;
    const AccessorReader reader(asset, found->second);
    target.reserve(used.size());
    for (const std::uint32_t i : used) target.push_back(convert(reader.vector(i), reader.components()));
}

void readAttributes(const GltfAsset& asset, const tinygltf::Primitive& primitive,
                    const std::vector<std::uint32_t>& used, Mesh& mesh) {
    const auto three = [](const glm::vec4& v, std::size_t) { return glm::vec3(v); };
    const auto two = [](const glm::vec4& v, std::size_t) { return glm::vec2(v); };
    const auto four = [](const glm::vec4& v, std::size_t) { return v; };
    const auto colour = [](glm::vec4 v, std::size_t components) {
        if (components == 3) v.a = 1.0F;
        return v;
    };
    readAttribute(asset, primitive, "POSITION", used, mesh.positions, three);
    readAttribute(asset, primitive, "NORMAL", used, mesh.normals, three);
    if (!mesh.normals.empty()) readAttribute(asset, primitive, "TANGENT", used, mesh.tangents, four);
    readAttribute(asset, primitive, "TEXCOORD_0", used, mesh.uv0, two);
    readAttribute(asset, primitive, "TEXCOORD_1", used, mesh.uv1, two);
    readAttribute(asset, primitive, "COLOR_0", used, mesh.colors, colour);
}

void checkPositions(const GltfAsset& asset, const PrimitiveId& id, const Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3& p = mesh.positions[i];
        if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
        asset.bad(id.path() + ".attributes.POSITION", "a position is not finite",
                  "repair the mesh and export it again");
    }
}

/// A unit vector, or zero where there is no direction.
[[nodiscard]] glm::vec3 unitOrZero(const glm::vec3& v) noexcept {
    const float largest = std::max(std::fabs(v.x), std::max(std::fabs(v.y), std::fabs(v.z)));
    if (!(largest > 1e-20F) || !std::isfinite(v.x + v.y + v.z)) return glm::vec3(0.0F);
    return glm::normalize(v / largest);
}

void mendNormals(const GltfAsset& asset, const PrimitiveId& id, Mesh& mesh) {
    std::size_t bad = 0;
    for (glm::vec3& n : mesh.normals) {
        n = unitOrZero(n);
        if (n == glm::vec3(0.0F)) ++bad;
    }
    if (bad > 0)
        asset.notes().warn(id.path() + ": " + std::to_string(bad) + " of " + std::to_string(mesh.normals.size()) +
                           " normals have no direction; the triangles' own are used there");
    if (bad == mesh.normals.size()) mesh.normals.clear();
    if (mesh.normals.empty()) mesh.tangents.clear();
}

void mendTangents(Mesh& mesh) {
    bool any = false;
    for (glm::vec4& t : mesh.tangents) {
        const glm::vec3 direction = unitOrZero(t);
        t = glm::vec4(direction, t.w < 0.0F ? -1.0F : 1.0F);
        any = any || direction != glm::vec3(0.0F);
    }
    if (!any) mesh.tangents.clear();
}

void mendUvAndColours(const GltfAsset& asset, const PrimitiveId& id, Mesh& mesh) {
    bool bad = false;
    for (std::vector<glm::vec2>* set : {&mesh.uv0, &mesh.uv1})
        for (glm::vec2& uv : *set) {
            if (std::isfinite(uv.x) && std::isfinite(uv.y)) continue;
            uv = glm::vec2(0.0F);
            bad = true;
        }
    for (glm::vec4& colour : mesh.colors) {
        for (int k = 0; k < 4; ++k) {
            bad = bad || std::isnan(colour[k]);
            colour[k] = std::isnan(colour[k]) ? 1.0F : std::clamp(colour[k], 0.0F, 1.0F);
        }
    }
    if (bad) asset.notes().warn(id.path() + ": texture coordinates or colours that are not finite are replaced");
}

[[nodiscard]] std::string meshName(const tinygltf::Mesh& mesh, const PrimitiveId& id) {
    const std::string base = mesh.name.empty() ? "mesh " + std::to_string(id.mesh) : mesh.name;
    return mesh.primitives.size() > 1 ? base + " (" + std::to_string(id.primitive) + ")" : base;
}

}  // namespace

void turnRound(Mesh& mesh) {
    for (glm::uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
    for (glm::vec4& tangent : mesh.tangents) tangent.w = -tangent.w;
}

std::optional<Mesh> buildMesh(const GltfAsset& asset, const PrimitiveId& id, const Deformation& deformation,
                              std::size_t& dropped) {
    const tinygltf::Mesh& source = asset.model().meshes[static_cast<std::size_t>(id.mesh)];
    const tinygltf::Primitive& primitive = source.primitives[id.primitive];
    Mesh mesh;
    mesh.triangles = readTriangles(asset, id, dropped);
    if (mesh.triangles.empty()) return std::nullopt;
    const auto positions = static_cast<std::size_t>(primitive.attributes.at("POSITION"));
    const std::size_t vertices = asset.model().accessors[positions].count;
    if (vertices > kMaxVertices)
        asset.bad(id.path() + ".attributes.POSITION", std::to_string(vertices) + " vertices are more than 2^28",
                  "split the mesh");
    const std::vector<std::uint32_t> used = keepUsed(mesh.triangles, vertices);

    mesh.name = meshName(source, id);
    mesh.material = primitive.material >= 0 ? static_cast<std::uint32_t>(primitive.material)
                                            : static_cast<std::uint32_t>(asset.model().materials.size());
    readAttributes(asset, primitive, used, mesh);
    applyMorphTargets(asset, primitive, deformation.weights, used, mesh);
    checkPositions(asset, id, mesh);
    if (!deformation.joints.empty()) {
        applySkin(asset, id, deformation.joints, used, mesh);
        checkPositions(asset, id, mesh);
    }
    mendNormals(asset, id, mesh);
    mendTangents(mesh);
    mendUvAndColours(asset, id, mesh);
    return mesh;
}

}  // namespace pellucid

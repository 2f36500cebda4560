#include "gltf_nodes.h"

#include <cmath>
#include <optional>

#include <tiny_gltf.h>

#include "gltf_accessors.h"

namespace pellucid {
namespace {

[[nodiscard]] glm::dmat4 fromTrs(const glm::dvec3& t, const glm::dvec4& q, const glm::dvec3& s) noexcept {
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    const glm::dvec3 a(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w));
    const glm::dvec3 b(2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w));
    const glm::dvec3 c(2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y));
    return {glm::dvec4(s.x * a, 0.0), glm::dvec4(s.y * b, 0.0), glm::dvec4(s.z * c, 0.0), glm::dvec4(t, 1.0)};
}

/// Unit quaternion; what has no direction is no rotation.
[[nodiscard]] glm::dvec4 unitQuaternion(const glm::dvec4& q, const GltfAsset& asset) {
    const glm::dvec4 identity(0.0, 0.0, 0.0, 1.0);
    const double length = std::hypot(std::hypot(q.x, q.y), std::hypot(q.z, q.w));
    if (std::fabs(length - 1.0) > 1e-2)
        asset.notes().warn("some rotations are no unit quaternions: they are normalised");
    return length > 0.0 && std::isfinite(length) ? q / length : identity;
}

[[nodiscard]] glm::dvec3 vectorOr(const std::vector<double>& values, double fallback) {
    return values.size() == 3 ? glm::dvec3(values[0], values[1], values[2]) : glm::dvec3(fallback);
}

[[nodiscard]] glm::dmat4 localTransform(const GltfAsset& asset, std::size_t index) {
    const tinygltf::Node& node = asset.model().nodes[index];
    if (node.matrix.size() == 16) {
        glm::dmat4 m(1.0);
        for (glm::length_t c = 0; c < 4; ++c)
            for (glm::length_t r = 0; r < 4; ++r) m[c][r] = node.matrix[static_cast<std::size_t>(4 * c + r)];
        const double bottom = std::fabs(m[0][3]) + std::fabs(m[1][3]) + std::fabs(m[2][3]) + std::fabs(m[3][3] - 1.0);
        if (bottom > 1e-6)
            asset.bad(element("nodes", index) + ".matrix", "the matrix is not affine", "its last row must be 0 0 0 1");
        for (glm::length_t c = 0; c < 4; ++c) m[c][3] = c == 3 ? 1.0 : 0.0;
        return m;
    }
    glm::dvec4 rotation(0.0, 0.0, 0.0, 1.0);
    if (const auto& q = node.rotation; q.size() == 4) rotation = unitQuaternion({q[0], q[1], q[2], q[3]}, asset);
    return fromTrs(vectorOr(node.translation, 0.0), rotation, vectorOr(node.scale, 1.0));
}

[[nodiscard]] std::vector<int> rootNodes(const tinygltf::Model& model) {
    std::vector<char> hasParent(model.nodes.size(), 0);
    for (const tinygltf::Node& node : model.nodes)
        for (const int child : node.children) hasParent[static_cast<std::size_t>(child)] = 1;
    std::vector<int> roots;
    for (std::size_t i = 0; i < hasParent.size(); ++i)
        if (hasParent[i] == 0) roots.push_back(static_cast<int>(i));
    return roots;
}

/// Depth first from the given roots, each node before its children.
[[nodiscard]] std::vector<int> descend(const tinygltf::Model& model, const std::vector<int>& roots) {
    std::vector<int> order, open(roots.rbegin(), roots.rend());
    std::vector<char> met(model.nodes.size(), 0);
    while (!open.empty()) {
        const int index = open.back();
        open.pop_back();
        if (met[static_cast<std::size_t>(index)] != 0) continue;  // a scene may list a root twice
        met[static_cast<std::size_t>(index)] = 1;
        order.push_back(index);
        const std::vector<int>& children = model.nodes[static_cast<std::size_t>(index)].children;
        open.insert(open.end(), children.rbegin(), children.rend());
    }
    return order;
}

}  // namespace

bool isFinite(const glm::dmat4& m) noexcept {
    for (glm::length_t c = 0; c < 4; ++c)
        for (glm::length_t r = 0; r < 4; ++r)
            if (!std::isfinite(m[c][r])) return false;
    return true;
}

std::vector<glm::dmat4> worldTransforms(const GltfAsset& asset) {
    const tinygltf::Model& model = asset.model();
    std::vector<glm::dmat4> world(model.nodes.size(), glm::dmat4(1.0));
    for (const int index : descend(model, rootNodes(model))) {
        const auto at = static_cast<std::size_t>(index);
        world[at] = world[at] * localTransform(asset, at);
        if (!isFinite(world[at]))
            asset.bad(element("nodes", at), "the node's transform is not finite", "scale it down");
        for (const int child : model.nodes[at].children) world[static_cast<std::size_t>(child)] = world[at];
    }
    return world;
}

std::vector<int> sceneNodes(const GltfAsset& asset) {
    const tinygltf::Model& model = asset.model();
    if (model.scenes.empty()) return descend(model, rootNodes(model));
    const int scene = model.defaultScene >= 0 ? model.defaultScene : 0;
    if (model.scenes.size() > 1)
        asset.notes().note("the file has " + std::to_string(model.scenes.size()) + " scenes: scene " +
                           std::to_string(scene) + " is taken");
    return descend(model, model.scenes[static_cast<std::size_t>(scene)].nodes);
}

std::vector<glm::dmat4> instanceTransforms(const GltfAsset& asset, int node) {
    const auto& extensions = asset.model().nodes[static_cast<std::size_t>(node)].extensions;
    const auto found = extensions.find("EXT_mesh_gpu_instancing");
    if (found == extensions.end() || !found->second.Has("attributes")) return {};
    const tinygltf::Value& attributes = found->second.Get("attributes");
    std::optional<AccessorReader> translation, rotation, scale;
    std::size_t count = 0;
    const auto open = [&](const char* name, std::optional<AccessorReader>& reader) {
        if (!attributes.Has(name)) return;
        reader.emplace(asset, attributes.Get(name).GetNumberAsInt());
        count = reader->count();
    };
    open("TRANSLATION", translation);
    open("ROTATION", rotation);
    open("SCALE", scale);

    std::vector<glm::dmat4> transforms;
    transforms.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 t = translation ? glm::dvec3(translation->vector(i)) : glm::dvec3(0.0);
        const glm::dvec3 s = scale ? glm::dvec3(scale->vector(i)) : glm::dvec3(1.0);
        const glm::dvec4 q =
            rotation ? unitQuaternion(glm::dvec4(rotation->vector(i)), asset) : glm::dvec4(0.0, 0.0, 0.0, 1.0);
        transforms.push_back(fromTrs(t, q, s));
    }
    return transforms;
}

}  // namespace pellucid

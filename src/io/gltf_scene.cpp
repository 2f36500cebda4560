#include "gltf_scene.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <map>
#include <optional>
#include <utility>

#include <tiny_gltf.h>

#include "gltf_accessors.h"
#include "gltf_meshes.h"
#include "gltf_nodes.h"

namespace pellucid {
namespace {

constexpr std::size_t kMaxGeometries = std::size_t{1} << 24;
constexpr std::size_t kMaxTriangles = std::size_t{1} << 28;  ///< in meshes, dropped ones too, instances not

/// Meshes are shared between all nodes that show the same primitive in the same shape.
struct MeshKey {
    int mesh = 0;
    std::size_t primitive = 0;
    int node = -1;  ///< of the one node that deforms the mesh; -1: none does
    auto operator<=>(const MeshKey&) const = default;
};

/// Whether a transform leaves no volume, independent of its scale: by the determinant over the product of the axes' lengths.
[[nodiscard]] bool flattens(const glm::dmat4& m) noexcept {
    glm::dmat3 axes(m);
    for (glm::length_t i = 0; i < 3; ++i) {
        const double length = glm::length(axes[i]);
        if (!(length > 1e-30)) return true;
        axes[i] /= length;
    }
    return std::fabs(glm::determinant(axes)) < 1e-9;
}

class MeshPlacer {
public:
    MeshPlacer(const GltfAsset& asset, const std::vector<glm::dmat4>& world, SceneDescription& description)
        : asset_(asset), world_(world), description_(description) {}

    void place(int index) {
        const tinygltf::Node& node = asset_.model().nodes[static_cast<std::size_t>(index)];
        if (node.mesh < 0) return;
        const tinygltf::Mesh& mesh = asset_.model().meshes[static_cast<std::size_t>(node.mesh)];
        const std::vector<glm::dmat4> places = placesOf(index);
        for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
            const bool skinned = node.skin >= 0 && hasInfluences(mesh.primitives[p]);
            const bool own = skinned || (!node.weights.empty() && !mesh.primitives[p].targets.empty());
            const MeshKey key{node.mesh, p, own ? index : -1};
            if (skinned)
                placeAt(key, glm::dmat4(1.0), index);  // a skin alone says where its mesh stands
            else
                for (const glm::dmat4& m : places) placeAt(key, m, index);
        }
    }

private:
    [[nodiscard]] std::vector<glm::dmat4> placesOf(int node) const {
        const glm::dmat4& here = world_[static_cast<std::size_t>(node)];
        std::vector<glm::dmat4> places = instanceTransforms(asset_, node);
        for (glm::dmat4& m : places) m = here * m;
        if (places.empty()) places.push_back(here);
        return places;
    }

    void placeAt(const MeshKey& key, const glm::dmat4& toWorld, int node) {
        if (!isFinite(toWorld))
            asset_.bad(element("nodes", static_cast<std::size_t>(node)), "a transform is not finite", "scale it down");
        const std::optional<std::uint32_t> mesh = meshOf(key);
        if (!mesh) return;
        if (description_.geometries.size() >= kMaxGeometries)
            asset_.bad(element("nodes", static_cast<std::size_t>(node)), "more than 2^24 placements of meshes",
                       "merge some of them");
        if (flattens(toWorld))
            description_.geometries.push_back({bake(*mesh, toWorld), glm::dmat4(1.0)});
        else
            description_.geometries.push_back({*mesh, toWorld});
    }

    [[nodiscard]] std::optional<std::uint32_t> meshOf(const MeshKey& key) {
        if (const auto known = meshes_.find(key); known != meshes_.end()) return known->second;
        std::optional<std::uint32_t>& number = meshes_[key];
        if (auto mesh =
                buildMesh(asset_, {key.mesh, key.primitive}, deformationOf(key), description_.droppedTriangles)) {
            number = add(std::move(*mesh));
        }
        checkLimit();
        return number;
    }

    [[nodiscard]] std::uint32_t add(Mesh mesh) {
        triangles_ += mesh.triangles.size();
        checkLimit();
        description_.meshes.push_back(std::move(mesh));
        return static_cast<std::uint32_t>(description_.meshes.size() - 1);
    }

    void checkLimit() const {
        if (triangles_ + description_.droppedTriangles > kMaxTriangles)
            asset_.bad("meshes", "more than 2^28 triangles", "split the scene");
    }

    /// A flattened body: its transform has no inverse, so the vertices go to the world and the normals go away.
    [[nodiscard]] std::uint32_t bake(std::uint32_t number, const glm::dmat4& toWorld) {
        Mesh mesh = description_.meshes[number];
        for (glm::vec3& p : mesh.positions) p = glm::vec3(toWorld * glm::dvec4(p, 1.0));
        mesh.normals.clear();
        mesh.tangents.clear();
        return add(std::move(mesh));
    }

    [[nodiscard]] Deformation deformationOf(const MeshKey& key) const {
        const tinygltf::Mesh& mesh = asset_.model().meshes[static_cast<std::size_t>(key.mesh)];
        if (key.node < 0) return {mesh.weights, {}};
        const tinygltf::Node& node = asset_.model().nodes[static_cast<std::size_t>(key.node)];
        Deformation deformation{node.weights.empty() ? mesh.weights : node.weights, {}};
        if (node.skin >= 0 && hasInfluences(mesh.primitives[key.primitive])) deformation.joints = jointsOf(node.skin);
        return deformation;
    }

    /// World transform of each joint times its inverse bind matrix (glTF 2.0 section 3.7.3.3).
    [[nodiscard]] std::vector<glm::dmat4> jointsOf(int index) const {
        const tinygltf::Skin& skin = asset_.model().skins[static_cast<std::size_t>(index)];
        std::optional<AccessorReader> inverseBind;
        if (skin.inverseBindMatrices >= 0) inverseBind.emplace(asset_, skin.inverseBindMatrices);
        std::vector<glm::dmat4> joints;
        for (std::size_t j = 0; j < skin.joints.size(); ++j) {
            const glm::dmat4& here = world_[static_cast<std::size_t>(skin.joints[j])];
            joints.push_back(inverseBind ? here * inverseBind->matrix(j) : here);
        }
        return joints;
    }

    const GltfAsset& asset_;
    const std::vector<glm::dmat4>& world_;
    SceneDescription& description_;
    std::map<MeshKey, std::optional<std::uint32_t>> meshes_;
    std::size_t triangles_ = 0;
};

}  // namespace

void addMeshes(const GltfAsset& asset, const std::vector<int>& nodes, const std::vector<glm::dmat4>& world,
               SceneDescription& description) {
    MeshPlacer placer(asset, world, description);
    for (const int node : nodes) placer.place(node);
}

}  // namespace pellucid

#include <cmath>
#include <string>

#include <tiny_gltf.h>

#include "gltf_accessors.h"
#include "gltf_meshes.h"

namespace pellucid {
namespace {

/// Adds weight x displacement to an attribute that the mesh has; displacements of others have nothing to move.
template <class T>
void displace(const GltfAsset& asset, const std::map<std::string, int>& target, const char* name, double weight,
              const std::vector<std::uint32_t>& used, std::vector<T>& values) {
    const auto found = target.find(name);
    if (found == target.end() || values.empty()) return;
    const AccessorReader reader(asset, found->second);
    for (std::size_t i = 0; i < used.size(); ++i)
        values[i] += static_cast<float>(weight) * T(reader.vector(used[i]));  // a tangent's w moves by the missing 0
}

/// JOINTS_n and WEIGHTS_n of all sets.
struct Influences {
    std::vector<AccessorReader> joints, weights;
};

[[nodiscard]] Influences readInfluences(const GltfAsset& asset, const tinygltf::Primitive& primitive) {
    Influences influences;
    for (int set = 0;; ++set) {
        const auto joints = primitive.attributes.find("JOINTS_" + std::to_string(set));
        const auto weights = primitive.attributes.find("WEIGHTS_" + std::to_string(set));
        if (joints == primitive.attributes.end() || weights == primitive.attributes.end()) return influences;
        influences.joints.emplace_back(asset, joints->second);
        influences.weights.emplace_back(asset, weights->second);
    }
}

class Blend {
public:
    Blend(const GltfAsset& asset, const PrimitiveId& id, const Influences& influences,
          const std::vector<glm::dmat4>& joints)
        : asset_(asset), id_(id), influences_(influences), joints_(joints) {}

    /// Weighted mean of the joints' matrices; a vertex without weights follows its first joint.
    [[nodiscard]] glm::dmat4 operator()(std::size_t vertex) const {
        glm::dmat4 sum(0.0);
        double total = 0.0;
        for (std::size_t set = 0; set < influences_.joints.size(); ++set) {
            const glm::vec4 weights = influences_.weights[set].vector(vertex);
            for (int k = 0; k < 4; ++k) {
                if (!(weights[k] > 0.0F) || !std::isfinite(weights[k])) continue;
                sum += static_cast<double>(weights[k]) * joint(set, vertex, static_cast<std::size_t>(k));
                total += static_cast<double>(weights[k]);
            }
        }
        return total > 0.0 ? sum / total : joint(0, vertex, 0);
    }

private:
    [[nodiscard]] const glm::dmat4& joint(std::size_t set, std::size_t vertex, std::size_t component) const {
        const std::uint32_t index = influences_.joints[set].integer(vertex, component);
        if (index >= joints_.size())
            asset_.bad(id_.path() + ".attributes.JOINTS_" + std::to_string(set),
                       "joint " + std::to_string(index) + " is past the end of the skin's joints",
                       "export the file again");
        return joints_[index];
    }

    const GltfAsset& asset_;
    const PrimitiveId& id_;
    const Influences& influences_;
    const std::vector<glm::dmat4>& joints_;
};

/// det(m) times the inverse transpose: takes normals along, even where m has no inverse.
[[nodiscard]] glm::dmat3 cofactors(const glm::dmat3& m) noexcept {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

/// A direction after `m`; its length is mended later, but must survive the way to float.
[[nodiscard]] glm::vec3 turned(const glm::dmat3& m, const glm::vec3& direction, double sign) noexcept {
    const glm::dvec3 v = m * glm::dvec3(direction);
    const double length = glm::length(v);
    return length > 0.0 ? glm::vec3(sign / length * v) : glm::vec3(0.0F);
}

}  // namespace

bool hasInfluences(const tinygltf::Primitive& primitive) {
    return primitive.attributes.contains("JOINTS_0") && primitive.attributes.contains("WEIGHTS_0");
}

void applyMorphTargets(const GltfAsset& asset, const tinygltf::Primitive& primitive, const std::vector<double>& weights,
                       const std::vector<std::uint32_t>& used, Mesh& mesh) {
    for (std::size_t t = 0; t < primitive.targets.size() && t < weights.size(); ++t) {
        const std::map<std::string, int>& target = primitive.targets[t];
        const double weight = weights[t];
        if (weight == 0.0) continue;
        displace(asset, target, "POSITION", weight, used, mesh.positions);
        displace(asset, target, "NORMAL", weight, used, mesh.normals);
        displace(asset, target, "TANGENT", weight, used, mesh.tangents);
        displace(asset, target, "TEXCOORD_0", weight, used, mesh.uv0);
        displace(asset, target, "TEXCOORD_1", weight, used, mesh.uv1);
        displace(asset, target, "COLOR_0", weight, used, mesh.colors);
    }
}

void applySkin(const GltfAsset& asset, const PrimitiveId& id, const std::vector<glm::dmat4>& joints,
               const std::vector<std::uint32_t>& used, Mesh& mesh) {
    const tinygltf::Primitive& primitive =
        asset.model().meshes[static_cast<std::size_t>(id.mesh)].primitives[id.primitive];
    const Influences influences = readInfluences(asset, primitive);
    const Blend blend(asset, id, influences, joints);
    bool mirrored = false;
    for (std::size_t i = 0; i < used.size(); ++i) {
        const glm::dmat4 m = blend(used[i]);
        const glm::dmat3 linear(m);
        const double determinant = glm::determinant(linear);
        if (i == 0) mirrored = determinant < 0.0;  // a skeleton mirrors as a whole or not at all
        mesh.positions[i] = glm::vec3(m * glm::dvec4(mesh.positions[i], 1.0));
        if (!mesh.normals.empty())
            mesh.normals[i] = turned(cofactors(linear), mesh.normals[i], determinant < 0.0 ? -1.0 : 1.0);
        if (!mesh.tangents.empty())
            mesh.tangents[i] = glm::vec4(turned(linear, mesh.tangents[i], 1.0), mesh.tangents[i].w);
    }
    if (mirrored) turnRound(mesh);
}

}  // namespace pellucid

#include "gltf_validate.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string_view>

#include <tiny_gltf.h>

#include "gltf_schema.h"

namespace pellucid {
namespace {

constexpr const char* kExportAgain = "export the file again";
constexpr std::size_t kMaxDepth = 4096;

/// Forms in which an attribute may come: component types as a set of bits, for plain and for normalised integers.
/// glTF 2.0 section 3.7.2.1; the `quantized` ones need KHR_mesh_quantization.
struct AttributeForm {
    std::string_view name;  ///< without the set's number
    std::array<int, 2> types;
    std::string_view plain, normalized, quantizedPlain,
        quantizedNormalized;  ///< b B s S f: letters as in Python's struct
};
constexpr AttributeForm kForms[] = {
    {"POSITION", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC3}, "f", "", "bBsS", "bBsS"},
    {"NORMAL", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC3}, "f", "", "", "bs"},
    {"TANGENT", {TINYGLTF_TYPE_VEC4, TINYGLTF_TYPE_VEC4}, "f", "", "", "bs"},
    {"TEXCOORD", {TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC2}, "f", "BS", "bBsS", "bs"},
    {"COLOR", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4}, "f", "BS", "", ""},
    {"JOINTS", {TINYGLTF_TYPE_VEC4, TINYGLTF_TYPE_VEC4}, "BS", "", "", ""},
    {"WEIGHTS", {TINYGLTF_TYPE_VEC4, TINYGLTF_TYPE_VEC4}, "f", "BS", "", ""},
};
/// Displacements of morph targets (section 3.7.2.2 and the quantization extension): tangents lose their sign.
constexpr AttributeForm kTargetForms[] = {
    {"POSITION", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC3}, "f", "", "bs", "bs"},
    {"NORMAL", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC3}, "f", "", "", "bs"},
    {"TANGENT", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC3}, "f", "", "", "bs"},
    {"TEXCOORD", {TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC2}, "f", "bBsS", "bs", ""},
    {"COLOR", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4}, "f", "bBsS", "", ""},
};
/// EXT_mesh_gpu_instancing.
constexpr AttributeForm kInstanceForms[] = {
    {"TRANSLATION", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC3}, "f", "", "", ""},
    {"ROTATION", {TINYGLTF_TYPE_VEC4, TINYGLTF_TYPE_VEC4}, "f", "bs", "", ""},
    {"SCALE", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC3}, "f", "", "", ""},
};

[[nodiscard]] char typeLetter(int componentType) {
    switch (componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return 'b';
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 'B';
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return 's';
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 'S';
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return 'I';
        default:
            return 'f';
    }
}

class Validator {
public:
    explicit Validator(const GltfAsset& asset) : asset_(asset), model_(asset.model()) {
        const auto& used = asset.json().extensionsUsed;
        quantized_ = std::find(used.begin(), used.end(), "KHR_mesh_quantization") != used.end();
    }

    void checkAll() const {
        for (std::size_t i = 0; i < model_.bufferViews.size(); ++i) (void)asset_.viewBytes(static_cast<int>(i));
        for (std::size_t i = 0; i < model_.accessors.size(); ++i) checkAccessor(i);
        for (std::size_t i = 0; i < model_.meshes.size(); ++i) checkMesh(i);
        for (std::size_t i = 0; i < model_.skins.size(); ++i) checkSkin(i);
        checkTrees();
        for (std::size_t i = 0; i < model_.nodes.size(); ++i) checkNode(i);
    }

private:
    [[nodiscard]] const tinygltf::Accessor& accessor(int index) const {
        return model_.accessors[static_cast<std::size_t>(index)];
    }

    /// `count` elements of `size` bytes, `stride` apart, from `offset` in the view. No product overflows: counts are
    /// compared by division.
    void checkExtent(int view, std::uint64_t offset, std::uint64_t count, std::uint64_t size, std::uint64_t stride,
                     const std::string& path) const {
        const std::uint64_t length = model_.bufferViews[static_cast<std::size_t>(view)].byteLength;
        if (offset <= length && size <= length - offset && count - 1 <= (length - offset - size) / stride) return;
        asset_.bad(path,
                   std::to_string(count) + " elements reach past the end of buffer view " + std::to_string(view) +
                       " of " + std::to_string(length) + " bytes",
                   kExportAgain);
    }

    void checkAccessor(std::size_t index) const {
        const tinygltf::Accessor& a = model_.accessors[index];
        const std::string path = element("accessors", index);
        const std::size_t size = elementLayout(a).size;
        const std::size_t stride = model_.bufferViews[static_cast<std::size_t>(a.bufferView)].byteStride;
        if (stride != 0 && stride < size)
            asset_.bad(path, "the buffer view's stride is less than an element", kExportAgain);
        checkExtent(a.bufferView, a.byteOffset, a.count, size, stride == 0 ? size : stride, path);
        if (!a.sparse.isSparse) return;
        const auto count = static_cast<std::uint64_t>(a.sparse.count);
        if (count > a.count) asset_.bad(path + ".sparse.count", "more sparse elements than elements", kExportAgain);
        const auto indexSize = static_cast<std::uint64_t>(
            tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(a.sparse.indices.componentType)));
        checkExtent(a.sparse.indices.bufferView, static_cast<std::uint64_t>(a.sparse.indices.byteOffset), count,
                    indexSize, indexSize, path + ".sparse.indices");
        checkExtent(a.sparse.values.bufferView, static_cast<std::uint64_t>(a.sparse.values.byteOffset), count, size,
                    size, path + ".sparse.values");
    }

    /// Attributes that no form names (custom ones, further sets) are left out by the loader and are not checked, but
    /// for their length.
    void checkAttributes(const std::map<std::string, int>& attributes, std::span<const AttributeForm> forms,
                         std::size_t count, const std::string& path) const {
        for (const auto& [name, index] : attributes) {
            const tinygltf::Accessor& a = accessor(index);
            const std::string at = path + "." + name;
            if (a.count != count)
                asset_.bad(at, std::to_string(a.count) + " elements stand beside " + std::to_string(count) + " others",
                           kExportAgain);
            const std::string base = name.substr(0, name.find('_'));
            for (const AttributeForm& form : forms)
                if (form.name == base) checkForm(a, form, at);
        }
    }

    void checkForm(const tinygltf::Accessor& a, const AttributeForm& form, const std::string& path) const {
        const char letter = typeLetter(a.componentType);
        const bool normalized = a.normalized && letter != 'f';
        const auto holds = [letter](std::string_view set) { return set.find(letter) != std::string_view::npos; };
        const bool shape = a.type == form.types[0] || a.type == form.types[1];
        if (shape && holds(normalized ? form.normalized : form.plain)) return;
        const bool ifQuantized = shape && holds(normalized ? form.quantizedNormalized : form.quantizedPlain);
        if (ifQuantized && quantized_) return;
        asset_.bad(path, "its accessor's type is not allowed here",
                   ifQuantized ? "declare KHR_mesh_quantization in extensionsUsed" : kExportAgain);
    }

    void checkMesh(std::size_t index) const {
        const tinygltf::Mesh& mesh = model_.meshes[index];
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
            const tinygltf::Primitive& primitive = mesh.primitives[i];
            const std::string path = element(element("meshes", index) + ".primitives", i);
            if (primitive.indices >= 0) checkIndices(accessor(primitive.indices), path + ".indices");
            if (primitive.targets.size() != mesh.primitives[0].targets.size())
                asset_.bad(path + ".targets", "primitives of one mesh have different numbers of targets", kExportAgain);
            if (primitive.attributes.empty()) continue;
            const auto position = primitive.attributes.find("POSITION");
            const int first =
                position != primitive.attributes.end() ? position->second : primitive.attributes.begin()->second;
            const std::size_t count = accessor(first).count;
            checkAttributes(primitive.attributes, kForms, count, path + ".attributes");
            for (std::size_t t = 0; t < primitive.targets.size(); ++t)
                checkAttributes(primitive.targets[t], kTargetForms, count, element(path + ".targets", t));
        }
        if (!mesh.weights.empty() && mesh.weights.size() != mesh.primitives[0].targets.size())
            asset_.bad(element("meshes", index) + ".weights", "not one weight for each target", kExportAgain);
    }

    void checkIndices(const tinygltf::Accessor& a, const std::string& path) const {
        const char letter = typeLetter(a.componentType);
        if (a.type != TINYGLTF_TYPE_SCALAR || (letter != 'B' && letter != 'S' && letter != 'I') || a.normalized)
            asset_.bad(path, "indices must be unsigned scalars, not normalised", kExportAgain);
    }

    void checkSkin(std::size_t index) const {
        const tinygltf::Skin& skin = model_.skins[index];
        if (skin.inverseBindMatrices < 0) return;
        const tinygltf::Accessor& a = accessor(skin.inverseBindMatrices);
        const std::string path = element("skins", index) + ".inverseBindMatrices";
        if (a.type != TINYGLTF_TYPE_MAT4 || typeLetter(a.componentType) != 'f')
            asset_.bad(path, "inverse bind matrices must be MAT4 of floats", kExportAgain);
        if (a.count < skin.joints.size()) asset_.bad(path, "there are fewer matrices than joints", kExportAgain);
    }

    void checkNode(std::size_t index) const {
        const tinygltf::Node& node = model_.nodes[index];
        const std::string path = element("nodes", index);
        if (node.mesh >= 0 && !node.weights.empty()) {
            const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
            if (node.weights.size() != mesh.primitives[0].targets.size())
                asset_.bad(path + ".weights", "not one weight for each target of the mesh", kExportAgain);
        }
        const auto found = node.extensions.find("EXT_mesh_gpu_instancing");
        if (found == node.extensions.end() || !found->second.Has("attributes")) return;
        std::map<std::string, int> attributes;
        const tinygltf::Value& value = found->second.Get("attributes");
        for (const std::string& key : value.Keys()) attributes[key] = value.Get(key).GetNumberAsInt();
        if (attributes.empty()) return;
        checkAttributes(attributes, kInstanceForms, accessor(attributes.begin()->second).count,
                        path + ".extensions.EXT_mesh_gpu_instancing.attributes");
    }

    /// Every node has at most one parent, and none is above itself: walked from the roots, all nodes are met once.
    void checkTrees() const {
        const std::size_t count = model_.nodes.size();
        std::vector<std::size_t> depth(count, 0);
        std::vector<char> hasParent(count, 0);
        for (std::size_t i = 0; i < count; ++i)
            for (const int child : model_.nodes[i].children) {
                char& taken = hasParent[static_cast<std::size_t>(child)];
                if (taken != 0)
                    asset_.bad(element("nodes", i) + ".children",
                               "node " + std::to_string(child) + " has more than one parent",
                               "instance its mesh instead");
                taken = 1;
            }
        std::vector<std::size_t> open;
        for (std::size_t i = 0; i < count; ++i)
            if (hasParent[i] == 0) open.push_back(i);
        std::size_t met = 0;
        while (!open.empty()) {
            const std::size_t i = open.back();
            open.pop_back();
            ++met;
            if (depth[i] > kMaxDepth)
                asset_.bad(element("nodes", i), "the nodes are nested too deeply", "flatten them");
            for (const int child : model_.nodes[i].children) {
                depth[static_cast<std::size_t>(child)] = depth[i] + 1;
                open.push_back(static_cast<std::size_t>(child));
            }
        }
        if (met != count) asset_.bad("nodes", "the nodes form a cycle", kExportAgain);
        for (std::size_t s = 0; s < model_.scenes.size(); ++s)
            for (const int root : model_.scenes[s].nodes)
                if (hasParent[static_cast<std::size_t>(root)] != 0)
                    asset_.bad(element("scenes", s) + ".nodes", "node " + std::to_string(root) + " is no root",
                               kExportAgain);
    }

    const GltfAsset& asset_;
    const tinygltf::Model& model_;
    bool quantized_ = false;
};

}  // namespace

std::vector<std::string> ignoredExtensions(const GltfAsset& asset) {
    std::vector<std::string> ignored;
    for (const std::string& name : asset.json().extensionsUsed)
        if (!isKnownExtension(name) || name == "KHR_materials_unlit") ignored.push_back(name);
    return ignored;
}

void checkExtensions(const GltfAsset& asset) {
    for (const std::string& name : asset.json().extensionsRequired)
        if (!isKnownExtension(name))
            asset.bad("extensionsRequired", "the file needs " + name + ", which is not supported",
                      "export it without this extension");
    for (const std::string& name : ignoredExtensions(asset))
        asset.notes().warn(name == "KHR_materials_unlit"
                               ? "KHR_materials_unlit is ignored: its materials are lit as others"
                               : "the extension " + name + " is not understood and is ignored");
}

void validateModel(const GltfAsset& asset) { Validator(asset).checkAll(); }

}  // namespace pellucid

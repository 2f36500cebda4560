#include "glb_writer.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace scenes {

namespace {

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

constexpr int kFloat = 5126, kUnsignedByte = 5121, kUnsignedShort = 5123, kUnsignedInt = 5125;
constexpr int kVertexTarget = 34962, kIndexTarget = 34963, kNoTarget = 0;
constexpr int kNearest = 9728, kLinear = 9729;

/// Appends to a glTF array that comes to be with its first element.
std::size_t push(Json& array, Json value) {
    array.push_back(std::move(value));
    return array.size() - 1;
}

/// Turns -z towards `direction`, as cameras and punctual lights look.
glm::dquat lookingAlong(const glm::dvec3& direction) {
    const glm::dvec3 unit = glm::normalize(direction);
    const bool steep = glm::abs(unit.y) > 0.999;
    return glm::quatLookAt(unit, steep ? glm::dvec3(0.0, 0.0, -1.0) : glm::dvec3(0.0, 1.0, 0.0));
}

Json toJson(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

void padTo4(std::vector<std::uint8_t>& bytes, std::uint8_t filler) { bytes.resize((bytes.size() + 3) / 4 * 4, filler); }

void writeWord(std::ostream& out, std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    out.write(reinterpret_cast<const char*>(&word), sizeof word);
}

void writeChunk(std::ostream& out, const char* type, const std::vector<std::uint8_t>& bytes) {
    writeWord(out, bytes.size());
    out.write(type, 4);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

GlbWriter::GlbWriter(std::string name) {
    root_["asset"] = {{"version", "2.0"}, {"generator", "pellucid make_scenes"}};
    root_["scene"] = 0;
    root_["scenes"] = Json::array({{{"name", std::move(name)}, {"nodes", Json::array()}}});
}

std::size_t GlbWriter::addMaterial(const Json& material) {
    noteExtensions(material);
    return push(root_["materials"], material);
}

std::size_t GlbWriter::addTexture(const std::string& name, const std::vector<std::uint8_t>& png, Filter filter) {
    const std::size_t view = addView(png.data(), png.size(), kNoTarget);
    const std::size_t image = push(root_["images"], {{"name", name}, {"bufferView", view}, {"mimeType", "image/png"}});
    const int mode = filter == Filter::Nearest ? kNearest : kLinear;
    const std::size_t sampler = push(root_["samplers"], {{"magFilter", mode}, {"minFilter", mode}});
    return push(root_["textures"], {{"source", image}, {"sampler", sampler}});
}

std::size_t GlbWriter::addMesh(const std::string& name, const Shape& shape, std::size_t material) {
    Json attributes;
    attributes["POSITION"] = addVectors(shape.positions, true);
    if (!shape.normals.empty()) {
        attributes["NORMAL"] = addVectors(shape.normals, false);
    }
    if (!shape.uvs.empty()) {
        const std::vector<glm::vec2> uvs(shape.uvs.begin(), shape.uvs.end());
        const std::size_t view = addView(uvs.data(), uvs.size() * sizeof(glm::vec2), kVertexTarget);
        attributes["TEXCOORD_0"] =
            push(root_["accessors"],
                 {{"bufferView", view}, {"componentType", kFloat}, {"count", uvs.size()}, {"type", "VEC2"}});
    }
    if (!shape.colors.empty()) {
        const std::size_t view = addView(shape.colors.data(), shape.colors.size() * sizeof(glm::u8vec4), kVertexTarget);
        attributes["COLOR_0"] = push(root_["accessors"], {{"bufferView", view},
                                                          {"componentType", kUnsignedByte},
                                                          {"count", shape.colors.size()},
                                                          {"normalized", true},
                                                          {"type", "VEC4"}});
    }
    const Json primitive = {{"attributes", attributes}, {"indices", addIndices(shape)}, {"material", material}};
    return push(root_["meshes"], {{"name", name}, {"primitives", Json::array({primitive})}});
}

void GlbWriter::place(const std::string& name, std::size_t mesh, const Placement& placement) {
    addNode({{"name", name}, {"mesh", mesh}}, placement);
}

void GlbWriter::add(const std::string& name, const Shape& shape, std::size_t material, const Placement& placement) {
    place(name, addMesh(name, shape, material), placement);
}

void GlbWriter::addCamera(const std::string& name, const View& view) {
    const Json perspective = {
        {"yfov", glm::radians(view.verticalFovDegrees)}, {"aspectRatio", view.aspect}, {"znear", 0.001}};
    const std::size_t camera =
        push(root_["cameras"], {{"name", name}, {"type", "perspective"}, {"perspective", perspective}});
    addNode({{"name", name}, {"camera", camera}}, {view.eye, lookingAlong(view.target - view.eye)});
}

void GlbWriter::addLight(const Json& light, const glm::dvec3& position, const glm::dvec3& direction) {
    extensions_.insert("KHR_lights_punctual");
    const std::size_t index = push(root_["extensions"]["KHR_lights_punctual"]["lights"], light);
    addNode({{"name", light["name"]}, {"extensions", {{"KHR_lights_punctual", {{"light", index}}}}}},
            {position, lookingAlong(direction)});
}

void GlbWriter::write(const std::filesystem::path& file) const {
    Json root = root_;
    std::vector<std::uint8_t> binary = binary_;
    padTo4(binary, 0);
    root["buffers"] = Json::array({{{"byteLength", binary.size()}}});
    if (!extensions_.empty()) {
        root["extensionsUsed"] = extensions_;
    }
    const std::string text = root.dump();
    std::vector<std::uint8_t> json(text.begin(), text.end());
    padTo4(json, ' ');

    std::ofstream out(file, std::ios::binary);
    out.write("glTF", 4);
    writeWord(out, 2);
    writeWord(out, 12 + 8 + json.size() + 8 + binary.size());
    writeChunk(out, "JSON", json);
    writeChunk(out, "BIN\0", binary);
    if (!out.flush()) {
        throw std::runtime_error("cannot write " + file.string());
    }
}

std::size_t GlbWriter::addView(const void* data, std::size_t bytes, int target) {
    padTo4(binary_, 0);
    Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes}};
    if (target != kNoTarget) {
        view["target"] = target;
    }
    const auto* first = static_cast<const std::uint8_t*>(data);
    binary_.insert(binary_.end(), first, first + bytes);
    return push(root_["bufferViews"], std::move(view));
}

std::size_t GlbWriter::addVectors(const std::vector<glm::dvec3>& values, bool withBounds) {
    const std::vector<glm::vec3> vectors(values.begin(), values.end());
    const std::size_t view = addView(vectors.data(), vectors.size() * sizeof(glm::vec3), kVertexTarget);
    Json accessor = {{"bufferView", view}, {"componentType", kFloat}, {"count", vectors.size()}, {"type", "VEC3"}};
    if (withBounds) {
        glm::vec3 low = vectors.front(), high = vectors.front();
        for (const glm::vec3& v : vectors) {
            low = glm::min(low, v);
            high = glm::max(high, v);
        }
        accessor["min"] = toJson(low);
        accessor["max"] = toJson(high);
    }
    return push(root_["accessors"], std::move(accessor));
}

std::size_t GlbWriter::addIndices(const Shape& shape) {
    std::vector<std::uint32_t> wide;
    for (const glm::uvec3& triangle : shape.triangles) {
        wide.insert(wide.end(), {triangle.x, triangle.y, triangle.z});
    }
    const bool isShort = shape.positions.size() < 65536;  // 65535 itself is no index in glTF
    const std::vector<std::uint16_t> narrow(wide.begin(), isShort ? wide.end() : wide.begin());
    const std::size_t view = isShort ? addView(narrow.data(), narrow.size() * sizeof(std::uint16_t), kIndexTarget)
                                     : addView(wide.data(), wide.size() * sizeof(std::uint32_t), kIndexTarget);
    return push(root_["accessors"], {{"bufferView", view},
                                     {"componentType", isShort ? kUnsignedShort : kUnsignedInt},
                                     {"count", wide.size()},
                                     {"type", "SCALAR"}});
}

void GlbWriter::addNode(Json node, const Placement& placement) {
    if (placement.translation != glm::dvec3(0.0)) {
        node["translation"] = toJson(placement.translation);
    }
    const glm::dquat& turn = placement.rotation;
    if (turn != glm::dquat(1.0, 0.0, 0.0, 0.0)) {
        node["rotation"] = {turn.x, turn.y, turn.z, turn.w};
    }
    if (placement.scale != glm::dvec3(1.0)) {
        node["scale"] = toJson(placement.scale);
    }
    root_["scenes"][0]["nodes"].push_back(push(root_["nodes"], std::move(node)));
}

void GlbWriter::noteExtensions(const Json& value) {
    if (!value.is_object()) {
        return;
    }
    for (const auto& [key, inner] : value.items()) {
        if (key == "extensions") {
            for (const auto& [extension, ignored] : inner.items()) {
                extensions_.insert(extension);
            }
        }
        noteExtensions(inner);
    }
}

}  // namespace scenes

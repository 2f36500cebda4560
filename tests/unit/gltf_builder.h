/// Builds small glTF files in memory for tests: JSON by hand, data appended to one binary chunk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <pellucid/base/error.h>
#include <pellucid/io/gltf.h>

namespace pellucid::test {

using Json = nlohmann::json;

inline constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125,
                     kFloat = 5126;

class GltfBuilder {
public:
    Json json = {{"asset", {{"version", "2.0"}}}};
    std::vector<std::byte> binary;

    /// Appends values as a buffer view of their own; returns its number.
    template <class T>
    int view(const std::vector<T>& values, int stride = 0) {
        while (binary.size() % 4 != 0) binary.push_back(std::byte{0});
        Json view = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", values.size() * sizeof(T)}};
        if (stride > 0) view["byteStride"] = stride;
        const auto bytes = std::as_bytes(std::span(values));
        binary.insert(binary.end(), bytes.begin(), bytes.end());
        json["bufferViews"].push_back(std::move(view));
        return static_cast<int>(json["bufferViews"].size()) - 1;
    }

    int accessor(Json accessor) {
        json["accessors"].push_back(std::move(accessor));
        return static_cast<int>(json["accessors"].size()) - 1;
    }

    template <class T>
    int data(const std::vector<T>& values, int componentType, const char* type, bool normalized = false) {
        const std::size_t components = std::string(type) == "SCALAR" ? 1
                                       : std::string(type) == "MAT4" ? 16
                                                                     : static_cast<std::size_t>(type[3] - '0');
        Json accessor = {{"bufferView", view(values)},
                         {"componentType", componentType},
                         {"type", type},
                         {"count", values.size() / components}};
        if (normalized) accessor["normalized"] = true;
        return this->accessor(std::move(accessor));
    }

    int floats(const std::vector<float>& values, const char* type) { return data(values, kFloat, type); }

    int mesh(Json primitive) {
        json["meshes"].push_back({{"primitives", Json::array({std::move(primitive)})}});
        return static_cast<int>(json["meshes"].size()) - 1;
    }

    /// A node of the scene.
    int node(Json node) {
        json["nodes"].push_back(std::move(node));
        const int index = static_cast<int>(json["nodes"].size()) - 1;
        if (!json.contains("scenes")) json["scenes"] = Json::array({{{"nodes", Json::array()}}});
        json["scenes"][0]["nodes"].push_back(index);
        return index;
    }

    [[nodiscard]] std::vector<std::byte> glb() const {
        Json root = json;
        if (!binary.empty() && !root.contains("buffers"))
            root["buffers"] = Json::array({{{"byteLength", binary.size()}}});
        std::string text = root.dump();
        while (text.size() % 4 != 0) text.push_back(' ');
        std::vector<std::byte> chunk = binary;
        while (chunk.size() % 4 != 0) chunk.push_back(std::byte{0});
        std::vector<std::byte> bytes;
        const auto word = [&bytes](std::size_t value) {
            for (unsigned i = 0; i < 4; ++i) bytes.push_back(static_cast<std::byte>((value >> (8 * i)) & 255U));
        };
        word(0x46546C67);
        word(2);
        word(12 + 8 + text.size() + (chunk.empty() ? 0 : 8 + chunk.size()));
        word(text.size());
        word(0x4E4F534A);
        for (const char c : text) bytes.push_back(static_cast<std::byte>(c));
        if (!chunk.empty()) {
            word(chunk.size());
            word(0x004E4942);
            bytes.insert(bytes.end(), chunk.begin(), chunk.end());
        }
        return bytes;
    }

    [[nodiscard]] SceneDescription load(const LogSink& log = {}) const {
        return loadGltfFromMemory(glb(), "test.glb", log);
    }
};

/// One right triangle in the plane z = 0, counter-clockwise seen from +z, on a node of its own.
inline GltfBuilder triangle() {
    GltfBuilder b;
    const int positions = b.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", positions}}}})}});
    return b;
}

inline Json& primitive(GltfBuilder& b) { return b.json["meshes"][0]["primitives"][0]; }

/// Loads what must not load and checks the error's kind and that its place and its problem say these words.
inline void expectError(const std::vector<std::byte>& bytes, const std::string& where, const std::string& problem,
                        const std::string& name = "test.glb") {
    try {
        (void)loadGltfFromMemory(bytes, name);
        ADD_FAILURE() << "loaded, but should say: " << problem << " at " << where;
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::BadInput);
        EXPECT_NE(e.where().find(where), std::string::npos) << e.what();
        EXPECT_NE(e.problem().find(problem), std::string::npos) << e.what();
        EXPECT_FALSE(e.mend().empty());
    }
}
inline void expectError(const GltfBuilder& b, const std::string& where, const std::string& problem) {
    expectError(b.glb(), where, problem);
}

inline bool warns(const SceneDescription& scene, const std::string& words) {
    for (const std::string& warning : scene.warnings)
        if (warning.find(words) != std::string::npos) return true;
    return false;
}

}  // namespace pellucid::test

/// Broken glTF files: each gives one Error that names the place, and never a crash.
#include <algorithm>
#include <filesystem>
#include <limits>

#include <gtest/gtest.h>

#include "gltf_builder.h"

namespace pellucid {
namespace {

using test::expectError;
using test::GltfBuilder;
using test::Json;
using test::primitive;
using test::triangle;

std::vector<std::byte> bytesOf(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

TEST(GltfErrors, NoGltfAtAll) {
    expectError(bytesOf(""), "a.gltf", "no glTF", "a.gltf");
    expectError(bytesOf(""), "a.glb", "empty", "a.glb");
    expectError(bytesOf("hello"), "a.gltf", "no glTF", "a.gltf");
    expectError(bytesOf("[]"), "a.gltf", "no object", "a.gltf");
    expectError(bytesOf("{\"asset\":{\"version\":\"2.0\xff\"}}"), "a.gltf", "UTF-8", "a.gltf");
    expectError(bytesOf(std::string(100000, '[')), "a.gltf", "nested too deeply", "a.gltf");
    expectError(bytesOf(R"({"asset":{"version":"1.0"}})"), "asset.version", "not 2.x", "a.gltf");
    expectError(bytesOf(R"({"asset":{"version":"2.0","minVersion":"2.1"}})"), "asset.minVersion", "2.1", "a.gltf");
    expectError(bytesOf(R"({"asset":{}})"), "asset", "'version' is missing", "a.gltf");
    expectError(bytesOf(R"({})"), "a.gltf", "'asset' is missing", "a.gltf");
    expectError(bytesOf(R"({"asset":{"version":"2.0"}})"), "a.gltf", "no triangles", "a.gltf");
}

TEST(GltfErrors, EveryTruncationOfAGlb) {
    const std::vector<std::byte> whole = triangle().glb();
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_THROW((void)loadGltfFromMemory(std::span(whole).first(size), "test.glb"), Error) << size;
}

TEST(GltfErrors, GlbHeader) {
    std::vector<std::byte> version = triangle().glb();
    version[4] = std::byte{1};
    expectError(version, "test.glb", "version 1 is not 2");
    std::vector<std::byte> chunk = triangle().glb();
    chunk[15] = std::byte{255};
    expectError(chunk, "test.glb", "past its end");
    std::vector<std::byte> type = triangle().glb();
    type[16] = std::byte{'B'};
    expectError(type, "test.glb", "first chunk");
}

/// Any byte may be wrong: the result is a scene or an Error.
TEST(GltfErrors, EveryByteFlipped) {
    GltfBuilder b = triangle();
    primitive(b)["indices"] = b.data(std::vector<std::uint8_t>{0, 1, 2}, test::kUnsignedByte, "SCALAR");
    const std::vector<std::byte> whole = b.glb();
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::vector<std::byte> broken = whole;
        broken[i] ^= std::byte{static_cast<unsigned char>(1U << (i % 8))};
        try {
            EXPECT_FALSE(loadGltfFromMemory(broken, "test.glb").meshes.empty());
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::BadInput);
        }
    }
}

TEST(GltfErrors, WrongTypesAndMissingMembers) {
    GltfBuilder b = triangle();
    b.json["nodes"][0]["mesh"] = "0";
    expectError(b, "nodes[0].mesh", "integer");
    b.json["nodes"][0]["mesh"] = 0.0;  // a whole number all the same
    EXPECT_EQ(b.load().meshes.size(), 1U);
    b.json["nodes"][0]["mesh"] = -1;
    expectError(b, "nodes[0].mesh", "0 or more");
    b.json["nodes"][0]["mesh"] = 0;
    b.json["nodes"][0]["translation"] = {1, 2};
    expectError(b, "nodes[0].translation", "wrong length");
    b.json["nodes"][0]["translation"] = {1, nullptr, 2};
    expectError(b, "nodes[0].translation[1]", "number");
    b = triangle();
    b.json["accessors"][0]["componentType"] = 5130;
    expectError(b, "accessors[0].componentType", "none of");
    b.json["accessors"][0].erase("componentType");
    expectError(b, "accessors[0]", "'componentType' is missing");
    b = triangle();
    primitive(b).erase("attributes");
    expectError(b, "meshes[0].primitives[0]", "'attributes' is missing");
    b = triangle();
    b.json["materials"] = Json::object();
    expectError(b, "materials", "array");
    b.json["materials"] = Json::array({{{"extensions", {{"KHR_materials_ior", {{"ior", "x"}}}}}}});
    expectError(b, "materials[0].extensions.KHR_materials_ior.ior", "number");
}

TEST(GltfErrors, IndicesOutOfRange) {
    GltfBuilder b = triangle();
    b.json["nodes"][0]["mesh"] = 7;
    expectError(b, "nodes[0].mesh", "there are 1 meshes");
    b = triangle();
    primitive(b)["attributes"]["NORMAL"] = 3;
    expectError(b, "meshes[0].primitives[0].attributes.NORMAL", "there are 1 accessors");
    b = triangle();
    b.json["accessors"][0]["bufferView"] = 1;
    expectError(b, "accessors[0].bufferView", "there are 1 bufferViews");
    b = triangle();
    b.json["bufferViews"][0]["buffer"] = 1;
    expectError(b, "bufferViews[0].buffer", "there are 1 buffers");
    b = triangle();
    b.json["scene"] = 1;
    expectError(b, "scene", "there are 1 scenes");
    b = triangle();
    b.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    expectError(b, "nodes[0].extensions.KHR_lights_punctual.light", "there are 0");
}

TEST(GltfErrors, SizesThatDoNotFit) {
    GltfBuilder b = triangle();
    b.json["bufferViews"][0]["byteLength"] = 37;
    expectError(b, "bufferViews[0]", "past the end");
    b.json["bufferViews"][0]["byteLength"] = 9007199254740992U;
    expectError(b, "bufferViews[0]", "past the end");
    b = triangle();
    b.json["accessors"][0]["count"] = 4;
    expectError(b, "accessors[0]", "past the end");
    b.json["accessors"][0]["count"] = 9007199254740992U;  // times 12 would overflow
    expectError(b, "accessors[0]", "past the end");
    b.json["accessors"][0]["count"] = 0;
    expectError(b, "accessors[0].count", "out of range");
    b = triangle();
    b.json["accessors"][0]["byteOffset"] = 4;
    expectError(b, "accessors[0]", "past the end");
    b = triangle();
    b.json["bufferViews"][0]["byteStride"] = 8;
    expectError(b, "accessors[0]", "stride is less");
    b.json["bufferViews"][0]["byteStride"] = 13;
    expectError(b, "bufferViews[0].byteStride", "multiple of 4");
    b = triangle();
    b.json["buffers"] = Json::array({{{"byteLength", 1000}}});
    expectError(b, "buffers[0].byteLength", "claims 1000 bytes");
    b.json["buffers"] = Json::array({{{"byteLength", 36}, {"uri", "beside.bin"}}});
    expectError(b, "buffers[0].uri", "file in memory");
    b = triangle();
    b.json["accessors"][0].erase("bufferView");
    b.json["accessors"][0]["count"] = 1000000000000;
    expectError(b, "accessors[0].count", "no buffer view");
}

TEST(GltfErrors, AccessorsOfTheWrongForm) {
    GltfBuilder b = triangle();
    b.json["accessors"][0]["type"] = "VEC2";
    expectError(b, "meshes[0].primitives[0].attributes.POSITION", "type is not allowed");
    b = triangle();
    primitive(b)["indices"] = b.data(std::vector<std::int16_t>{0, 1, 2}, test::kShort, "SCALAR");
    expectError(b, "meshes[0].primitives[0].indices", "unsigned scalars");
    b = triangle();
    primitive(b)["indices"] = b.floats({0, 1, 2}, "SCALAR");
    expectError(b, "meshes[0].primitives[0].indices", "unsigned scalars");
    b = triangle();
    primitive(b)["attributes"]["NORMAL"] = b.floats({0, 0, 1}, "VEC3");
    expectError(b, "attributes.", "beside");
    b = triangle();
    primitive(b)["attributes"]["COLOR_0"] = b.data(std::vector<std::uint8_t>(12, 1), test::kUnsignedByte, "VEC4");
    expectError(b, "attributes.COLOR_0", "type is not allowed");
    b = triangle();
    primitive(b)["targets"] = Json::array({{{"POSITION", b.floats({0, 0, 0}, "VEC3")}}});
    expectError(b, "targets[0].POSITION", "beside");
}

TEST(GltfErrors, ValuesInBuffers) {
    GltfBuilder b;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const int positions = b.floats({0, 0, 0, 1, 0, 0, 0, nan, 0}, "VEC3");
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", positions}}}})}});
    expectError(b, "meshes[0].primitives[0].attributes.POSITION", "not finite");
    b = triangle();
    primitive(b)["indices"] = b.data(std::vector<std::uint32_t>{0, 1, 3}, test::kUnsignedInt, "SCALAR");
    expectError(b, "meshes[0].primitives[0].indices", "index 3 is past the end of 3 vertices");
    b = triangle();
    const int indices = b.view(std::vector<std::uint8_t>{2, 1});
    const int values = b.view(std::vector<float>{3, 0, 0, 0, 4, 0});
    b.json["accessors"][0]["sparse"] = {{"count", 2},
                                        {"indices", {{"bufferView", indices}, {"componentType", test::kUnsignedByte}}},
                                        {"values", {{"bufferView", values}}}};
    expectError(b, "accessors[0].sparse.indices", "rise strictly");
    b.json["accessors"][0]["sparse"]["count"] = 3;
    expectError(b, "accessors[0].sparse", "past the end");
    b.json["accessors"][0]["sparse"]["count"] = 4;
    expectError(b, "accessors[0].sparse.count", "more sparse elements");
}

TEST(GltfErrors, NodesThatAreNoTrees) {
    GltfBuilder b = triangle();
    b.json["nodes"][0]["children"] = {0};
    expectError(b, "nodes", "cycle");
    b.json["nodes"][0]["children"] = {1};
    b.json["nodes"].push_back({{"children", {2}}});
    b.json["nodes"].push_back({{"children", {1}}});
    expectError(b, "nodes[2].children", "more than one parent");
    b.json["nodes"][2] = Json::object();
    b.json["scenes"][0]["nodes"] = {0, 2};
    expectError(b, "scenes[0].nodes", "no root");
    b = triangle();
    b.json["nodes"][0]["matrix"] = {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    expectError(b, "nodes[0].matrix", "affine");
}

TEST(GltfErrors, DeepTreesAreRefusedWithoutRecursion) {
    GltfBuilder b = triangle();
    b.json["nodes"][0] = {{"mesh", 0}, {"children", {1}}};
    for (int i = 1; i < 4000; ++i) b.json["nodes"].push_back({{"children", {i + 1}}});
    b.json["nodes"].push_back(Json::object());
    EXPECT_EQ(b.load().geometries.size(), 1U);
    for (int i = 4000; i < 5000; ++i) {
        b.json["nodes"].back() = {{"children", {i + 1}}};
        b.json["nodes"].push_back(Json::object());
    }
    expectError(b, "nodes[", "nested too deeply");
}

TEST(GltfErrors, HugeTransforms) {
    GltfBuilder b = triangle();
    b.json["nodes"][0]["scale"] = {1e200, 1e200, 1e200};
    b.node({{"children", {0}}, {"scale", {1e200, 1e200, 1e200}}});
    b.json["scenes"][0]["nodes"] = {1};
    expectError(b, "nodes[0]", "not finite");
}

TEST(GltfErrors, RequiredExtensions) {
    GltfBuilder b = triangle();
    b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    expectError(b, "extensionsRequired", "KHR_draco_mesh_compression");
}

TEST(GltfErrors, CamerasAndLights) {
    GltfBuilder b = triangle();
    b.json["cameras"] = Json::array({{{"type", "perspective"}}});
    expectError(b, "cameras[0]", "'perspective' is missing");
    b.json["cameras"][0]["perspective"] = {{"yfov", 4}, {"znear", 1}};
    expectError(b, "cameras[0].perspective.yfov", "out of range");
    b = triangle();
    b.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({{{"type", "spot"}}});
    expectError(b, "lights[0]", "'spot' is missing");
    b.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({{{"type", "sky"}}});
    expectError(b, "lights[0].type", "none of");
}

TEST(GltfErrors, SharedMalformedFiles) {
    const std::filesystem::path folder = std::filesystem::path(PELLUCID_SHARED_SCENES) / "malformed";
    if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no shared scenes";
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const auto extension = entry.path().extension();
        if (extension != ".gltf" && extension != ".glb") continue;
        ++files;
        try {
            const SceneDescription scene = loadGltf(entry.path());
            EXPECT_FALSE(scene.meshes.empty()) << entry.path();
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::BadInput) << entry.path();
        }
    }
    EXPECT_GT(files, 0);
}

TEST(GltfErrors, SharedGoodFiles) {
    const std::filesystem::path folder(PELLUCID_SHARED_SCENES);
    if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no shared scenes";
    for (const char* name : {"generated", "bitterli", "luxcore", "mitsuba-cbox"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / name))
            if (entry.path().extension() == ".glb") {
                EXPECT_NO_THROW((void)loadGltf(entry.path())) << entry.path();
            }
}

}  // namespace
}  // namespace pellucid

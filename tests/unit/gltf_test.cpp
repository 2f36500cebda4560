/// Geometry, nodes, cameras and lights of glTF files, each feature from a file built in memory.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include <pellucid/math/constants.h>

#include "../support/files.h"
#include "gltf_builder.h"

namespace pellucid {
namespace {

using test::GltfBuilder;
using test::Json;
using test::primitive;
using test::triangle;
using test::warns;

glm::dvec3 cornerInWorld(const SceneDescription& scene, std::size_t geometry, int corner, std::size_t face = 0) {
    const Geometry& g = scene.geometries.at(geometry);
    const Mesh& mesh = scene.meshes.at(g.mesh);
    return glm::dvec3(g.toWorld * glm::dvec4(mesh.positions.at(mesh.triangles.at(face)[corner]), 1.0));
}

glm::dvec3 faceNormal(const SceneDescription& scene, std::size_t geometry, std::size_t face = 0) {
    const glm::dvec3 a = cornerInWorld(scene, geometry, 0, face);
    return glm::normalize(
        glm::cross(cornerInWorld(scene, geometry, 1, face) - a, cornerInWorld(scene, geometry, 2, face) - a));
}

void expectVector(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance = 1e-6) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(actual[k], expected[k], tolerance) << "component " << k;
}

TEST(Gltf, LoadsOneTriangleWithDefaults) {
    const SceneDescription scene = triangle().load();
    EXPECT_EQ(scene.name, "test.glb");
    ASSERT_EQ(scene.meshes.size(), 1U);
    ASSERT_EQ(scene.geometries.size(), 1U);
    EXPECT_EQ(scene.meshes[0].positions.size(), 3U);
    EXPECT_TRUE(scene.meshes[0].normals.empty());
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].metallic, 1.0F);
    EXPECT_EQ(scene.contentHash.size(), 32U);
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_TRUE(scene.cameras.empty());
    expectVector(faceNormal(scene, 0), {0, 0, 1});
}

TEST(Gltf, HashDependsOnTheBytes) {
    GltfBuilder other = triangle();
    EXPECT_EQ(triangle().load().contentHash, other.load().contentHash);
    other.json["asset"]["generator"] = "x";
    EXPECT_NE(triangle().load().contentHash, other.load().contentHash);
}

template <class T>
void expectQuadByIndices(int componentType) {
    GltfBuilder b;
    const int positions = b.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 9, 9, 9}, "VEC3");
    const int indices = b.data(std::vector<T>{0, 1, 2, 0, 2, 3}, componentType, "SCALAR");
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}})}});
    const SceneDescription scene = b.load();
    ASSERT_EQ(scene.meshes.at(0).triangles.size(), 2U);
    EXPECT_EQ(scene.meshes[0].positions.size(), 4U) << "the vertex that no triangle uses is left out";
    expectVector(faceNormal(scene, 0, 1), {0, 0, 1});
}

TEST(Gltf, ReadsIndicesOfEveryWidth) {
    expectQuadByIndices<std::uint8_t>(test::kUnsignedByte);
    expectQuadByIndices<std::uint16_t>(test::kUnsignedShort);
    expectQuadByIndices<std::uint32_t>(test::kUnsignedInt);
}

TEST(Gltf, FewTrianglesOfALargeVertexBuffer) {
    GltfBuilder b;
    std::vector<float> values(3 * 1000);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>((i * i) % 97);
    const int positions = b.floats(values, "VEC3");
    const int indices = b.data(std::vector<std::uint16_t>{999, 5, 400, 400, 5, 17}, test::kUnsignedShort, "SCALAR");
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}})}});
    const SceneDescription scene = b.load();
    EXPECT_EQ(scene.meshes.at(0).positions.size(), 4U);
    const std::size_t expected[2][3] = {{999, 5, 400}, {400, 5, 17}};
    for (std::size_t face = 0; face < 2; ++face)
        for (int corner = 0; corner < 3; ++corner) {
            const std::size_t at = 3 * expected[face][corner];
            const double x = values[at], y = values[at + 1], z = values[at + 2];
            expectVector(cornerInWorld(scene, 0, corner, face), {x, y, z});
        }
}

TEST(Gltf, StripsAndFansKeepTheirWinding) {
    GltfBuilder strip;
    const int zigzag = strip.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, "VEC3");
    strip.node({{"mesh", strip.mesh({{"attributes", {{"POSITION", zigzag}}}, {"mode", 5}})}});
    GltfBuilder fan;
    const int corners = fan.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0}, "VEC3");
    fan.node({{"mesh", fan.mesh({{"attributes", {{"POSITION", corners}}}, {"mode", 6}})}});
    for (const SceneDescription& scene : {strip.load(), fan.load()}) {
        ASSERT_EQ(scene.meshes.at(0).triangles.size(), 3U);
        for (std::size_t face = 0; face < 3; ++face) expectVector(faceNormal(scene, 0, face), {0, 0, 1});
    }
}

TEST(Gltf, LeavesOutPointsAndLinesWithAWarning) {
    GltfBuilder b = triangle();
    Json line = primitive(b);
    line["mode"] = 1;
    b.json["meshes"][0]["primitives"].push_back(line);
    const SceneDescription scene = b.load();
    EXPECT_EQ(scene.geometries.size(), 1U);
    EXPECT_TRUE(warns(scene, "points and lines"));
}

TEST(Gltf, ATailThatIsNoTriangleIsLeftOut) {
    GltfBuilder b;
    const int positions = b.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5}, "VEC3");
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", positions}}}})}});
    const SceneDescription scene = b.load();
    EXPECT_EQ(scene.meshes[0].triangles.size(), 1U);
    EXPECT_TRUE(warns(scene, "not whole"));
}

TEST(Gltf, SparseAccessorsOverlayTheirBase) {
    GltfBuilder b = triangle();
    const int indices = b.view(std::vector<std::uint8_t>{1, 2});
    const int values = b.view(std::vector<float>{3, 0, 0, 0, 4, 0});
    b.json["accessors"][0]["sparse"] = {{"count", 2},
                                        {"indices", {{"bufferView", indices}, {"componentType", test::kUnsignedByte}}},
                                        {"values", {{"bufferView", values}}}};
    const SceneDescription scene = b.load();
    expectVector(cornerInWorld(scene, 0, 1), {3, 0, 0});
    expectVector(cornerInWorld(scene, 0, 2), {0, 4, 0});
}

TEST(Gltf, SparseAccessorsWithoutABaseOverlayZeros) {
    GltfBuilder b = triangle();
    const int indices = b.view(std::vector<std::uint16_t>{1, 2});
    const int values = b.view(std::vector<float>{3, 0, 0, 0, 4, 0});
    b.json["accessors"][0].erase("bufferView");
    b.json["accessors"][0]["sparse"] = {{"count", 2},
                                        {"indices", {{"bufferView", indices}, {"componentType", test::kUnsignedShort}}},
                                        {"values", {{"bufferView", values}}}};
    const SceneDescription scene = b.load();
    expectVector(cornerInWorld(scene, 0, 0), {0, 0, 0});
    expectVector(cornerInWorld(scene, 0, 2), {0, 4, 0});
}

TEST(Gltf, InterleavedAttributesHaveAStride) {
    GltfBuilder b;
    const int view = b.view(std::vector<float>{0, 0, 0, 0.1F, 0.2F, 1, 0, 0, 0.3F, 0.4F, 0, 1, 0, 0.5F, 0.6F}, 20);
    const int positions = b.accessor({{"bufferView", view}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 3}});
    const int uvs =
        b.accessor({{"bufferView", view}, {"byteOffset", 12}, {"componentType", 5126}, {"type", "VEC2"}, {"count", 3}});
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}}})}});
    const SceneDescription scene = b.load();
    expectVector(cornerInWorld(scene, 0, 2), {0, 1, 0});
    EXPECT_FLOAT_EQ(scene.meshes[0].uv0.at(2).y, 0.6F);
}

TEST(Gltf, NormalisedIntegersAndColoursOfThreeOrFour) {
    GltfBuilder b = triangle();
    Json& attributes = primitive(b)["attributes"];
    attributes["TEXCOORD_0"] =
        b.data(std::vector<std::uint8_t>{0, 255, 51, 0, 255, 102}, test::kUnsignedByte, "VEC2", true);
    attributes["TEXCOORD_1"] =
        b.data(std::vector<std::uint16_t>{0, 65535, 13107, 0, 65535, 0}, test::kUnsignedShort, "VEC2", true);
    attributes["COLOR_0"] = b.floats({1, 0.5F, 0, 2, -1, 0, 0, 0, 1}, "VEC3");
    const Mesh mesh = b.load().meshes.at(0);
    EXPECT_FLOAT_EQ(mesh.uv0[1].x, 0.2F);
    EXPECT_FLOAT_EQ(mesh.uv0[2].y, 0.4F);
    EXPECT_FLOAT_EQ(mesh.uv1[1].x, 0.2F);
    EXPECT_EQ(mesh.colors[0], glm::vec4(1, 0.5F, 0, 1));
    EXPECT_EQ(mesh.colors[1], glm::vec4(1, 0, 0, 1)) << "clamped";

    primitive(b)["attributes"]["COLOR_0"] = b.data(
        std::vector<std::uint16_t>{0, 0, 0, 65535, 65535, 0, 0, 0, 0, 0, 0, 13107}, test::kUnsignedShort, "VEC4", true);
    const Mesh other = b.load().meshes.at(0);
    EXPECT_FLOAT_EQ(other.colors[2].a, 0.2F);
    EXPECT_FLOAT_EQ(other.colors[1].r, 1.0F);
}

TEST(Gltf, QuantizedPositionsNeedTheirExtension) {
    GltfBuilder b;
    const int view = b.view(std::vector<std::int16_t>{0, 0, 0, 0, 32767, 0, 0, 0, 0, -32768, 0, 0}, 8);
    const int positions = b.accessor(
        {{"bufferView", view}, {"componentType", test::kShort}, {"type", "VEC3"}, {"count", 3}, {"normalized", true}});
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", positions}}}})}, {"scale", {2, 2, 2}}});
    test::expectError(b, "meshes[0].primitives[0].attributes.POSITION", "type is not allowed");
    b.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const SceneDescription scene = b.load();
    expectVector(cornerInWorld(scene, 0, 1), {2, 0, 0});
    expectVector(cornerInWorld(scene, 0, 2), {0, -2, 0});
    EXPECT_TRUE(scene.extensionsIgnored.empty());
}

TEST(Gltf, NormalsAreMadeUnitAndBadOnesMeanGeometric) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    GltfBuilder b = triangle();
    primitive(b)["attributes"]["NORMAL"] = b.floats({0, 0, 5, nan, 0, 1, 0, 0, 0}, "VEC3");
    const SceneDescription scene = b.load();
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(mesh.normals.at(0), glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[1], glm::vec3(0.0F));
    EXPECT_EQ(mesh.normals[2], glm::vec3(0.0F));
    EXPECT_TRUE(warns(scene, "2 of 3 normals"));

    primitive(b)["attributes"]["NORMAL"] = b.floats({0, 0, 0, nan, 0, 1, 0, 0, 0}, "VEC3");
    primitive(b)["attributes"]["TANGENT"] = b.floats({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
    const SceneDescription flat = b.load();
    EXPECT_TRUE(flat.meshes[0].normals.empty());
    EXPECT_TRUE(flat.meshes[0].tangents.empty()) << "without normals tangents mean nothing";
}

TEST(Gltf, TangentsKeepTheirHandedness) {
    GltfBuilder b = triangle();
    primitive(b)["attributes"]["NORMAL"] = b.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    primitive(b)["attributes"]["TANGENT"] = b.floats({2, 0, 0, -1, 1, 0, 0, 1, 0, 0, 0, 1}, "VEC4");
    const Mesh mesh = b.load().meshes.at(0);
    EXPECT_EQ(mesh.tangents.at(0), glm::vec4(1, 0, 0, -1));
    EXPECT_EQ(mesh.tangents.at(2), glm::vec4(0, 0, 0, 1));
}

TEST(Gltf, TransformsComposeDownTheTree) {
    GltfBuilder b = triangle();
    const double h = std::sqrt(0.5);
    b.json["nodes"][0] = {{"mesh", 0}, {"translation", {1, 0, 0}}, {"scale", {2, 2, 2}}};
    b.node({{"children", {0}}, {"rotation", {0, 0, h, h}}});  // a quarter turn about z
    b.json["scenes"][0]["nodes"] = {1};
    expectVector(cornerInWorld(b.load(), 0, 1), {0, 3, 0});

    b.json["nodes"][0] = {{"mesh", 0}, {"matrix", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 0, 0, 1}}};
    expectVector(cornerInWorld(b.load(), 0, 1), {0, 3, 0});
}

TEST(Gltf, AMeshUnderSeveralNodesIsShared) {
    GltfBuilder b = triangle();
    b.node({{"mesh", 0}, {"translation", {5, 0, 0}}});
    b.node({{"mesh", 0}, {"scale", {-1, 1, 1}}});
    b.node({{"mesh", 0}, {"scale", {1, -1, 1}}});
    const SceneDescription scene = b.load();
    EXPECT_EQ(scene.geometries.size(), 4U);
    EXPECT_EQ(scene.meshes.size(), 1U) << "a mirrored node is a placement like any other: Scene turns its front";
}

TEST(Gltf, FlattenedNodesAreBaked) {
    GltfBuilder b = triangle();
    b.json["nodes"][0]["scale"] = {2, 3, 0};
    b.json["nodes"][0]["translation"] = {0, 0, 7};
    const SceneDescription scene = b.load();
    EXPECT_EQ(scene.geometries.at(0).toWorld, glm::dmat4(1.0));
    expectVector(cornerInWorld(scene, 0, 1), {2, 0, 7});
    b.json["nodes"][0]["scale"] = {0, 0, 0};
    test::expectError(b, "test.glb", "no area");
}

TEST(Gltf, InstancesOfTheGpuExtension) {
    GltfBuilder b = triangle();
    const float h = std::sqrt(0.5F);
    const int translation = b.floats({0, 0, 0, 10, 0, 0}, "VEC3");
    const int rotation = b.floats({0, 0, 0, 1, 0, 0, h, h}, "VEC4");
    const int scale = b.floats({1, 1, 1, 3, 3, 3}, "VEC3");
    b.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    b.json["nodes"][0]["translation"] = {0, 100, 0};
    b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}};
    const SceneDescription scene = b.load();
    EXPECT_EQ(scene.meshes.size(), 1U);
    ASSERT_EQ(scene.geometries.size(), 2U);
    expectVector(cornerInWorld(scene, 0, 1), {1, 100, 0});
    expectVector(cornerInWorld(scene, 1, 1), {10, 103, 0}, 1e-5);
    EXPECT_TRUE(scene.extensionsIgnored.empty());
}

TEST(Gltf, TheDefaultSceneIsTakenElseTheFirst) {
    GltfBuilder b = triangle();
    b.json["nodes"].push_back({{"mesh", 0}, {"translation", {5, 0, 0}}});
    b.json["scenes"].push_back({{"nodes", {1}}});
    expectVector(cornerInWorld(b.load(), 0, 0), {0, 0, 0});
    b.json["scene"] = 1;
    const SceneDescription second = b.load();
    EXPECT_EQ(second.geometries.size(), 1U);
    expectVector(cornerInWorld(second, 0, 0), {5, 0, 0});
    b.json.erase("scene");
    b.json.erase("scenes");
    EXPECT_EQ(b.load().geometries.size(), 2U) << "without scenes all roots are shown";
}

TEST(Gltf, MorphTargetsByTheWeightsOfMeshOrNode) {
    GltfBuilder b = triangle();
    const int up = b.floats({0, 0, 2, 0, 0, 2, 0, 0, 2}, "VEC3");
    primitive(b)["targets"] = Json::array({{{"POSITION", up}}});
    expectVector(cornerInWorld(b.load(), 0, 0), {0, 0, 0});
    b.json["meshes"][0]["weights"] = {0.5};
    expectVector(cornerInWorld(b.load(), 0, 0), {0, 0, 1});
    b.node({{"mesh", 0}, {"weights", {1.0}}});
    const SceneDescription scene = b.load();
    EXPECT_EQ(scene.meshes.size(), 2U);
    expectVector(cornerInWorld(scene, 0, 0), {0, 0, 1});
    expectVector(cornerInWorld(scene, 1, 0), {0, 0, 2});
}

GltfBuilder skinnedTriangle() {
    GltfBuilder b = triangle();
    const int joints =
        b.data(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, test::kUnsignedByte, "VEC4");
    const int weights = b.floats({1, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0}, "VEC4");
    primitive(b)["attributes"]["JOINTS_0"] = joints;
    primitive(b)["attributes"]["WEIGHTS_0"] = weights;
    b.node({{"translation", {0, 0, 1}}});
    b.node({{"translation", {0, 0, 3}}});
    b.json["skins"] = Json::array({{{"joints", {1, 2}}}});
    b.json["nodes"][0] = {{"mesh", 0}, {"skin", 0}, {"translation", {50, 50, 50}}};
    return b;
}

TEST(Gltf, SkinsStandWhereTheirJointsAre) {
    GltfBuilder b = skinnedTriangle();
    const SceneDescription scene = b.load();
    EXPECT_EQ(scene.geometries.at(0).toWorld, glm::dmat4(1.0));
    expectVector(cornerInWorld(scene, 0, 0), {0, 0, 1});
    expectVector(cornerInWorld(scene, 0, 1), {1, 0, 3});
    expectVector(cornerInWorld(scene, 0, 2), {0, 1, 2});

    const int inverseBind = b.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1,  //
                                      1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -3, 1},
                                     "MAT4");
    b.json["skins"][0]["inverseBindMatrices"] = inverseBind;
    for (int corner = 0; corner < 3; ++corner) EXPECT_NEAR(cornerInWorld(b.load(), 0, corner).z, 0.0, 1e-6);
    b.json["skins"][0]["joints"] = {1};
    b.json["skins"][0].erase("inverseBindMatrices");
    test::expectError(b, "JOINTS_0", "past the end");
}

TEST(Gltf, DropsTrianglesWithoutArea) {
    GltfBuilder b;
    const int positions = b.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0}, "VEC3");
    const int indices = b.data(std::vector<std::uint8_t>{0, 1, 2, 0, 0, 2, 0, 1, 3}, test::kUnsignedByte, "SCALAR");
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}})}});
    const SceneDescription scene = b.load();
    EXPECT_EQ(scene.meshes.at(0).triangles.size(), 1U);
    EXPECT_EQ(scene.droppedTriangles, 2U) << "one repeats an index, one lies on a line";
}

TEST(Gltf, SmallTrianglesOfALargeSceneStay) {
    GltfBuilder b = triangle();
    b.node({{"mesh", 0}, {"scale", {1e-5, 1e-5, 1e-5}}});
    b.node({{"mesh", 0}, {"scale", {1e-3, 1e-3, 1e-3}}, {"translation", {1e3, 0, 0}}});
    EXPECT_EQ(b.load().geometries.size(), 3U);
}

TEST(Gltf, CamerasTakeTheirNodesPlace) {
    GltfBuilder b = triangle();
    b.json["cameras"] = Json::array(
        {{{"type", "perspective"}, {"name", "lens"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}},
         {{"type", "orthographic"}, {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0.1}, {"zfar", 9}}}}});
    b.node({{"camera", 0}, {"translation", {0, 0, 5}}});
    b.node({{"camera", 1}, {"name", "plan"}});
    const SceneDescription scene = b.load();
    ASSERT_EQ(scene.cameras.size(), 2U);
    EXPECT_EQ(scene.cameras[0].name, "lens");
    EXPECT_DOUBLE_EQ(scene.cameras[0].verticalFov, 0.5);
    EXPECT_DOUBLE_EQ(scene.cameras[0].aspect, 0.0);
    expectVector(glm::dvec3(scene.cameras[0].toWorld[3]), {0, 0, 5});
    EXPECT_EQ(scene.cameras[1].name, "plan");
    EXPECT_TRUE(scene.cameras[1].orthographic);
    EXPECT_DOUBLE_EQ(scene.cameras[1].xmag, 4.0);
    EXPECT_DOUBLE_EQ(scene.cameras[1].aspect, 2.0);
}

GltfBuilder withLight(const Json& light) {
    GltfBuilder b = triangle();
    b.json["extensionsUsed"] = {"KHR_lights_punctual"};
    b.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({light});
    const double h = std::sqrt(0.5);
    b.node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}},
            {"translation", {1, 2, 3}},
            {"scale", {5, 5, 5}},
            {"rotation", {-h, 0, 0, h}}});  // -z becomes -y
    return b;
}

TEST(Gltf, PunctualLightsPointAlongTheirNode) {
    const GltfBuilder b = withLight({{"type", "spot"},
                                     {"color", {1, 0.5, 0}},
                                     {"intensity", 4000000000U},
                                     {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.6}}}});
    const SceneDescription scene = b.load();
    ASSERT_EQ(scene.lights.size(), 1U);
    const PunctualLight& light = scene.lights[0];
    EXPECT_EQ(light.kind, PunctualKind::Spot);
    expectVector(light.position, {1, 2, 3});
    expectVector(light.direction, {0, -1, 0});
    EXPECT_FLOAT_EQ(light.intensity.r, 4e9F);
    EXPECT_FLOAT_EQ(light.intensity.g, 2e9F);
    EXPECT_DOUBLE_EQ(light.innerCone, 0.2);
    EXPECT_DOUBLE_EQ(light.outerCone, 0.6);
    EXPECT_EQ(withLight({{"type", "directional"}}).load().lights.at(0).kind, PunctualKind::Directional);
    EXPECT_EQ(withLight({{"type", "point"}}).load().lights.at(0).kind, PunctualKind::Point);
}

TEST(Gltf, ConesOutOfRangeAreClamped) {
    const SceneDescription scene =
        withLight({{"type", "spot"}, {"intensity", -3}, {"spot", {{"innerConeAngle", 3}, {"outerConeAngle", 2}}}})
            .load();
    const PunctualLight& light = scene.lights.at(0);
    EXPECT_LT(light.innerCone, light.outerCone);
    EXPECT_NEAR(light.outerCone, 0.5 * kPiD, 1e-12);
    EXPECT_EQ(light.intensity.r, 0.0F);
    EXPECT_TRUE(warns(scene, "cone angles"));
    EXPECT_TRUE(warns(scene, "intensity"));
}

TEST(Gltf, AnimationsAreNotedAndExtrasIgnored) {
    GltfBuilder b = triangle();
    b.json["animations"] = Json::array({{{"channels", 7}}});
    b.json["extras"] = {{"deep", {{"er", 1}}}};
    b.json["nodes"][0]["extras"] = "text";
    int notes = 0;
    (void)b.load([&notes](LogLevel level, std::string_view) { notes += level == LogLevel::Info ? 1 : 0; });
    EXPECT_EQ(notes, 1);
}

TEST(Gltf, Dispersion) {
    GltfBuilder b = triangle();
    b.json["extensionsRequired"] = b.json["extensionsUsed"] = {"KHR_materials_dispersion"};
    b.json["materials"] = {{{"extensions", {{"KHR_materials_dispersion", {{"dispersion", 0.5}}}}}},
                           {{"name", "plain"}}};
    const SceneDescription scene = b.load();
    EXPECT_EQ(scene.materials[0].dispersion, 0.5F);
    EXPECT_EQ(scene.materials[1].dispersion, 0.0F);
    EXPECT_TRUE(scene.warnings.empty());
    b.json["materials"][0]["extensions"]["KHR_materials_dispersion"]["dispersion"] = -1.0;
    const SceneDescription clamped = b.load();
    EXPECT_EQ(clamped.materials[0].dispersion, 0.0F);
    EXPECT_EQ(clamped.warnings.size(), 1U);
}

TEST(Gltf, UnknownExtensionsAreNamedOnce) {
    GltfBuilder b = triangle();
    b.json["extensionsUsed"] = {"EXT_unheard_of", "EXT_unheard_of", "KHR_materials_ior"};
    b.json["nodes"][0]["extensions"]["EXT_unheard_of"] = {{"a", 1}};
    b.json["nodes"][0]["extensions"]["EXT_undeclared"] = {{"a", 1}};
    const SceneDescription scene = b.load();
    EXPECT_EQ(scene.extensionsIgnored, (std::vector<std::string>{"EXT_undeclared", "EXT_unheard_of"}));
    EXPECT_EQ(scene.warnings.size(), 2U);
}

class GltfFiles : public testing::Test {
protected:
    GltfFiles() { std::filesystem::create_directories(folder / "sub"); }

    void write(const std::filesystem::path& name, std::span<const std::byte> bytes) const {
        std::ofstream(folder / name, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    /// The triangle with its buffer in a file that `uri` names.
    void writeScene(const std::string& uri, std::size_t byteLength = 36) const {
        GltfBuilder b = triangle();
        b.json["buffers"] = Json::array({{{"byteLength", byteLength}, {"uri", uri}}});
        const std::string text = b.json.dump();
        write("scene.gltf", std::as_bytes(std::span(text)));
    }
    void expectFileError(const std::string& problem) const {
        try {
            (void)loadGltf(folder / "scene.gltf");
            ADD_FAILURE() << "loaded, but should say: " << problem;
        } catch (const Error& e) {
            EXPECT_NE(e.problem().find(problem), std::string::npos) << e.what();
            EXPECT_NE(e.where().find("buffers[0]"), std::string::npos) << e.what();
        }
    }
    test::TemporaryFolder folder;
    std::vector<std::byte> data = triangle().binary;
};

TEST_F(GltfFiles, ReadsBuffersBesideTheScene) {
    write("a b.bin", data);
    write("sub/ü+%.bin", data);
    writeScene("a%20b.bin");
    const std::string hash = loadGltf(folder / "scene.gltf").contentHash;
    writeScene("a b.bin");
    EXPECT_EQ(loadGltf(folder / "scene.gltf").name, "scene.gltf");
    writeScene("sub/../sub/%C3%BC+%25.bin");
    EXPECT_EQ(loadGltf(folder / "scene.gltf").meshes.size(), 1U);
    writeScene("sub/ü+%25.bin");
    EXPECT_EQ(loadGltf(folder / "scene.gltf").meshes.size(), 1U);

    writeScene("a%20b.bin");
    data.back() = std::byte{64};  // the hash covers what the scene refers to
    write("a b.bin", data);
    EXPECT_NE(loadGltf(folder / "scene.gltf").contentHash, hash);
}

TEST_F(GltfFiles, RefusesPathsOutOfTheFolder) {
    write("../pellucid_gltf_outside.bin", data);
    for (const char* uri : {"../pellucid_gltf_outside.bin", "sub/../../pellucid_gltf_outside.bin", "%2e%2e/x.bin",
                            "..%5Cx.bin", "/etc/hostname", "file:///etc/hostname", "http://example.com/x.bin",
                            "C:\\x.bin", "%2Fetc/hostname", "a%00b", "%zz"}) {
        writeScene(uri);
        expectFileError("no relative path");
    }
    std::filesystem::remove(folder / "../pellucid_gltf_outside.bin");
}

TEST_F(GltfFiles, SaysWhichFileIsMissingOrShort) {
    writeScene("gone.bin");
    expectFileError("file not found");
    writeScene("sub");
    expectFileError("not a regular file");
    write("short.bin", std::span(data).first(20));
    writeScene("short.bin");
    expectFileError("claims 36 bytes and has 20");
    writeScene("data:application/octet-stream;base64,AAAA");
    expectFileError("claims 36 bytes and has 3");
    writeScene("data:application/octet-stream;base64,AA?A");
    expectFileError("malformed");
    EXPECT_THROW((void)loadGltf(folder / "no.gltf"), Error);
    EXPECT_THROW((void)loadGltf(folder.path()), Error);
}

TEST_F(GltfFiles, ReadsBase64) {
    writeScene(
        "data:application/octet-stream;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA");
    const SceneDescription scene = loadGltf(folder / "scene.gltf");
    expectVector(cornerInWorld(scene, 0, 1), {1, 0, 0});
    expectVector(cornerInWorld(scene, 0, 2), {0, 1, 0});
}

}  // namespace
}  // namespace pellucid

/// The hash that decides whether learnt light fits a scene: blind to cameras, names and the way the nodes hang together, not to
/// anything that sheds, takes or bends light.
#include <string>

#include <gtest/gtest.h>

#include <pellucid/scene/scene.h>

#include "gltf_builder.h"

namespace pellucid {
namespace {

using namespace test;

/// A triangle that shines, with a camera on a node of its own.
[[nodiscard]] GltfBuilder seen() {
    GltfBuilder b = triangle();
    b.json["materials"] = Json::array({{{"emissiveFactor", {1, 1, 1}}}});
    primitive(b)["material"] = 0;
    b.json["cameras"] = Json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"znear", 0.1}}}}});
    b.node({{"camera", 0}, {"translation", {0, 0, 3}}});
    return b;
}

[[nodiscard]] Scene sceneOf(const GltfBuilder& b, const std::optional<EnvironmentDescription>& sky = std::nullopt) {
    return Scene(b.load(), sky, SceneOptions{}, Workers(1));
}

TEST(LightHash, IsBlindToCamerasAndNames) {
    const std::string hash = sceneOf(seen()).lightHash();
    EXPECT_EQ(hash.size(), 32U);
    GltfBuilder b = seen();
    b.json["nodes"][1]["translation"] = {0.5, 0, 2};
    EXPECT_EQ(sceneOf(b).lightHash(), hash) << "a moved camera";
    EXPECT_NE(sceneOf(b).hash(), sceneOf(seen()).hash()) << "which a checkpoint must tell apart";
    b.json["cameras"][0]["perspective"]["yfov"] = 0.9;
    b.json["materials"][0]["name"] = "shining";
    EXPECT_EQ(sceneOf(b).lightHash(), hash) << "another view and a name";
    b.json["cameras"].clear();
    b.json.erase("cameras");
    b.json["nodes"][1].erase("camera");
    EXPECT_EQ(sceneOf(b).lightHash(), hash) << "an empty node";
    b = seen();
    b.json["nodes"].push_back({{"children", {1}}, {"translation", {7, 0, 0}}});
    b.json["scenes"][0]["nodes"] = {0, 2};
    EXPECT_EQ(sceneOf(b).lightHash(), hash) << "a camera that hangs on another node";
}

TEST(LightHash, SeesWhatMakesLight) {
    const std::string hash = sceneOf(seen()).lightHash();
    GltfBuilder b = seen();
    b.json["materials"][0]["emissiveFactor"] = {1, 1, 0.9};
    EXPECT_NE(sceneOf(b).lightHash(), hash) << "a lamp";
    b = seen();
    b.json["materials"][0]["pbrMetallicRoughness"] = {{"roughnessFactor", 0.5}};
    EXPECT_NE(sceneOf(b).lightHash(), hash) << "a material";
    b = seen();
    b.json["nodes"][0]["scale"] = {1, 1.5, 1};
    EXPECT_NE(sceneOf(b).lightHash(), hash) << "geometry";
    b = seen();
    b.json["nodes"][0]["translation"] = {0, 0, 1};
    EXPECT_NE(sceneOf(b).lightHash(), hash) << "its place: the records' coordinates are from the scene's centre";
    b = seen();
    b.json["extensionsUsed"] = {"KHR_lights_punctual"};
    b.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({{{"type", "point"}}});
    b.node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"translation", {0, 1, 1}}});
    const std::string lit = sceneOf(b).lightHash();
    EXPECT_NE(lit, hash) << "a light";
    b.json["nodes"][2]["translation"] = {0, 1, 2};
    EXPECT_NE(sceneOf(b).lightHash(), lit) << "a moved light";
    EnvironmentDescription sky;
    sky.constant = Rgb(1.0F);
    sky.contentHash = "grey";
    EXPECT_NE(sceneOf(seen(), sky).lightHash(), hash) << "the sky";
}

}  // namespace
}  // namespace pellucid

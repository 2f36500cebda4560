/// A node that mirrors (negative scale) must show the mirror image of its mesh: from the file to the scene its faces turn
/// over exactly once, and so do their bitangents. Everything is compared with the same image worked out by hand.
#include <array>
#include <memory>

#include <gtest/gtest.h>

#include <pellucid/scene/scene.h>

#include "gltf_builder.h"

namespace pellucid {
namespace {

using test::GltfBuilder;
using test::Json;
using test::primitive;

/// A square in the plane z = 0 that shines towards +z, u along +x, v along -y as in an image; its normals lean.
GltfBuilder lamp(bool tangents) {
    GltfBuilder b;
    Json attributes = {{"POSITION", b.floats({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3")},
                       {"NORMAL", b.floats({0.6F, 0, 0.8F, 0.6F, 0, 0.8F, 0.6F, 0, 0.8F, 0.6F, 0, 0.8F}, "VEC3")},
                       {"TEXCOORD_0", b.floats({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2")}};
    if (tangents) {
        std::vector<float> values;
        for (int i = 0; i < 4; ++i) values.insert(values.end(), {0.8F, 0, -0.6F, 1});
        attributes["TANGENT"] = b.floats(values, "VEC4");
    }
    const int indices = b.data(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, test::kUnsignedShort, "SCALAR");
    b.json["materials"] = Json::array({{{"emissiveFactor", {1, 0.5, 0.25}},
                                        {"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                                        {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}}});
    b.json["extensionsUsed"] = {"KHR_materials_specular"};
    b.node({{"mesh", b.mesh({{"attributes", attributes}, {"indices", indices}, {"material", 0}})}});
    return b;
}

/// A normal map of one colour: 0.28 of the way along the tangent, 0.96 / 2 along the bitangent, the rest along z.
std::shared_ptr<const TextureImage> leaningNormals() {
    auto image = std::make_shared<TextureImage>();
    image->width = image->height = 1;
    image->texels8 = {glm::u8vec4(163, 189, 234, 255)};  // (0.28, 0.48, 0.83) to the last of its 8 bits
    return image;
}

std::unique_ptr<Scene> sceneOf(const GltfBuilder& b) {
    SceneDescription description = b.load();
    for (Material& m : description.materials) m.normalTexture.image = leaningNormals();
    return std::make_unique<Scene>(std::move(description), std::nullopt, SceneOptions{}, Workers(1));
}

/// What a viewer straight before (side 1) or behind (side -1) the middle of the left half sees.
struct View {
    Rgb emitted{0.0F};
    glm::vec3 geometricNormal{0.0F}, shadingNormal{0.0F};
    bool back = false;
};
View look(const Scene& scene, float side) {
    const auto hit = scene.intersect({glm::vec3(-0.2F, 0.1F, side), glm::vec3(0, 0, -side)}, 0.5F);
    EXPECT_TRUE(hit);
    if (!hit) return {};
    const glm::vec3 wo(0, 0, side);
    const Bsdf bsdf = scene.surfaces().bsdf(hit->point, wo);
    return {scene.surfaces().emittedRadiance(hit->point, wo), hit->point.geometricNormal, bsdf.shadingNormal(),
            bsdf.backSide()};
}

void expectNear(const glm::vec3& actual, const glm::vec3& expected, const char* what) {
    for (glm::length_t k = 0; k < 3; ++k) EXPECT_NEAR(actual[k], expected[k], 2e-2) << what << ", component " << k;
}

/// The mapped normal of the unmoved lamp: texel x tangent + texel y bitangent + texel z normal, where t, b, n are
/// (0.8, 0, -0.6), (0, 1, 0), (0.6, 0, 0.8).
const glm::vec3 kMapped =
    glm::normalize(0.28F * glm::vec3(0.8F, 0, -0.6F) + 0.48F * glm::vec3(0, 1, 0) + 0.83F * glm::vec3(0.6F, 0, 0.8F));

/// `mirror`: the scale of the node; `front`: the side that the lamp shines to after it.
void expectMirrorImage(GltfBuilder b, const glm::vec3& mirror, float front) {
    b.json["nodes"][0]["scale"] = {mirror.x, mirror.y, mirror.z};
    const auto scene = sceneOf(b);
    const View seen = look(*scene, front), behind = look(*scene, -front);
    EXPECT_EQ(seen.emitted, Rgb(1, 0.5F, 0.25F));
    EXPECT_EQ(behind.emitted, Rgb(0.0F)) << "the lamp shines from one side";
    EXPECT_FALSE(seen.back);
    EXPECT_TRUE(behind.back);
    expectNear(seen.geometricNormal, {0, 0, front}, "geometric normal");
    expectNear(seen.shadingNormal, kMapped * mirror, "mapped normal");
    // The light list must think the same of the front.
    const glm::vec3 before(0, 0, front), after(0, 0, -front);
    EXPECT_TRUE(scene->lights().sample(before, glm::vec3(0.0F), 0.5F, {0.4F, 0.3F}));
    EXPECT_FALSE(scene->lights().sample(after, glm::vec3(0.0F), 0.5F, {0.4F, 0.3F}));
}

TEST(MirroredNodes, ShowTheMirrorImageWithTangents) {
    expectMirrorImage(lamp(true), {1, 1, 1}, 1);
    expectMirrorImage(lamp(true), {-1, 1, 1}, 1);
    expectMirrorImage(lamp(true), {1, -1, 1}, 1);
    expectMirrorImage(lamp(true), {1, 1, -1}, -1);
    expectMirrorImage(lamp(true), {-1, -1, 1}, 1);
    expectMirrorImage(lamp(true), {-1, -1, -1}, -1);
}

TEST(MirroredNodes, ShowTheMirrorImageWithTangentsFromUv) {
    expectMirrorImage(lamp(false), {1, 1, 1}, 1);
    expectMirrorImage(lamp(false), {-1, 1, 1}, 1);
    expectMirrorImage(lamp(false), {1, -1, 1}, 1);
    expectMirrorImage(lamp(false), {1, 1, -1}, -1);
}

TEST(MirroredNodes, AsInstances) {
    GltfBuilder b = lamp(true);
    const int scale = b.floats({-1, 1, 1}, "VEC3");
    b.json["extensionsUsed"].push_back("EXT_mesh_gpu_instancing");
    b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"SCALE", scale}};
    const View seen = look(*sceneOf(b), 1);
    EXPECT_EQ(seen.emitted, Rgb(1, 0.5F, 0.25F));
    expectNear(seen.shadingNormal, kMapped * glm::vec3(-1, 1, 1), "mapped normal");
}

/// A skin places its mesh by its joints alone, and one of them may mirror.
TEST(MirroredNodes, AsSkins) {
    GltfBuilder b = lamp(true);
    primitive(b)["attributes"]["JOINTS_0"] = b.data(std::vector<std::uint8_t>(16, 0), test::kUnsignedByte, "VEC4");
    std::vector<float> weights;
    for (int i = 0; i < 4; ++i) weights.insert(weights.end(), {1, 0, 0, 0});
    primitive(b)["attributes"]["WEIGHTS_0"] = b.floats(weights, "VEC4");
    const int joint = b.node({{"scale", {-1, 1, 1}}});
    b.json["skins"] = Json::array({{{"joints", {joint}}}});
    b.json["nodes"][0]["skin"] = 0;
    const View seen = look(*sceneOf(b), 1);
    EXPECT_EQ(seen.emitted, Rgb(1, 0.5F, 0.25F));
    expectNear(seen.shadingNormal, kMapped * glm::vec3(-1, 1, 1), "mapped normal");
}

}  // namespace
}  // namespace pellucid

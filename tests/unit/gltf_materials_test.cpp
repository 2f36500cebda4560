/// Materials and textures of glTF files.
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include <pellucid/io/image_file.h>

#include "../support/files.h"
#include "gltf_builder.h"

namespace pellucid {
namespace {

using test::expectError;
using test::GltfBuilder;
using test::Json;
using test::primitive;
using test::triangle;
using test::warns;

GltfBuilder withMaterial(Json material) {
    GltfBuilder b = triangle();
    b.json["materials"] = Json::array({std::move(material)});
    primitive(b)["material"] = 0;
    return b;
}

TEST(GltfMaterials, DefaultsAreTheSpecifications) {
    const Material m = withMaterial(Json::object()).load().materials.at(0);
    EXPECT_EQ(m.baseColor, glm::vec4(1.0F));
    EXPECT_EQ(m.metallic, 1.0F);
    EXPECT_EQ(m.roughness, 1.0F);
    EXPECT_TRUE(isBlack(m.emission));
    EXPECT_EQ(m.alphaMode, AlphaMode::Opaque);
    EXPECT_EQ(m.alphaCutoff, 0.5F);
    EXPECT_FALSE(m.doubleSided);
    EXPECT_EQ(m.ior, 1.5F);
    EXPECT_EQ(m.specular, 1.0F);
    EXPECT_EQ(m.transmission, 0.0F);
    EXPECT_EQ(m.thickness, 0.0F);
    EXPECT_TRUE(isBlack(m.absorption));
}

TEST(GltfMaterials, FactorsAndExtensions) {
    const SceneDescription scene =
        withMaterial({{"name", "all"},
                      {"pbrMetallicRoughness",
                       {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.25}}},
                      {"emissiveFactor", {1, 0.5, 0}},
                      {"alphaMode", "MASK"},
                      {"alphaCutoff", 0.75},
                      {"doubleSided", true},
                      {"extensions",
                       {{"KHR_materials_transmission", {{"transmissionFactor", 0.9}}},
                        {"KHR_materials_ior", {{"ior", 1.33}}},
                        {"KHR_materials_specular", {{"specularFactor", 0}, {"specularColorFactor", {2, 1, 0}}}},
                        {"KHR_materials_emissive_strength", {{"emissiveStrength", 5000000000U}}},
                        {"KHR_materials_volume",
                         {{"thicknessFactor", 1}, {"attenuationDistance", 0.5}, {"attenuationColor", {0.5, 1, 0}}}}}}})
            .load();
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.name, "all");
    EXPECT_EQ(m.baseColor, glm::vec4(0.1F, 0.2F, 0.3F, 0.4F));
    EXPECT_EQ(m.metallic, 0.5F);
    EXPECT_EQ(m.roughness, 0.25F);
    EXPECT_FLOAT_EQ(m.emission.r, 5e9F);
    EXPECT_FLOAT_EQ(m.emission.g, 2.5e9F);
    EXPECT_EQ(m.alphaMode, AlphaMode::Mask);
    EXPECT_EQ(m.alphaCutoff, 0.75F);
    EXPECT_TRUE(m.doubleSided);
    EXPECT_FLOAT_EQ(m.transmission, 0.9F);
    EXPECT_FLOAT_EQ(m.ior, 1.33F);
    EXPECT_EQ(m.specular, 0.0F);
    EXPECT_EQ(m.specularColor, Rgb(2, 1, 0));
    EXPECT_EQ(m.thickness, 1.0F);
    EXPECT_NEAR(m.absorption.r, 2.0 * std::log(2.0), 1e-6) << "Beer's law: exp(-a 0.5) = 0.5";
    EXPECT_EQ(m.absorption.g, 0.0F);
    EXPECT_NEAR(m.absorption.b, -std::log(1e-6) / 0.5, 1e-4) << "black is clamped";
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfMaterials, InfiniteAttenuationDistanceAbsorbsNothing) {
    const Material m =
        withMaterial({{"extensions",
                       {{"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationColor", {0.5, 0.5, 0.5}}}}}}})
            .load()
            .materials.at(0);
    EXPECT_TRUE(isBlack(m.absorption));
}

TEST(GltfMaterials, FactorsOutOfRangeAreClampedWithAWarning) {
    const SceneDescription scene =
        withMaterial({{"pbrMetallicRoughness", {{"baseColorFactor", {2, -1, 0, 1}}, {"roughnessFactor", 3}}},
                      {"emissiveFactor", {4, -2, 0}},
                      {"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}})
            .load();
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.baseColor, glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(m.roughness, 1.0F);
    EXPECT_EQ(m.ior, 1.0F);
    EXPECT_EQ(m.emission, Rgb(4, 0, 0)) << "radiance above 1 means what it says";
    for (const char* name : {"baseColorFactor", "roughnessFactor", "ior", "emissiveFactor"})
        EXPECT_TRUE(warns(scene, name));
    GltfBuilder b = withMaterial(Json::object());
    std::string text = b.json.dump();
    text.insert(text.find("\"materials\":[{") + 14, "\"alphaCutoff\":1e999");
    const auto bytes = std::as_bytes(std::span(text));
    expectError({bytes.begin(), bytes.end()}, "a.gltf", "overflow", "a.gltf");
}

TEST(GltfMaterials, IorZeroStaysZero) {
    const Material m = withMaterial({{"extensions", {{"KHR_materials_ior", {{"ior", 0}}}}}}).load().materials.at(0);
    EXPECT_EQ(m.ior, 0.0F);
}

TEST(GltfMaterials, UnlitIsLitWithAWarning) {
    GltfBuilder b = withMaterial({{"extensions", {{"KHR_materials_unlit", Json::object()}}}});
    b.json["extensionsRequired"] = {"KHR_materials_unlit"};
    const SceneDescription scene = b.load();
    EXPECT_TRUE(warns(scene, "unlit"));
    EXPECT_EQ(scene.extensionsIgnored, std::vector<std::string>{"KHR_materials_unlit"});
}

TEST(GltfMaterials, PrimitivesWithoutMaterialGetTheDefault) {
    GltfBuilder b = withMaterial({{"name", "first"}});
    Json second = primitive(b);
    second.erase("material");
    b.json["meshes"][0]["primitives"].push_back(second);
    const SceneDescription scene = b.load();
    ASSERT_EQ(scene.materials.size(), 2U);
    EXPECT_EQ(scene.materials[1].name, "default");
    EXPECT_EQ(scene.meshes.at(0).material, 0U);
    EXPECT_EQ(scene.meshes.at(1).material, 1U);
}

/// A picture of 2 x 1 pixels, red and green, as the bytes of a PNG.
std::vector<std::byte> smallPng() {
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder / "small.png";
    Image image(2, 1, {"R", "G", "B"});
    image.setRgb(0, {1, 0, 0});
    image.setRgb(1, {0, 1, 0});
    writePng(file, image, 0.0F);
    const std::string text = test::bytesOf(file);
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

GltfBuilder withTexture(const Json& info, const Json& sampler) {
    GltfBuilder b =
        withMaterial({{"pbrMetallicRoughness", {{"baseColorTexture", info}, {"metallicRoughnessTexture", info}}}});
    b.json["images"] = Json::array({{{"bufferView", b.view(smallPng())}, {"mimeType", "image/png"}}});
    b.json["samplers"] = Json::array({sampler});
    b.json["textures"] = Json::array({{{"source", 0}, {"sampler", 0}}});
    return b;
}

TEST(GltfMaterials, TexturesWithSamplersAndTransforms) {
    const Json transform = {{"offset", {0.25, 0.5}}, {"scale", {2, 3}}, {"rotation", 1.5}, {"texCoord", 1}};
    const SceneDescription scene = withTexture({{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}},
                                               {{"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}})
                                       .load();
    const TextureRef& base = scene.materials.at(0).baseColorTexture;
    ASSERT_TRUE(base);
    EXPECT_TRUE(base.srgb);
    EXPECT_FALSE(base.linear);
    EXPECT_EQ(base.wrapS, Wrap::Clamp);
    EXPECT_EQ(base.wrapT, Wrap::Mirror);
    EXPECT_EQ(base.uvSet, 1) << "the transform's set overrides the texture's";
    EXPECT_EQ(base.offset, glm::vec2(0.25F, 0.5F));
    EXPECT_EQ(base.scale, glm::vec2(2, 3));
    EXPECT_EQ(base.rotation, 1.5F);
    ASSERT_EQ(base.image->width, 2);
    EXPECT_EQ(base.image->texels8.at(1), glm::u8vec4(0, 255, 0, 255));
    const TextureRef& other = scene.materials[0].metallicRoughnessTexture;
    EXPECT_FALSE(other.srgb);
    EXPECT_EQ(other.image, base.image) << "decoded once";
}

TEST(GltfMaterials, TexturesThatCannotBe) {
    GltfBuilder b = withTexture({{"index", 0}}, Json::object());
    EXPECT_TRUE(b.load().materials[0].baseColorTexture);
    b.binary[b.json["bufferViews"].back()["byteOffset"].get<std::size_t>() + 30] ^= std::byte{255};
    b.binary[b.json["bufferViews"].back()["byteOffset"].get<std::size_t>() + 45] ^= std::byte{255};
    expectError(b, "images[0]", "does not decode");
    b.json["images"][0] = {{"uri", "data:image/png;base64,AAAA"}};
    expectError(b, "images[0]", "no known format");
    b.json["images"][0] = Json::object();
    expectError(b, "images[0]", "either a uri or a buffer view");
    b.json["images"][0] = {{"uri", "../x.png"}};
    expectError(b, "images[0].uri", "file in memory");
    primitive(b).erase("material");
    EXPECT_EQ(b.load().materials.size(), 2U) << "textures of materials that nothing shows are not read";

    GltfBuilder third = withTexture({{"index", 0}, {"texCoord", 2}}, Json::object());
    const SceneDescription scene = third.load();
    EXPECT_FALSE(scene.materials[0].baseColorTexture);
    EXPECT_TRUE(warns(scene, "past set 1"));
    third.json["textures"][0].erase("source");
    EXPECT_TRUE(warns(third.load(), "no image"));
}

}  // namespace
}  // namespace pellucid

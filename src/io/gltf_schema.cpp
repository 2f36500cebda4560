#include "gltf_schema.h"

#include <algorithm>
#include <array>

namespace pellucid {
namespace {

using enum RuleKind;

constexpr double kIntMax = 2147483647.0;  // tinygltf keeps some sizes in an int
constexpr const char* kAccessors = "/accessors";
constexpr const char* kBufferViews = "/bufferViews";
constexpr const char* kTextures = "/textures";
constexpr const char* kWraps = "33071|33648|10497";

// clang-format off
constexpr Rule kAsset[] = {
    {.key = "version", .kind = String, .required = true},
    {.key = "minVersion", .kind = String},
};
constexpr Rule kBuffer[] = {
    {.key = "uri", .kind = String},
    {.key = "byteLength", .kind = Integer, .required = true, .low = 1},
};
constexpr Rule kBufferView[] = {
    {.key = "buffer", .kind = Reference, .required = true, .target = "/buffers"},
    {.key = "byteOffset", .kind = Integer},
    {.key = "byteLength", .kind = Integer, .required = true, .low = 1},
    {.key = "byteStride", .kind = Integer, .low = 4, .high = 252},
    {.key = "target", .kind = Integer},
};
constexpr Rule kSparseIndices[] = {
    {.key = "bufferView", .kind = Reference, .required = true, .target = kBufferViews},
    {.key = "byteOffset", .kind = Integer, .high = kIntMax},
    {.key = "componentType", .kind = Integer, .required = true, .target = "5121|5123|5125"},
};
constexpr Rule kSparseValues[] = {
    {.key = "bufferView", .kind = Reference, .required = true, .target = kBufferViews},
    {.key = "byteOffset", .kind = Integer, .high = kIntMax},
};
constexpr Rule kSparse[] = {
    {.key = "count", .kind = Integer, .required = true, .low = 1, .high = kIntMax},
    {.key = "indices", .kind = Object, .required = true, .members = kSparseIndices},
    {.key = "values", .kind = Object, .required = true, .members = kSparseValues},
};
constexpr Rule kAccessor[] = {
    {.key = "bufferView", .kind = Reference, .target = kBufferViews},
    {.key = "byteOffset", .kind = Integer},
    {.key = "componentType", .kind = Integer, .required = true, .target = "5120|5121|5122|5123|5125|5126"},
    {.key = "normalized", .kind = Boolean},
    {.key = "count", .kind = Integer, .required = true, .low = 1},
    {.key = "type", .kind = String, .required = true, .target = "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4"},
    {.key = "min", .kind = Numbers},
    {.key = "max", .kind = Numbers},
    {.key = "sparse", .kind = Object, .members = kSparse},
};

constexpr Rule kImage[] = {
    {.key = "uri", .kind = String},
    {.key = "mimeType", .kind = String},
    {.key = "bufferView", .kind = Reference, .target = kBufferViews},
};
constexpr Rule kSampler[] = {
    {.key = "magFilter", .kind = Integer, .target = "9728|9729"},
    {.key = "minFilter", .kind = Integer, .target = "9728|9729|9984|9985|9986|9987"},
    {.key = "wrapS", .kind = Integer, .target = kWraps},
    {.key = "wrapT", .kind = Integer, .target = kWraps},
};
constexpr Rule kWebp[] = {{.key = "source", .kind = Reference, .required = true, .target = "/images"}};
constexpr Rule kTextureExtensions[] = {{.key = "EXT_texture_webp", .kind = Object, .members = kWebp}};
constexpr Rule kTexture[] = {
    {.key = "sampler", .kind = Reference, .target = "/samplers"},
    {.key = "source", .kind = Reference, .target = "/images"},
    {.key = "extensions", .kind = Object, .members = kTextureExtensions},
};

constexpr Rule kTransform[] = {
    {.key = "offset", .kind = Numbers, .low = 2, .high = 2},
    {.key = "scale", .kind = Numbers, .low = 2, .high = 2},
    {.key = "rotation", .kind = Number},
    {.key = "texCoord", .kind = Integer, .high = kIntMax},
};
constexpr Rule kTextureInfoExtensions[] = {{.key = "KHR_texture_transform", .kind = Object, .members = kTransform}};
constexpr Rule kTextureInfo[] = {
    {.key = "index", .kind = Reference, .required = true, .target = kTextures},
    {.key = "texCoord", .kind = Integer, .high = kIntMax},
    {.key = "scale", .kind = Number},     // of normal textures
    {.key = "strength", .kind = Number},  // of occlusion textures
    {.key = "extensions", .kind = Object, .members = kTextureInfoExtensions},
};
constexpr Rule kMetallicRoughness[] = {
    {.key = "baseColorFactor", .kind = Numbers, .low = 4, .high = 4},
    {.key = "baseColorTexture", .kind = Object, .members = kTextureInfo},
    {.key = "metallicFactor", .kind = Number},
    {.key = "roughnessFactor", .kind = Number},
    {.key = "metallicRoughnessTexture", .kind = Object, .members = kTextureInfo},
};
constexpr Rule kTransmission[] = {
    {.key = "transmissionFactor", .kind = Number},
    {.key = "transmissionTexture", .kind = Object, .members = kTextureInfo},
};
constexpr Rule kIor[] = {{.key = "ior", .kind = Number}};
constexpr Rule kDispersion[] = {{.key = "dispersion", .kind = Number}};
constexpr Rule kVolume[] = {
    {.key = "thicknessFactor", .kind = Number},
    {.key = "thicknessTexture", .kind = Object, .members = kTextureInfo},
    {.key = "attenuationDistance", .kind = Number},
    {.key = "attenuationColor", .kind = Numbers, .low = 3, .high = 3},
};
constexpr Rule kSpecular[] = {
    {.key = "specularFactor", .kind = Number},
    {.key = "specularTexture", .kind = Object, .members = kTextureInfo},
    {.key = "specularColorFactor", .kind = Numbers, .low = 3, .high = 3},
    {.key = "specularColorTexture", .kind = Object, .members = kTextureInfo},
};
constexpr Rule kEmissiveStrength[] = {{.key = "emissiveStrength", .kind = Number}};
constexpr Rule kMaterialExtensions[] = {
    {.key = "KHR_materials_transmission", .kind = Object, .members = kTransmission},
    {.key = "KHR_materials_ior", .kind = Object, .members = kIor},
    {.key = "KHR_materials_dispersion", .kind = Object, .members = kDispersion},
    {.key = "KHR_materials_volume", .kind = Object, .members = kVolume},
    {.key = "KHR_materials_specular", .kind = Object, .members = kSpecular},
    {.key = "KHR_materials_emissive_strength", .kind = Object, .members = kEmissiveStrength},
    {.key = "KHR_materials_unlit", .kind = Object},
};
constexpr Rule kMaterial[] = {
    {.key = "name", .kind = String},
    {.key = "pbrMetallicRoughness", .kind = Object, .members = kMetallicRoughness},
    {.key = "normalTexture", .kind = Object, .members = kTextureInfo},
    {.key = "occlusionTexture", .kind = Object, .members = kTextureInfo},
    {.key = "emissiveTexture", .kind = Object, .members = kTextureInfo},
    {.key = "emissiveFactor", .kind = Numbers, .low = 3, .high = 3},
    {.key = "alphaMode", .kind = String, .target = "OPAQUE|MASK|BLEND"},
    {.key = "alphaCutoff", .kind = Number},
    {.key = "doubleSided", .kind = Boolean},
    {.key = "extensions", .kind = Object, .members = kMaterialExtensions},
};

constexpr Rule kPrimitive[] = {
    {.key = "attributes", .kind = ReferenceMap, .required = true, .target = kAccessors},
    {.key = "indices", .kind = Reference, .target = kAccessors},
    {.key = "material", .kind = Reference, .target = "/materials"},
    {.key = "mode", .kind = Integer, .target = "0|1|2|3|4|5|6"},
    {.key = "targets", .kind = ReferenceMaps, .target = kAccessors},
};
constexpr Rule kMesh[] = {
    {.key = "name", .kind = String},
    {.key = "primitives", .kind = Objects, .required = true, .low = 1, .members = kPrimitive},
    {.key = "weights", .kind = Numbers},
};
constexpr Rule kInstancing[] = {
    {.key = "attributes", .kind = ReferenceMap, .required = true, .target = kAccessors},
};
constexpr Rule kNodeLight[] = {
    {.key = "light", .kind = Reference, .required = true, .target = "/extensions/KHR_lights_punctual/lights"},
};
constexpr Rule kNodeExtensions[] = {
    {.key = "EXT_mesh_gpu_instancing", .kind = Object, .members = kInstancing},
    {.key = "KHR_lights_punctual", .kind = Object, .members = kNodeLight},
};
constexpr Rule kNode[] = {
    {.key = "name", .kind = String},
    {.key = "camera", .kind = Reference, .target = "/cameras"},
    {.key = "children", .kind = References, .target = "/nodes"},
    {.key = "skin", .kind = Reference, .target = "/skins"},
    {.key = "mesh", .kind = Reference, .target = "/meshes"},
    {.key = "matrix", .kind = Numbers, .low = 16, .high = 16},
    {.key = "rotation", .kind = Numbers, .low = 4, .high = 4},
    {.key = "scale", .kind = Numbers, .low = 3, .high = 3},
    {.key = "translation", .kind = Numbers, .low = 3, .high = 3},
    {.key = "weights", .kind = Numbers},
    {.key = "extensions", .kind = Object, .members = kNodeExtensions},
};
constexpr Rule kSkin[] = {
    {.key = "joints", .kind = References, .required = true, .low = 1, .target = "/nodes"},
    {.key = "inverseBindMatrices", .kind = Reference, .target = kAccessors},
    {.key = "skeleton", .kind = Reference, .target = "/nodes"},
};
constexpr Rule kScene[] = {
    {.key = "name", .kind = String},
    {.key = "nodes", .kind = References, .target = "/nodes"},
};

constexpr Rule kPerspective[] = {
    {.key = "yfov", .kind = Number, .required = true, .low = 1e-6, .high = 3.14159},
    {.key = "aspectRatio", .kind = Number, .low = 1e-6, .high = 1e6},
    {.key = "znear", .kind = Number, .required = true},
    {.key = "zfar", .kind = Number},
};
constexpr Rule kOrthographic[] = {
    {.key = "xmag", .kind = Number, .required = true},
    {.key = "ymag", .kind = Number, .required = true},
    {.key = "znear", .kind = Number, .required = true},
    {.key = "zfar", .kind = Number, .required = true},
};
constexpr Rule kCamera[] = {
    {.key = "name", .kind = String},
    {.key = "type", .kind = String, .required = true, .target = "perspective|orthographic"},
    {.key = "perspective", .kind = Object, .members = kPerspective},
    {.key = "orthographic", .kind = Object, .members = kOrthographic},
};
constexpr Rule kSpot[] = {
    {.key = "innerConeAngle", .kind = Number},
    {.key = "outerConeAngle", .kind = Number},
};
constexpr Rule kLight[] = {
    {.key = "name", .kind = String},
    {.key = "type", .kind = String, .required = true, .target = "directional|point|spot"},
    {.key = "color", .kind = Numbers, .low = 3, .high = 3},
    {.key = "intensity", .kind = Number},
    {.key = "range", .kind = Number},
    {.key = "spot", .kind = Object, .members = kSpot},
};
constexpr Rule kLights[] = {{.key = "lights", .kind = Objects, .required = true, .members = kLight}};
constexpr Rule kRootExtensions[] = {{.key = "KHR_lights_punctual", .kind = Object, .members = kLights}};

constexpr Rule kRoot[] = {
    {.key = "asset", .kind = Object, .required = true, .members = kAsset},
    {.key = "extensionsUsed", .kind = Strings},
    {.key = "extensionsRequired", .kind = Strings},
    {.key = "buffers", .kind = Objects, .members = kBuffer},
    {.key = "bufferViews", .kind = Objects, .members = kBufferView},
    {.key = "accessors", .kind = Objects, .members = kAccessor},
    {.key = "images", .kind = Objects, .members = kImage},
    {.key = "samplers", .kind = Objects, .members = kSampler},
    {.key = "textures", .kind = Objects, .members = kTexture},
    {.key = "materials", .kind = Objects, .members = kMaterial},
    {.key = "meshes", .kind = Objects, .members = kMesh},
    {.key = "skins", .kind = Objects, .members = kSkin},
    {.key = "cameras", .kind = Objects, .members = kCamera},
    {.key = "extensions", .kind = Object, .members = kRootExtensions},
    {.key = "nodes", .kind = Objects, .members = kNode},
    {.key = "scenes", .kind = Objects, .members = kScene},
    {.key = "scene", .kind = Reference, .target = "/scenes"},
};
// clang-format on

constexpr std::array<std::string_view, 12> kKnownExtensions{"KHR_lights_punctual",
                                                            "KHR_materials_transmission",
                                                            "KHR_materials_ior",
                                                            "KHR_materials_volume",
                                                            "KHR_materials_dispersion",
                                                            "KHR_materials_specular",
                                                            "KHR_materials_emissive_strength",
                                                            "KHR_materials_unlit",
                                                            "KHR_texture_transform",
                                                            "KHR_mesh_quantization",
                                                            "EXT_mesh_gpu_instancing",
                                                            "EXT_texture_webp"};

}  // namespace

std::span<const Rule> gltfRules() noexcept { return kRoot; }

bool isKnownExtension(std::string_view name) noexcept {
    return std::find(kKnownExtensions.begin(), kKnownExtensions.end(), name) != kKnownExtensions.end();
}

}  // namespace pellucid

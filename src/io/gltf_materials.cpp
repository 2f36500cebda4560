#include "gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tiny_gltf.h>

namespace pellucid {
namespace {

constexpr double kLargest = 1e30;  // of factors without an upper limit: squares stay far from overflow in double
constexpr double kDarkest = 1e-6;  // attenuation colours below this absorb as this: ln 0 has no value

using tinygltf::Value;

/// How a material names a texture, in the core's form and in that of extensions.
struct TextureUse {
    int index = -1;
    int texCoord = 0;
    const Value* transform = nullptr;  ///< KHR_texture_transform
};

template <class Info>
[[nodiscard]] TextureUse useOf(const Info& info) {
    const auto found = info.extensions.find("KHR_texture_transform");
    return {info.index, info.texCoord, found == info.extensions.end() ? nullptr : &found->second};
}

[[nodiscard]] double numberOr(const Value& object, const char* key, double fallback) {
    return object.Has(key) ? object.Get(key).GetNumberAsDouble() : fallback;
}

[[nodiscard]] TextureUse useOf(const Value& object, const char* key) {
    if (!object.Has(key)) return {};
    const Value& info = object.Get(key);
    TextureUse use{info.Get("index").GetNumberAsInt(), static_cast<int>(numberOr(info, "texCoord", 0.0))};
    if (info.Has("extensions") && info.Get("extensions").Has("KHR_texture_transform"))
        use.transform = &info.Get("extensions").Get("KHR_texture_transform");
    return use;
}

[[nodiscard]] glm::dvec3 vectorOr(const Value& object, const char* key, double fallback) {
    glm::dvec3 v(fallback);
    if (object.Has(key))
        for (int k = 0; k < 3; ++k) v[k] = object.Get(key).Get(k).GetNumberAsDouble();
    return v;
}

[[nodiscard]] Wrap wrapOf(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::Clamp;
    return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::Mirror : Wrap::Repeat;
}

class MaterialReader {
public:
    MaterialReader(GltfAsset& asset, std::size_t index, bool used)
        : asset_(asset), source_(asset.model().materials[index]), path_(element("materials", index)), used_(used) {}

    [[nodiscard]] Material read() {
        material_.name = source_.name;
        readBase();
        readSurface();
        readTransmission();
        readSpecular();
        readVolume();
        return material_;
    }

private:
    /// `value` within [low, high], with a warning where it was not.
    [[nodiscard]] float within(double value, double low, double high, const char* name) const {
        if (std::isnan(value)) asset_.bad(path_ + "." + name, "the value is not a number", "correct the material");
        if (value < low || value > high) asset_.notes().warn(path_ + "." + name + " is out of range and is clamped");
        return static_cast<float>(std::clamp(value, low, high));
    }
    [[nodiscard]] float fraction(double value, const char* name) const { return within(value, 0.0, 1.0, name); }

    /// An empty object where the material does not have the extension.
    [[nodiscard]] const Value& extension(const char* name) const {
        static const Value none{Value::Object()};
        const auto found = source_.extensions.find(name);
        return found == source_.extensions.end() || !found->second.IsObject() ? none : found->second;
    }

    [[nodiscard]] TextureRef texture(const TextureUse& use, bool srgb, const char* name) {
        TextureRef ref;
        ref.srgb = srgb;
        if (use.index < 0 || !used_) return ref;
        const tinygltf::Texture& texture = asset_.model().textures[static_cast<std::size_t>(use.index)];
        const int image = imageOf(texture);
        if (image < 0) {
            asset_.notes().warn(element("textures", static_cast<std::size_t>(use.index)) +
                                " has no image that can be read");
            return ref;
        }
        ref.uvSet = use.texCoord;
        if (use.transform != nullptr) setTransform(*use.transform, ref);
        if (ref.uvSet > 1) {
            asset_.notes().warn(path_ + "." + name +
                                ": texture coordinates past set 1 are not supported; it is left out");
            return {};
        }
        if (texture.sampler >= 0) {
            const tinygltf::Sampler& sampler = asset_.model().samplers[static_cast<std::size_t>(texture.sampler)];
            ref.linear = sampler.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST;
            ref.wrapS = wrapOf(sampler.wrapS);
            ref.wrapT = wrapOf(sampler.wrapT);
        }
        ref.image = asset_.image(image);
        return ref;
    }

    [[nodiscard]] static int imageOf(const tinygltf::Texture& texture) {
        if (texture.source >= 0) return texture.source;
        const auto webp = texture.extensions.find("EXT_texture_webp");
        return webp != texture.extensions.end() && webp->second.Has("source")
                   ? webp->second.Get("source").GetNumberAsInt()
                   : -1;
    }

    void setTransform(const Value& transform, TextureRef& ref) const {
        const auto pair = [&](const char* key, glm::vec2& target) {
            if (!transform.Has(key)) return;
            for (int k = 0; k < 2; ++k)
                target[k] = within(transform.Get(key).Get(k).GetNumberAsDouble(), -kLargest, kLargest, key);
        };
        pair("offset", ref.offset);
        pair("scale", ref.scale);
        ref.rotation = within(numberOr(transform, "rotation", 0.0), -kLargest, kLargest, "rotation");
        if (transform.Has("texCoord")) ref.uvSet = transform.Get("texCoord").GetNumberAsInt();
    }

    void readBase() {
        const tinygltf::PbrMetallicRoughness& pbr = source_.pbrMetallicRoughness;
        for (int k = 0; k < 4; ++k)
            material_.baseColor[k] = fraction(pbr.baseColorFactor[static_cast<std::size_t>(k)], "baseColorFactor");
        material_.baseColorTexture = texture(useOf(pbr.baseColorTexture), true, "baseColorTexture");
        material_.metallic = fraction(pbr.metallicFactor, "metallicFactor");
        material_.roughness = fraction(pbr.roughnessFactor, "roughnessFactor");
        material_.metallicRoughnessTexture =
            texture(useOf(pbr.metallicRoughnessTexture), false, "metallicRoughnessTexture");
    }

    void readSurface() {
        material_.normalTexture = texture(useOf(source_.normalTexture), false, "normalTexture");
        material_.normalScale = within(source_.normalTexture.scale, -kLargest, kLargest, "normalTexture.scale");
        material_.alphaMode = source_.alphaMode == "MASK"    ? AlphaMode::Mask
                              : source_.alphaMode == "BLEND" ? AlphaMode::Blend
                                                             : AlphaMode::Opaque;
        material_.alphaCutoff = within(source_.alphaCutoff, 0.0, kLargest, "alphaCutoff");
        material_.doubleSided = source_.doubleSided;

        // The schema ends emissiveFactor at 1; brighter ones, common before the strength extension, mean what they say.
        const double strength = within(numberOr(extension("KHR_materials_emissive_strength"), "emissiveStrength", 1.0),
                                       0.0, kLargest, "emissiveStrength");
        for (int k = 0; k < 3; ++k) {
            const double factor = source_.emissiveFactor[static_cast<std::size_t>(k)];
            if (factor > 1.0) asset_.notes().warn(path_ + ".emissiveFactor is above 1 and is taken as it stands");
            material_.emission[k] = within(factor * strength, 0.0, kLargest, "emissiveFactor");
        }
        material_.emissiveTexture = texture(useOf(source_.emissiveTexture), true, "emissiveTexture");
    }

    void readTransmission() {
        const Value& transmission = extension("KHR_materials_transmission");
        material_.transmission = fraction(numberOr(transmission, "transmissionFactor", 0.0), "transmissionFactor");
        material_.transmissionTexture =
            texture(useOf(transmission, "transmissionTexture"), false, "transmissionTexture");
        const double ior = numberOr(extension("KHR_materials_ior"), "ior", 1.5);
        material_.ior = ior == 0.0 ? 0.0F : within(ior, 1.0, 1e3, "ior");
        material_.dispersion =
            within(numberOr(extension("KHR_materials_dispersion"), "dispersion", 0.0), 0.0, 1e3, "dispersion");
    }

    void readSpecular() {
        const Value& specular = extension("KHR_materials_specular");
        material_.specular = fraction(numberOr(specular, "specularFactor", 1.0), "specularFactor");
        material_.specularTexture = texture(useOf(specular, "specularTexture"), false, "specularTexture");
        const glm::dvec3 colour = vectorOr(specular, "specularColorFactor", 1.0);
        for (int k = 0; k < 3; ++k)
            material_.specularColor[k] = within(colour[k], 0.0, kLargest, "specularColorFactor");
        material_.specularColorTexture = texture(useOf(specular, "specularColorTexture"), true, "specularColorTexture");
    }

    /// KHR_materials_volume states the colour c that white light has after the distance d; Beer's law exp(-a d) = c.
    void readVolume() {
        const Value& volume = extension("KHR_materials_volume");
        material_.thickness = within(numberOr(volume, "thicknessFactor", 0.0), 0.0, kLargest, "thicknessFactor");
        if (volume.Has("thicknessTexture"))
            asset_.notes().warn("thickness textures are ignored: a closed body's thickness is where its surfaces are");
        const double distance = numberOr(volume, "attenuationDistance", std::numeric_limits<double>::infinity());
        if (!(distance > 0.0)) asset_.notes().warn(path_ + ".attenuationDistance is not above 0: nothing is absorbed");
        const glm::dvec3 colour = vectorOr(volume, "attenuationColor", 1.0);
        for (int k = 0; k < 3; ++k) {
            const double c = static_cast<double>(fraction(colour[k], "attenuationColor"));
            const double perMetre = distance > 0.0 ? -std::log(std::max(c, kDarkest)) / distance : 0.0;
            material_.absorption[k] = static_cast<float>(std::min(perMetre, kLargest)) + 0.0F;
        }
    }

    GltfAsset& asset_;
    const tinygltf::Material& source_;
    std::string path_;
    bool used_;
    Material material_;
};

}  // namespace

void addMaterials(GltfAsset& asset, SceneDescription& description) {
    const std::size_t count = asset.model().materials.size();
    std::vector<char> used(count + 1, 0);
    for (const Mesh& mesh : description.meshes) used[mesh.material] = 1;
    for (std::size_t i = 0; i < count; ++i)
        description.materials.push_back(MaterialReader(asset, i, used[i] != 0).read());
    if (used[count] == 0 && count > 0) return;
    description.materials.emplace_back();
    description.materials.back().name = "default";
}

}  // namespace pellucid

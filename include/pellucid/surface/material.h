/// The material as glTF states it: factors and textures of the metallic-roughness model and the extensions that we know.
/// surface/bsdf.h turns it into lobes at a point.
#pragma once

#include <string>

#include <pellucid/math/rgb.h>
#include <pellucid/surface/texture.h>

namespace pellucid {

enum class AlphaMode { Opaque, Mask, Blend };

struct Material {
    std::string name;
    glm::vec4 baseColor{1.0F};
    TextureRef baseColorTexture;  ///< sRGB; alpha in A
    float metallic = 1.0F, roughness = 1.0F;
    TextureRef metallicRoughnessTexture;  ///< roughness in G, metallic in B
    TextureRef normalTexture;
    float normalScale = 1.0F;
    Rgb emission{0.0F};          ///< radiance: emissiveFactor x emissive strength
    TextureRef emissiveTexture;  ///< sRGB
    AlphaMode alphaMode = AlphaMode::Opaque;
    float alphaCutoff = 0.5F;
    bool doubleSided = false;    ///< only decides whether a lamp emits from both sides
    float ior = 1.5F;            ///< KHR_materials_ior; 0 means total Fresnel reflection as that extension says
    float specular = 1.0F;       ///< KHR_materials_specular
    TextureRef specularTexture;  ///< in A
    Rgb specularColor{1.0F};
    TextureRef specularColorTexture;  ///< sRGB
    float transmission = 0.0F;        ///< KHR_materials_transmission
    TextureRef transmissionTexture;   ///< in R
    float thickness = 0.0F;           ///< KHR_materials_volume; > 0: closed dielectric body that refracts
    float dispersion = 0.0F;          ///< KHR_materials_dispersion: 20 / Abbe number
    Rgb absorption{0.0F};             ///< 1/m: -ln(attenuationColor) / attenuationDistance, Beer's law
};

}  // namespace pellucid

#include "materials.h"

#include <algorithm>

namespace scenes {

namespace {

Json toJson(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Json metallicRoughness(const glm::dvec3& color, double metallic, double roughness) {
    return {{"baseColorFactor", {color.x, color.y, color.z, 1.0}},
            {"metallicFactor", metallic},
            {"roughnessFactor", roughness}};
}

}  // namespace

Json lambert(const std::string& name, const glm::dvec3& reflectance) {
    return {{"name", name},
            {"pbrMetallicRoughness", metallicRoughness(reflectance, 0.0, 1.0)},
            {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0.0}}}}}};
}

Json lamp(const std::string& name, const glm::dvec3& radiance) {
    const double strength = std::max({radiance.x, radiance.y, radiance.z});
    Json material = lambert(name, glm::dvec3(0.0));
    material["emissiveFactor"] = toJson(radiance / strength);
    material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
    return material;
}

Json metal(const std::string& name, const glm::dvec3& color, double roughness) {
    return {{"name", name}, {"pbrMetallicRoughness", metallicRoughness(color, 1.0, roughness)}};
}

Json dielectric(const std::string& name, double ior, double roughness) {
    return {{"name", name},
            {"pbrMetallicRoughness", metallicRoughness(glm::dvec3(1.0), 0.0, roughness)},
            {"extensions",
             {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}},
              {"KHR_materials_ior", {{"ior", ior}}},
              {"KHR_materials_volume", {{"thicknessFactor", 1.0}}}}}};
}

Json dispersing(Json material, double abbe) {
    material["extensions"]["KHR_materials_dispersion"] = {{"dispersion", 20.0 / abbe}};
    return material;
}

Json absorbing(Json material, const glm::dvec3& color, double distance) {
    Json& volume = material["extensions"]["KHR_materials_volume"];
    volume["attenuationColor"] = toJson(color);
    volume["attenuationDistance"] = distance;
    return material;
}

}  // namespace scenes

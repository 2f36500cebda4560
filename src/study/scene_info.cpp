#include <pellucid/study/scene_info.h>

#include <array>
#include <vector>

#include <nlohmann/json.hpp>

#include <pellucid/math/constants.h>
#include <pellucid/study/text_table.h>

namespace pellucid {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kLightNames{"point", "spot", "directional", "triangle", "environment"};

/// Lights of one kind together: an emissive mesh may have a million triangles.
struct LightGroup {
    std::string kind;
    std::uint64_t count = 0;
    double watts = 0.0;
};

[[nodiscard]] std::vector<LightGroup> lightGroups(const Scene& scene) {
    std::vector<LightGroup> groups;
    for (const char* name : kLightNames) groups.push_back({name, 0, 0.0});
    const Lights& lights = scene.lights();
    // Radiance survives normalisation, areas scale with the square of the lengths, and power with the areas.
    const double scale = scene.normalisation().scale();
    for (std::uint32_t i = 0; i < lights.count(); ++i) {
        LightGroup& group = groups[static_cast<std::size_t>(lights.kind(i))];
        ++group.count;
        group.watts += lights.power(i) / (scale * scale);
    }
    std::erase_if(groups, [](const LightGroup& group) { return group.count == 0; });
    return groups;
}

[[nodiscard]] std::vector<std::string> kindNames(LobeKinds kinds) {
    std::vector<std::string> names;
    if ((kinds & kDiffuse) != 0) names.emplace_back("diffuse");
    if ((kinds & kGlossy) != 0) names.emplace_back("glossy");
    if ((kinds & kSpecular) != 0) names.emplace_back("specular");
    return names;
}

[[nodiscard]] bool emits(const Material& material) { return !isBlack(material.emission); }

[[nodiscard]] glm::dvec3 inMetres(const Scene& scene, const glm::vec3& p) {
    return glm::dvec3(p) / scene.normalisation().scale() + scene.normalisation().centre;
}

[[nodiscard]] double degrees(double radians) { return radians * 180.0 / kPiD; }

[[nodiscard]] Json vectorJson(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

[[nodiscard]] Json materialsJson(const Scene& scene) {
    Json json = Json::array();
    const std::vector<Material>& materials = scene.description().materials;
    for (std::uint32_t i = 0; i < materials.size(); ++i)
        json.push_back({{"name", materials[i].name},
                        {"kinds", kindNames(scene.surfaces().possibleKinds(i))},
                        {"emits", emits(materials[i])}});
    return json;
}

[[nodiscard]] Json camerasJson(const Scene& scene) {
    Json json = Json::array();
    for (const CameraSpec& camera : scene.description().cameras) {
        Json entry{{"name", camera.name}, {"type", camera.orthographic ? "orthographic" : "perspective"}};
        if (!camera.orthographic) entry["vertical_fov_degrees"] = degrees(camera.verticalFov);
        if (camera.aspect > 0.0) entry["aspect"] = camera.aspect;
        json.push_back(std::move(entry));
    }
    return json;
}

[[nodiscard]] Json environmentJson(const Environment* environment) {
    if (environment == nullptr) return nullptr;
    return {{"type", environment->isConstant() ? "constant" : "map"},
            {"mean_radiance", vectorJson(glm::dvec3(environment->meanRadiance()))}};
}

[[nodiscard]] std::string join(const std::vector<std::string>& words, const char* none) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + printable(word);
    return text.empty() ? none : text;
}

[[nodiscard]] std::string vectorText(const glm::dvec3& v) {
    return "(" + figure(v.x) + ", " + figure(v.y) + ", " + figure(v.z) + ")";
}

[[nodiscard]] std::string tablesText(const Scene& scene) {
    const SceneDescription& description = scene.description();
    TextTable materials({"material", "kinds", "emits"});
    for (std::uint32_t i = 0; i < description.materials.size(); ++i)
        materials.add({description.materials[i].name, join(kindNames(scene.surfaces().possibleKinds(i)), "black"),
                       emits(description.materials[i]) ? "yes" : ""});
    TextTable lights({"lights", "number", "watts"});
    for (const LightGroup& group : lightGroups(scene))
        lights.add({group.kind, std::to_string(group.count), figure(group.watts)});
    TextTable cameras({"camera", "name", "view"});
    for (std::size_t i = 0; i < description.cameras.size(); ++i) {
        const CameraSpec& camera = description.cameras[i];
        cameras.add({std::to_string(i), camera.name,
                     camera.orthographic ? "orthographic" : figure(degrees(camera.verticalFov)) + " degrees high"});
    }
    return "\n" + materials.text() + "\n" + (lights.empty() ? "no lights: give --env\n" : lights.text()) + "\n" +
           (cameras.empty() ? "no camera: one is made that frames the scene\n" : cameras.text());
}

}  // namespace

std::string infoJson(const Scene& scene, const std::string& file) {
    const SceneDescription& description = scene.description();
    Json json;
    json["scene"] = file;
    json["scene_hash"] = scene.hash();
    json["triangles"] = scene.triangles();
    json["dropped_triangles"] = description.droppedTriangles;
    json["meshes"] = description.meshes.size();
    json["geometries"] = description.geometries.size();
    json["materials"] = materialsJson(scene);
    json["lights"] = Json::array();
    for (const LightGroup& group : lightGroups(scene))
        json["lights"].push_back({{"kind", group.kind}, {"count", group.count}, {"watts", group.watts}});
    json["cameras"] = camerasJson(scene);
    json["environment"] = environmentJson(scene.environment());
    json["bounds"] = {{"lower", vectorJson(inMetres(scene, scene.bounds().lower))},
                      {"upper", vectorJson(inMetres(scene, scene.bounds().upper))}};
    json["normalisation"] = {{"centre", vectorJson(scene.normalisation().centre)},
                             {"exponent", scene.normalisation().exponent}};
    json["extensions_used"] = description.extensionsUsed;
    json["extensions_ignored"] = description.extensionsIgnored;
    json["warnings"] = description.warnings;
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string infoText(const Scene& scene, const std::string& file) {
    const SceneDescription& description = scene.description();
    std::string text = file + "\n";
    text += "triangles           " + std::to_string(scene.triangles());
    if (description.droppedTriangles > 0)
        text += " (" + std::to_string(description.droppedTriangles) + " degenerate ones left out)";
    text += "\nmeshes              " + std::to_string(description.meshes.size()) + ", placed " +
            std::to_string(description.geometries.size()) + " times\n";
    text += "bounds, metres      " + vectorText(inMetres(scene, scene.bounds().lower)) + " to " +
            vectorText(inMetres(scene, scene.bounds().upper)) + "\n";
    text += "normalisation       centre " + vectorText(scene.normalisation().centre) + ", scale 2^" +
            std::to_string(scene.normalisation().exponent) + "\n";
    const Environment* environment = scene.environment();
    text += "environment         ";
    text += environment == nullptr ? "none"
                                   : (environment->isConstant() ? "constant " : "map, mean radiance ") +
                                         vectorText(glm::dvec3(environment->meanRadiance()));
    text += "\nextensions used     " + join(description.extensionsUsed, "none");
    text += "\nextensions ignored  " + join(description.extensionsIgnored, "none") + "\n";
    text += "scene hash          " + scene.hash() + "\n";
    text += tablesText(scene);
    for (const std::string& warning : description.warnings) text += "\nwarning: " + printable(warning);
    return description.warnings.empty() ? text : text + "\n";
}

}  // namespace pellucid

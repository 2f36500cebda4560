/// Cameras and punctual lights: the nodes that show nothing themselves.
#include <algorithm>
#include <cmath>
#include <string>

#include <tiny_gltf.h>

#include <pellucid/math/constants.h>

#include "gltf_scene.h"

namespace pellucid {
namespace {

/// The node's name tells apart two nodes that hold one camera; else the camera's own, else a number.
[[nodiscard]] std::string nameOf(const tinygltf::Node& node, const std::string& own, const char* kind,
                                 std::size_t number) {
    if (!node.name.empty()) return node.name;
    return own.empty() ? std::string(kind) + " " + std::to_string(number) : own;
}

[[nodiscard]] double extent(const GltfAsset& asset, double value, const std::string& path) {
    if (value == 0.0) asset.bad(path, "an orthographic camera sees nothing with an extent of 0", "give it an extent");
    if (value < 0.0) asset.notes().warn(path + " is negative: its magnitude is taken");
    return std::fabs(value);
}

[[nodiscard]] CameraSpec cameraSpec(const GltfAsset& asset, const tinygltf::Node& node, const glm::dmat4& toWorld,
                                    std::size_t number) {
    const tinygltf::Camera& camera = asset.model().cameras[static_cast<std::size_t>(node.camera)];
    CameraSpec spec;
    spec.name = nameOf(node, camera.name, "camera", number);
    spec.toWorld = toWorld;
    spec.orthographic = camera.type == "orthographic";
    if (spec.orthographic) {
        const std::string path = element("cameras", static_cast<std::size_t>(node.camera)) + ".orthographic";
        spec.xmag = extent(asset, camera.orthographic.xmag, path + ".xmag");
        spec.ymag = extent(asset, camera.orthographic.ymag, path + ".ymag");
        spec.aspect = spec.xmag / spec.ymag;
    } else {
        spec.verticalFov = camera.perspective.yfov;
        spec.aspect = camera.perspective.aspectRatio;
    }
    return spec;
}

/// Colour x intensity, where negative and unrepresentable values are no light.
[[nodiscard]] Rgb lightIntensity(const GltfAsset& asset, const tinygltf::Light& light, const std::string& path) {
    Rgb result(1.0F);
    for (int k = 0; k < 3; ++k) {
        const double colour = light.color.size() == 3 ? light.color[static_cast<std::size_t>(k)] : 1.0;
        const double value = colour * light.intensity;
        if (!(value >= 0.0 && value <= 1e30)) asset.notes().warn(path + ": an intensity out of range is clamped");
        result[k] = static_cast<float>(std::isnan(value) ? 0.0 : std::clamp(value, 0.0, 1e30));
    }
    return result;
}

/// KHR_lights_punctual: 0 <= inner < outer <= pi/2.
void setCones(const GltfAsset& asset, const tinygltf::Light& source, const std::string& path, PunctualLight& light) {
    constexpr double kLeast = 1e-4;
    light.outerCone = std::clamp(source.spot.outerConeAngle, kLeast, 0.5 * kPiD);
    light.innerCone = std::clamp(source.spot.innerConeAngle, 0.0, light.outerCone - 0.5 * kLeast);
    // The file's angles are rounded: a right angle may come as a little more.
    if (std::fabs(light.outerCone - source.spot.outerConeAngle) > 1e-3 ||
        std::fabs(light.innerCone - source.spot.innerConeAngle) > 1e-3)
        asset.notes().warn(path + ".spot: cone angles out of 0 <= inner < outer <= pi/2 are clamped");
}

[[nodiscard]] PunctualLight punctualLight(const GltfAsset& asset, const tinygltf::Node& node, std::size_t index,
                                          const glm::dmat4& toWorld, std::size_t number) {
    const tinygltf::Light& source = asset.model().lights[index];
    const std::string path = element("extensions.KHR_lights_punctual.lights", index);
    PunctualLight light;
    light.name = nameOf(node, source.name, "light", number);
    light.kind = source.type == "point"  ? PunctualKind::Point
                 : source.type == "spot" ? PunctualKind::Spot
                                         : PunctualKind::Directional;
    light.intensity = lightIntensity(asset, source, path);
    light.position = glm::dvec3(toWorld[3]);
    const glm::dvec3 direction = -glm::dvec3(toWorld[2]);
    const double length = glm::length(direction);
    if (length > 0.0)
        light.direction = direction / length;
    else if (light.kind != PunctualKind::Point)
        asset.notes().warn("light '" + light.name + "' has no direction: its node is scaled to nothing");
    if (light.kind == PunctualKind::Spot) setCones(asset, source, path, light);
    if (source.range > 0.0)
        asset.notes().note("ranges of lights are ignored: light falls off with the square of the distance");
    return light;
}

}  // namespace

void addCameras(const GltfAsset& asset, const std::vector<int>& nodes, const std::vector<glm::dmat4>& world,
                SceneDescription& description) {
    for (const int index : nodes) {
        const tinygltf::Node& node = asset.model().nodes[static_cast<std::size_t>(index)];
        if (node.camera < 0) continue;
        description.cameras.push_back(
            cameraSpec(asset, node, world[static_cast<std::size_t>(index)], description.cameras.size()));
    }
}

void addLights(const GltfAsset& asset, const std::vector<int>& nodes, const std::vector<glm::dmat4>& world,
               SceneDescription& description) {
    for (const int index : nodes) {
        const tinygltf::Node& node = asset.model().nodes[static_cast<std::size_t>(index)];
        const auto found = node.extensions.find("KHR_lights_punctual");
        if (found == node.extensions.end() || !found->second.Has("light")) continue;
        const auto light = static_cast<std::size_t>(found->second.Get("light").GetNumberAsInt());
        description.lights.push_back(
            punctualLight(asset, node, light, world[static_cast<std::size_t>(index)], description.lights.size()));
    }
}

}  // namespace pellucid

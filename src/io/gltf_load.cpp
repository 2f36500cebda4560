#include <exception>
#include <new>
#include <optional>
#include <utility>

#include <pellucid/io/gltf.h>

#include "file_bytes.h"
#include "gltf_asset.h"
#include "gltf_materials.h"
#include "gltf_nodes.h"
#include "gltf_scene.h"
#include "gltf_validate.h"

namespace pellucid {
namespace {

[[nodiscard]] SceneDescription describe(GltfAsset& asset) {
    SceneDescription description;
    const std::vector<glm::dmat4> world = worldTransforms(asset);
    const std::vector<int> nodes = sceneNodes(asset);
    addMeshes(asset, nodes, world, description);
    dropDegenerate(description);
    if (description.geometries.empty())
        asset.bad("",
                  description.droppedTriangles > 0 ? "all of the scene's triangles have no area"
                                                   : "the scene has no triangles",
                  "export a scene whose nodes show triangle meshes");
    addMaterials(asset, description);
    addCameras(asset, nodes, world, description);
    addLights(asset, nodes, world, description);
    if (asset.json().hasAnimations) asset.notes().note("animations are not played: the rest pose is taken");
    description.extensionsUsed = asset.json().extensionsUsed;
    description.extensionsIgnored = ignoredExtensions(asset);
    description.contentHash = asset.contentHash();
    return description;
}

/// Whatever a library throws at a broken file becomes the one error.
[[nodiscard]] SceneDescription load(std::vector<std::byte> bytes, const std::string& name,
                                    std::optional<std::filesystem::path> folder, const LogSink& log) {
    GltfNotes notes(log);
    try {
        GltfAsset asset(std::move(bytes), name, std::move(folder), notes);
        SceneDescription description = describe(asset);
        description.name = std::filesystem::path(name).filename().string();
        description.warnings = notes.takeWarnings();
        return description;
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        badGltf(name, "", "it asks for more memory than there is", "check its sizes, or split the scene");
    } catch (const std::exception& e) {
        badGltf(name, "", std::string("it cannot be read: ") + e.what(), "export the file again");
    }
}

}  // namespace

SceneDescription loadGltf(const std::filesystem::path& file, const LogSink& log) {
    return load(readFileBytes(file, file.string()), file.string(), file.parent_path(), log);
}

SceneDescription loadGltfFromMemory(std::span<const std::byte> bytes, const std::string& name, const LogSink& log) {
    return load({bytes.begin(), bytes.end()}, name, std::nullopt, log);
}

}  // namespace pellucid

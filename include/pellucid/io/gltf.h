/// glTF 2.0 (.gltf, .glb) to SceneDescription. The only room that sees tinygltf. Everything in the file is untrusted:
/// sizes, indices, paths and numbers are checked before use; files that it names must lie in its own folder.
///
/// What the description says beyond the file's own words:
///   - a mesh primitive under several nodes is one Mesh with several Geometry, those of mirrored nodes (negative
///     determinant) among them: Scene turns their fronts and bitangents;
///   - skinned meshes, meshes with morph weights of their node and nodes of no volume (a scale of 0) are baked: their
///     Geometry has the identity as transform where the node's own has no inverse or does not count;
///   - vertices that no triangle uses are left out;
///   - a normal of length zero means "use the geometric normal here", a tangent of length zero "there is none".
/// Animations are not played: the file's rest pose is what is loaded.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include <pellucid/base/log.h>
#include <pellucid/scene/description.h>

namespace pellucid {

/// Throws Error{BadInput}. Extensions that are used but not understood are named once as a warning; one of them in
/// extensionsRequired is an error.
[[nodiscard]] SceneDescription loadGltf(const std::filesystem::path& file, const LogSink& log = {});

/// The same for a file's bytes. `name` stands for the file in errors; a reference to another file is an error.
[[nodiscard]] SceneDescription loadGltfFromMemory(std::span<const std::byte> bytes, const std::string& name,
                                                  const LogSink& log = {});

}  // namespace pellucid

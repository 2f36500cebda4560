/// Collects meshes, materials, textures, lamps and cameras and writes them as one binary glTF 2.0 file. The same calls
/// give the same bytes: keys are sorted, numbers are printed shortest, nothing depends on time or addresses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "shapes.h"

namespace scenes {

using Json = nlohmann::json;

/// A node's transform.
struct Placement {
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 scale{1.0};
};

/// Where a camera stands, what it looks at, and its picture.
struct View {
    glm::dvec3 eye, target;
    double verticalFovDegrees = 40.0;
    double aspect = 4.0 / 3.0;
};

enum class Filter { Nearest, Linear };

class GlbWriter {
public:
    explicit GlbWriter(std::string name);

    /// Each add returns the index in its glTF array.
    std::size_t addMaterial(const Json& material);
    std::size_t addTexture(const std::string& name, const std::vector<std::uint8_t>& png, Filter filter);
    std::size_t addMesh(const std::string& name, const Shape& shape, std::size_t material);

    void place(const std::string& name, std::size_t mesh, const Placement& placement = {});
    /// addMesh and place in one.
    void add(const std::string& name, const Shape& shape, std::size_t material, const Placement& placement = {});
    void addCamera(const std::string& name, const View& view);
    /// `light` as KHR_lights_punctual states it; it shines along `direction`.
    void addLight(const Json& light, const glm::dvec3& position, const glm::dvec3& direction = {0.0, -1.0, 0.0});

    void write(const std::filesystem::path& file) const;

private:
    std::size_t addView(const void* data, std::size_t bytes, int target);
    std::size_t addVectors(const std::vector<glm::dvec3>& values, bool withBounds);
    std::size_t addIndices(const Shape& shape);
    void addNode(Json node, const Placement& placement);
    void noteExtensions(const Json& value);

    Json root_;
    std::vector<std::uint8_t> binary_;
    std::set<std::string> extensions_;
};

}  // namespace scenes

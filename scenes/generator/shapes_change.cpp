#include "shapes.h"

#include <glm/gtc/quaternion.hpp>

namespace scenes {

namespace {

template <typename T>
void append(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

Shape moved(Shape shape, const glm::dvec3& by) {
    for (glm::dvec3& position : shape.positions) {
        position += by;
    }
    return shape;
}

Shape turned(Shape shape, const glm::dvec3& axis, double degrees) {
    const glm::dquat turn = glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
    for (glm::dvec3& position : shape.positions) {
        position = turn * position;
    }
    for (glm::dvec3& normal : shape.normals) {
        normal = glm::normalize(turn * normal);
    }
    return shape;
}

Shape merged(const std::vector<Shape>& parts) {
    Shape whole;
    for (const Shape& part : parts) {
        const auto first = static_cast<std::uint32_t>(whole.positions.size());
        append(whole.positions, part.positions);
        append(whole.normals, part.normals);
        append(whole.uvs, part.uvs);
        append(whole.colors, part.colors);
        for (const glm::uvec3& triangle : part.triangles) {
            whole.triangles.push_back(triangle + first);
        }
    }
    return whole;
}

Shape withoutUvs(Shape shape) {
    shape.uvs.clear();
    return shape;
}

}  // namespace scenes

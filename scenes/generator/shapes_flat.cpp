#include "shapes.h"

namespace scenes {

namespace {

void appendQuad(Shape& shape, const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v) {
    const auto first = static_cast<std::uint32_t>(shape.positions.size());
    shape.positions.insert(shape.positions.end(), {corner, corner + u, corner + u + v, corner + v});
    shape.uvs.insert(shape.uvs.end(), {{0.0, 1.0}, {1.0, 1.0}, {1.0, 0.0}, {0.0, 0.0}});
    shape.triangles.emplace_back(first, first + 1, first + 2);
    shape.triangles.emplace_back(first, first + 2, first + 3);
}

}  // namespace

Shape quad(const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v) {
    Shape shape;
    appendQuad(shape, corner, u, v);
    return shape;
}

Shape floorQuad(const glm::dvec3& centre, double width, double depth) {
    const glm::dvec3 corner = centre + glm::dvec3(-0.5 * width, 0.0, 0.5 * depth);
    return quad(corner, {width, 0.0, 0.0}, {0.0, 0.0, -depth});
}

Shape ceilingQuad(const glm::dvec3& centre, double width, double depth) {
    const glm::dvec3 corner = centre + glm::dvec3(-0.5 * width, 0.0, -0.5 * depth);
    return quad(corner, {width, 0.0, 0.0}, {0.0, 0.0, depth});
}

Shape facingQuad(const glm::dvec3& centre, const glm::dvec3& target, double edge) {
    const glm::dvec3 normal = glm::normalize(target - centre);
    const glm::dvec3 helper = glm::abs(normal.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
    const glm::dvec3 u = edge * glm::normalize(glm::cross(helper, normal));
    const glm::dvec3 v = glm::cross(normal, u);
    return quad(centre - 0.5 * (u + v), u, v);
}

Shape box(const glm::dvec3& low, const glm::dvec3& high) {
    const auto corner = [&](int x, int y, int z) {
        return glm::dvec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
    };
    Shape shape;
    const auto face = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
        const std::size_t first = shape.positions.size();
        appendQuad(shape, a, b - a, d - a);
        for (std::size_t i = 0; i < 4; ++i) {  // the corners themselves, so that neighbouring faces agree bit for bit
            shape.positions[first + i] = std::vector<glm::dvec3>{a, b, c, d}[i];
        }
    };
    face(corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1));  // +z
    face(corner(1, 0, 0), corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0));  // -z
    face(corner(1, 0, 1), corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1));  // +x
    face(corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0));  // -x
    face(corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0), corner(0, 1, 0));  // +y
    face(corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1));  // -y
    return shape;
}

Shape tiles(const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v, int columns, int rows,
            const TileColor& color) {
    Shape shape;
    const glm::dvec3 stepU = u / static_cast<double>(columns);
    const glm::dvec3 stepV = v / static_cast<double>(rows);
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            appendQuad(shape, corner + static_cast<double>(column) * stepU + static_cast<double>(row) * stepV, stepU,
                       stepV);
            shape.colors.insert(shape.colors.end(), 4, color(column, row));
        }
    }
    shape.uvs.clear();
    return shape;
}

Shape extrusion(const std::vector<glm::dvec2>& outline, double low, double high) {
    Shape shape;
    const auto corners = static_cast<std::uint32_t>(outline.size());
    for (const double y : {low, high}) {
        for (const glm::dvec2& point : outline) {
            shape.positions.emplace_back(point.x, y, -point.y);
        }
    }
    for (std::uint32_t i = 0; i < corners; ++i) {
        const std::uint32_t next = (i + 1) % corners;
        shape.triangles.emplace_back(i, next, corners + next);
        shape.triangles.emplace_back(i, corners + next, corners + i);
    }
    for (std::uint32_t i = 1; i + 1 < corners; ++i) {
        shape.triangles.emplace_back(0, i + 1, i);
        shape.triangles.emplace_back(corners, corners + i, corners + i + 1);
    }
    return shape;
}

}  // namespace scenes

#include "shapes.h"

#include <cmath>

#include <glm/gtc/constants.hpp>

namespace scenes {

namespace {

/// The normal to the right of a travelled direction.
glm::dvec2 rightOf(const glm::dvec2& direction) { return glm::normalize(glm::dvec2(direction.y, -direction.x)); }

/// sin and cos that are exact at multiples of 90 degrees, so that poles lie on the axis.
glm::dvec2 unitVector(double degrees) {
    const double quarter = degrees / 90.0;
    if (quarter == std::floor(quarter)) {
        constexpr double kCos[4] = {1.0, 0.0, -1.0, 0.0};
        const auto index = static_cast<int>(quarter) & 3;
        return {kCos[index], kCos[(index + 3) & 3]};
    }
    return {std::cos(glm::radians(degrees)), std::sin(glm::radians(degrees))};
}

bool onAxis(const ProfilePoint& point) { return point.position.x == 0.0; }

}  // namespace

Profile operator+(Profile first, const Profile& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

Profile reversed(Profile profile) {
    Profile result(profile.rbegin(), profile.rend());
    for (ProfilePoint& point : result) {
        point.normal = -point.normal;
    }
    return result;
}

Profile line(const glm::dvec2& from, const glm::dvec2& to) {
    const glm::dvec2 normal = rightOf(to - from);
    return {{from, normal}, {to, normal}};
}

Profile ellipseArc(const glm::dvec2& centre, const glm::dvec2& semiAxes, double fromDegrees, double toDegrees,
                   int steps, double offset) {
    Profile profile;
    for (int i = 0; i <= steps; ++i) {
        const glm::dvec2 unit = unitVector(fromDegrees + (toDegrees - fromDegrees) * i / steps);
        const glm::dvec2 normal = glm::normalize(unit / semiAxes);
        profile.push_back({centre + unit * semiAxes + offset * normal, normal});
    }
    return profile;
}

Profile arc(const glm::dvec2& centre, double radius, double fromDegrees, double toDegrees, int steps) {
    return ellipseArc(centre, glm::dvec2(radius), fromDegrees, toDegrees, steps);
}

Profile spline(const std::vector<glm::dvec2>& points, int stepsPerSpan) {
    Profile profile;
    const auto sample = [&](std::size_t span, double t) {
        const glm::dvec2 &a = points[span], &b = points[span + 1], &c = points[span + 2], &d = points[span + 3];
        const glm::dvec2 c1 = 0.5 * (c - a), c2 = a - 2.5 * b + 2.0 * c - 0.5 * d, c3 = 0.5 * (d - a) + 1.5 * (b - c);
        profile.push_back({b + t * (c1 + t * (c2 + t * c3)), rightOf(c1 + t * (2.0 * c2 + 3.0 * t * c3))});
    };
    for (std::size_t span = 0; span + 3 < points.size(); ++span) {
        for (int i = 0; i < stepsPerSpan; ++i) {
            sample(span, static_cast<double>(i) / stepsPerSpan);
        }
    }
    sample(points.size() - 4, 1.0);
    return profile;
}

Profile roundedRectangle(const glm::dvec2& low, const glm::dvec2& high, double radius, int stepsPerCorner) {
    const glm::dvec2 innerLow = low + radius, innerHigh = high - radius;
    Profile profile = arc({innerHigh.x, innerLow.y}, radius, -90.0, 0.0, stepsPerCorner) +
                      arc(innerHigh, radius, 0.0, 90.0, stepsPerCorner) +
                      arc({innerLow.x, innerHigh.y}, radius, 90.0, 180.0, stepsPerCorner) +
                      arc(innerLow, radius, 180.0, 270.0, stepsPerCorner);
    profile.push_back(profile.front());
    return profile;
}

Shape lathe(const Profile& profile, int segments) {
    Shape shape;
    const auto columns = static_cast<std::uint32_t>(segments);
    std::vector<std::uint32_t> firstOfRow;
    for (const ProfilePoint& point : profile) {
        firstOfRow.push_back(static_cast<std::uint32_t>(shape.positions.size()));
        if (onAxis(point)) {
            shape.positions.emplace_back(0.0, point.position.y, 0.0);
            shape.normals.emplace_back(0.0, point.normal.y < 0.0 ? -1.0 : 1.0, 0.0);
            continue;
        }
        for (int column = 0; column < segments; ++column) {
            const glm::dvec2 unit = unitVector(360.0 * column / segments);
            shape.positions.emplace_back(point.position.x * unit.x, point.position.y, point.position.x * unit.y);
            shape.normals.emplace_back(point.normal.x * unit.x, point.normal.y, point.normal.x * unit.y);
        }
    }
    const auto vertex = [&](std::size_t row, std::uint32_t column) {
        return firstOfRow[row] + (onAxis(profile[row]) ? 0U : column % columns);
    };
    for (std::size_t row = 0; row + 1 < profile.size(); ++row) {
        if (profile[row].position == profile[row + 1].position) {
            continue;  // a crease
        }
        for (std::uint32_t column = 0; column < columns; ++column) {
            if (!onAxis(profile[row])) {
                shape.triangles.emplace_back(vertex(row, column), vertex(row + 1, column), vertex(row, column + 1));
            }
            if (!onAxis(profile[row + 1])) {
                shape.triangles.emplace_back(vertex(row + 1, column), vertex(row + 1, column + 1),
                                             vertex(row, column + 1));
            }
        }
    }
    return shape;
}

Shape sphere(double radius, int segments, int rings) {
    return lathe(arc({0.0, 0.0}, radius, -90.0, 90.0, rings), segments);
}

Shape torus(double majorRadius, double minorRadius, int segments, int sides) {
    Profile profile = arc({majorRadius, 0.0}, minorRadius, 0.0, 360.0, sides);
    profile.back() = profile.front();
    return lathe(profile, segments);
}

Shape cylinder(double radius, double low, double high, int segments) {
    return lathe(
        line({0.0, low}, {radius, low}) + line({radius, low}, {radius, high}) + line({radius, high}, {0.0, high}),
        segments);
}

Shape heightfield(const glm::dvec2& low, const glm::dvec2& high, int columns, int rows, const HeightFunction& height) {
    Shape shape;
    for (int row = 0; row <= rows; ++row) {
        for (int column = 0; column <= columns; ++column) {
            const double x = low.x + (high.x - low.x) * column / columns;
            const double z = low.y + (high.y - low.y) * row / rows;
            const glm::dvec3 value = height(x, z);
            shape.positions.emplace_back(x, value.x, z);
            shape.normals.push_back(glm::normalize(glm::dvec3(-value.y, 1.0, -value.z)));
        }
    }
    const auto vertex = [&](int column, int row) { return static_cast<std::uint32_t>(row * (columns + 1) + column); };
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            shape.triangles.emplace_back(vertex(column, row), vertex(column, row + 1), vertex(column + 1, row + 1));
            shape.triangles.emplace_back(vertex(column, row), vertex(column + 1, row + 1), vertex(column + 1, row));
        }
    }
    return shape;
}

}  // namespace scenes

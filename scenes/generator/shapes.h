/// Triangle shapes from which the scenes are built: computed in double, wound counter-clockwise seen from outside,
/// closed bodies watertight (equal positions are equal bit for bit). Metres, y up.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/glm.hpp>

namespace scenes {

/// Attribute arrays are empty or as long as `positions`. Without normals glTF shades flat.
struct Shape {
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> normals;  ///< unit
    std::vector<glm::dvec2> uvs;      ///< glTF convention: (0,0) is the upper left corner of an image
    std::vector<glm::u8vec4> colors;  ///< linear, normalised, multiplies the base colour
    std::vector<glm::uvec3> triangles;
};

// --- flat shapes ----------------------------------------------------------------------------------------------------

/// The parallelogram corner + s u + t v; its front looks along u x v. With uvs: (s, 1 - t).
[[nodiscard]] Shape quad(const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v);

/// A horizontal rectangle around `centre` whose front looks up (floor) or down (ceiling, lamp).
[[nodiscard]] Shape floorQuad(const glm::dvec3& centre, double width, double depth);
[[nodiscard]] Shape ceilingQuad(const glm::dvec3& centre, double width, double depth);

/// A square of the given edge around `centre`, facing `target`: a lamp's head.
[[nodiscard]] Shape facingQuad(const glm::dvec3& centre, const glm::dvec3& target, double edge);

/// An axis-aligned closed box, four vertices a face, with uvs that cover each face once.
[[nodiscard]] Shape box(const glm::dvec3& low, const glm::dvec3& high);

/// A quad cut into columns x rows tiles of one colour each.
using TileColor = std::function<glm::u8vec4(int column, int row)>;
[[nodiscard]] Shape tiles(const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v, int columns, int rows,
                          const TileColor& color);

/// The convex polygon `outline` in plan, (x, -z), counter-clockwise seen from above, extruded from y = low to y = high:
/// a closed body with flat faces.
[[nodiscard]] Shape extrusion(const std::vector<glm::dvec2>& outline, double low, double high);

// --- round shapes ---------------------------------------------------------------------------------------------------

/// A point of a profile in the half plane (radius, height), with the outward unit normal there.
struct ProfilePoint {
    glm::dvec2 position;
    glm::dvec2 normal;
};
/// Travelled so that the outside lies to the right: from the axis at the bottom, outward and up, back to the axis; or a
/// loop whose last point repeats the first. Two points at one place with unequal normals make a crease.
using Profile = std::vector<ProfilePoint>;

[[nodiscard]] Profile operator+(Profile first, const Profile& second);
/// The same curve travelled backwards with its outside on the other side: the inner wall of a vessel.
[[nodiscard]] Profile reversed(Profile profile);
/// A straight piece of profile.
[[nodiscard]] Profile line(const glm::dvec2& from, const glm::dvec2& to);
/// Ellipse arc between two angles in degrees (0 = outward, 90 = up), moved by `offset` along its normal.
[[nodiscard]] Profile ellipseArc(const glm::dvec2& centre, const glm::dvec2& semiAxes, double fromDegrees,
                                 double toDegrees, int steps, double offset = 0.0);
[[nodiscard]] Profile arc(const glm::dvec2& centre, double radius, double fromDegrees, double toDegrees, int steps);
/// Catmull-Rom curve from points[1] to points[n-2]; the first and last point only give the end tangents.
[[nodiscard]] Profile spline(const std::vector<glm::dvec2>& points, int stepsPerSpan);
/// A rectangle between `low` and `high` whose corners are rounded with `radius`: the section of a ring.
[[nodiscard]] Profile roundedRectangle(const glm::dvec2& low, const glm::dvec2& high, double radius,
                                       int stepsPerCorner);

/// Surface of revolution about the y axis.
[[nodiscard]] Shape lathe(const Profile& profile, int segments);

/// Around the origin; move it with moved() or by its node.
[[nodiscard]] Shape sphere(double radius, int segments, int rings);
[[nodiscard]] Shape torus(double majorRadius, double minorRadius, int segments, int sides);
[[nodiscard]] Shape cylinder(double radius, double low, double high, int segments);

/// Height and its slopes d/dx, d/dz.
using HeightFunction = std::function<glm::dvec3(double x, double z)>;
/// An open surface y = height(x, z) over [low, high] that looks up, with exact normals.
[[nodiscard]] Shape heightfield(const glm::dvec2& low, const glm::dvec2& high, int columns, int rows,
                                const HeightFunction& height);

// --- changes --------------------------------------------------------------------------------------------------------

[[nodiscard]] Shape moved(Shape shape, const glm::dvec3& by);
[[nodiscard]] Shape turned(Shape shape, const glm::dvec3& axis, double degrees);
/// One shape of several that carry the same attributes.
[[nodiscard]] Shape merged(const std::vector<Shape>& parts);
/// For bodies without textures: smaller files.
[[nodiscard]] Shape withoutUvs(Shape shape);

}  // namespace scenes

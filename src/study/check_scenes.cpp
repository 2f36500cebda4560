#include "check_scenes.h"

#include <cmath>

#include <pellucid/math/constants.h>

namespace pellucid::check {

namespace {

/// Camera axes for a look against `back`.
[[nodiscard]] glm::dmat4 looking(const glm::dvec3& eye, const glm::dvec3& back) {
    const glm::dvec3 z = glm::normalize(back);
    const glm::dvec3 helper = std::fabs(z.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(helper, z));
    return glm::dmat4(glm::dvec4(x, 0.0), glm::dvec4(glm::cross(z, x), 0.0), glm::dvec4(z, 0.0), glm::dvec4(eye, 1.0));
}

/// Two triangles a cell, wound so that their front is the normals' side; cells that collapse to a point leave none.
void addTriangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                 const std::vector<glm::dvec3>& normals) {
    const glm::dvec3 pa(mesh.positions[a]), pb(mesh.positions[b]), pc(mesh.positions[c]);
    const glm::dvec3 cross = glm::cross(pb - pa, pc - pa);
    const double size = std::max({glm::length(pb - pa), glm::length(pc - pa), glm::length(pc - pb)});
    if (glm::length(cross) < 1e-7 * size * size) return;
    if (glm::dot(cross, normals[a] + normals[b] + normals[c]) < 0.0) std::swap(b, c);
    mesh.triangles.emplace_back(a, b, c);
}

}  // namespace

Material lambert(float reflectance, float emission) {
    Material m;
    m.baseColor = glm::vec4(glm::vec3(reflectance), 1.0F);
    m.metallic = 0.0F;
    m.specular = 0.0F;
    m.emission = Rgb(emission);
    return m;
}

Material lamp(float radiance, bool twoSided) {
    Material m = lambert(0.0F, radiance);
    m.doubleSided = twoSided;
    return m;
}

Material mirror(float reflectance, float roughness) {
    Material m;
    m.baseColor = glm::vec4(glm::vec3(reflectance), 1.0F);
    m.roughness = roughness;
    return m;
}

Material glass(float ior, float absorption, float roughness) {
    Material m;
    m.metallic = 0.0F;
    m.roughness = roughness;
    m.transmission = 1.0F;
    m.thickness = 1.0F;
    m.ior = ior;
    m.absorption = Rgb(absorption);
    return m;
}

Mesh rightAngledPrism(float halfLength) {
    Mesh m;
    for (const float y : {-halfLength, halfLength})
        for (const glm::vec2 p : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)})
            m.positions.emplace_back(p.x, y, p.y);
    m.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {2, 3, 0}};
    return m;
}

std::uint32_t SceneBuilder::add(const Material& material) {
    description_.materials.push_back(material);
    return static_cast<std::uint32_t>(description_.materials.size() - 1);
}

void SceneBuilder::mesh(Mesh mesh, const Material& material) {
    mesh.material = add(material);
    description_.meshes.push_back(std::move(mesh));
    Geometry geometry;
    geometry.mesh = static_cast<std::uint32_t>(description_.meshes.size() - 1);
    description_.geometries.push_back(geometry);
}

void SceneBuilder::quad(const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v, const Material& material) {
    Mesh m;
    m.positions = {glm::vec3(corner), glm::vec3(corner + u), glm::vec3(corner + u + v), glm::vec3(corner + v)};
    m.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh(std::move(m), material);
}

void SceneBuilder::square(const glm::dvec3& centre, const glm::dvec3& normal, double halfWidth,
                          const Material& material) {
    const glm::dmat4 axes = looking(centre, normal);
    const glm::dvec3 x = glm::dvec3(axes[0]) * halfWidth, y = glm::dvec3(axes[1]) * halfWidth;
    quad(centre - x - y, 2.0 * x, 2.0 * y, material);
}

void SceneBuilder::box(const glm::dvec3& lower, const glm::dvec3& upper, const Material& material, bool inward) {
    Mesh m;
    for (int i = 0; i < 8; ++i)
        m.positions.emplace_back((i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y,
                                 (i & 4) != 0 ? upper.z : lower.z);
    // Outward winding, two triangles a face.
    m.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    if (inward)
        for (glm::uvec3& t : m.triangles) std::swap(t.y, t.z);
    mesh(std::move(m), material);
}

double SceneBuilder::surface(int nu, int nv, const ParametricSurface& shape, const Material& material, bool smooth) {
    Mesh m;
    std::vector<glm::dvec3> normals;
    for (int j = 0; j <= nv; ++j)
        for (int i = 0; i <= nu; ++i) {
            const SurfaceSpot spot = shape(static_cast<double>(i) / nu, static_cast<double>(j) / nv);
            m.positions.emplace_back(spot.position);
            normals.push_back(spot.normal);
        }
    const auto index = [nu](int i, int j) { return static_cast<std::uint32_t>(j * (nu + 1) + i); };
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) {
            addTriangle(m, index(i, j), index(i + 1, j), index(i + 1, j + 1), normals);
            addTriangle(m, index(i, j), index(i + 1, j + 1), index(i, j + 1), normals);
        }
    if (smooth) m.normals.assign(normals.begin(), normals.end());
    const double area = meshArea(m);
    mesh(std::move(m), material);
    return area;
}

double SceneBuilder::sphere(const glm::dvec3& centre, double radius, int rings, const Material& material, bool smooth,
                            bool inward) {
    const auto shape = [=](double u, double v) {
        // The seam and the poles are exact, so that neighbouring triangles share their edges to the bit.
        const double phi = u >= 1.0 ? 0.0 : 2.0 * kPiD * u, theta = kPiD * v;
        const double sine = v <= 0.0 || v >= 1.0 ? 0.0 : std::sin(theta);
        const glm::dvec3 n(sine * std::cos(phi), sine * std::sin(phi), std::cos(theta));
        return SurfaceSpot{centre + radius * n, inward ? -n : n};
    };
    return surface(2 * rings, rings, shape, material, smooth);
}

void SceneBuilder::point(const glm::dvec3& position, double intensity) {
    PunctualLight light;
    light.position = position;
    light.intensity = Rgb(static_cast<float>(intensity));
    description_.lights.push_back(light);
}

void SceneBuilder::sun(const glm::dvec3& direction, double irradiance) {
    PunctualLight light;
    light.kind = PunctualKind::Directional;
    light.direction = glm::normalize(direction);
    light.intensity = Rgb(static_cast<float>(irradiance));
    description_.lights.push_back(light);
}

void SceneBuilder::view(const glm::dvec3& target, const glm::dvec3& normal, double width, double distance) {
    CameraSpec camera;
    camera.orthographic = true;
    camera.xmag = camera.ymag = 0.5 * width;
    camera.toWorld = looking(target + distance * glm::normalize(normal), normal);
    description_.cameras.push_back(camera);
}

void SceneBuilder::perspective(const glm::dvec3& eye, const glm::dvec3& target, double verticalFov) {
    CameraSpec camera;
    camera.verticalFov = verticalFov;
    camera.toWorld = looking(eye, eye - target);
    description_.cameras.push_back(camera);
}

double meshArea(const Mesh& mesh) {
    double area = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        area += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    return area;
}

SceneDescription transformed(SceneDescription scene, double scale, const glm::dvec3& move) {
    const auto apply = [&](glm::dmat4& m) {
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 3; ++r) m[c][r] *= scale;
        m[3] += glm::dvec4(move, 0.0);
    };
    for (Geometry& g : scene.geometries) apply(g.toWorld);
    for (CameraSpec& c : scene.cameras) {
        apply(c.toWorld);
        c.xmag *= scale;
        c.ymag *= scale;
    }
    for (PunctualLight& l : scene.lights) {
        l.position = l.position * scale + move;
        if (l.kind != PunctualKind::Directional) l.intensity *= static_cast<float>(scale * scale);
    }
    for (Material& m : scene.materials) m.absorption *= static_cast<float>(1.0 / scale);
    return scene;
}

EnvironmentDescription environmentMap(int width, int height, const std::function<double(const glm::dvec3&)>& f) {
    EnvironmentDescription environment;
    environment.map = Image(width, height, {"R", "G", "B"});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double phi = 2.0 * kPiD * ((x + 0.5) / width - 0.5), theta = kPiD * (y + 0.5) / height;
            const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
            environment.map.setRgb(
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x),
                Rgb(static_cast<float>(f(d))));
        }
    return environment;
}

}  // namespace pellucid::check

/// Coarse bodies with smooth normals in a furnace: a perfect mirror and lossless glass show the furnace and nothing else,
/// whatever their normals say. Guards against light that is lost where the interpolated normal and the triangle disagree.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <pellucid/math/constants.h>
#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>

namespace pellucid {
namespace {

/// A sphere of a few flat triangles whose normals are those of the sphere.
Mesh coarseSphere(int rings, int sectors) {
    Mesh mesh;
    for (int i = 0; i <= rings; ++i)
        for (int k = 0; k <= sectors; ++k) {
            const float theta = kPi * static_cast<float>(i) / static_cast<float>(rings);
            const float phi = kTwoPi * static_cast<float>(k % sectors) / static_cast<float>(sectors);
            const glm::vec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
            mesh.positions.push_back(n);
            mesh.normals.push_back(n);
        }
    const auto vertex = [sectors](int i, int k) { return static_cast<std::uint32_t>(i * (sectors + 1) + k); };
    for (int i = 0; i < rings; ++i)
        for (int k = 0; k < sectors; ++k) {
            if (i + 1 < rings) mesh.triangles.emplace_back(vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1));
            if (i > 0) mesh.triangles.emplace_back(vertex(i, k), vertex(i + 1, k + 1), vertex(i, k + 1));
        }
    return mesh;
}

/// The least and the greatest value that a pixel of the body in a furnace of radiance 1 has.
std::pair<float, float> inFurnace(const Material& material) {
    SceneDescription description;
    description.meshes.push_back(coarseSphere(5, 7));
    description.geometries.push_back({0, glm::dmat4(1.0)});
    description.materials.push_back(material);
    EnvironmentDescription white;
    white.constant = Rgb(1.0F);
    const Workers workers(2);
    const Scene scene(std::move(description), white, SceneOptions{}, workers);
    RenderRequest request;
    request.method = Method::Path;
    request.width = request.height = 32;
    request.budget.samples = 4;
    const RenderResult result = render(scene, request, workers);
    EXPECT_EQ(result.record.nonfinite.count, 0U);
    std::pair<float, float> range(std::numeric_limits<float>::infinity(), 0.0F);
    for (std::size_t i = 0; i < result.image.pixels(); ++i) {
        range.first = std::min(range.first, result.image.at(i, 1));
        range.second = std::max(range.second, result.image.at(i, 1));
    }
    return range;
}

TEST(SmoothNormals, AMirrorInAFurnaceIsTheFurnace) {
    Material mirror;
    mirror.roughness = 0.0F;
    const auto [least, greatest] = inFurnace(mirror);
    EXPECT_NEAR(least, 1.0F, 1e-3F);
    EXPECT_NEAR(greatest, 1.0F, 1e-3F);
}

TEST(SmoothNormals, GlassInAFurnaceIsTheFurnace) {
    Material glass;
    glass.metallic = glass.roughness = 0.0F;
    glass.transmission = glass.thickness = 1.0F;
    const auto [least, greatest] = inFurnace(glass);
    EXPECT_NEAR(least, 1.0F, 1e-3F);
    EXPECT_NEAR(greatest, 1.0F, 1e-3F);
}

TEST(SmoothNormals, ThinGlassInAFurnaceIsTheFurnace) {
    Material glass;
    glass.metallic = glass.roughness = 0.0F;
    glass.transmission = 1.0F;
    const auto [least, greatest] = inFurnace(glass);
    EXPECT_NEAR(least, 1.0F, 1e-3F);
    EXPECT_NEAR(greatest, 1.0F, 1e-3F);
}

}  // namespace
}  // namespace pellucid

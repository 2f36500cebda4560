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

/// What the pixels of a body in a furnace of radiance 1 show.
struct Furnace {
    double mean = 0.0;
    double off = 0.0;  ///< share of the pixels that are off by more than a thousandth
};

Furnace inFurnace(const Material& material, const Mesh& mesh) {
    SceneDescription description;
    description.meshes.push_back(mesh);
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
    Furnace seen;
    for (std::size_t i = 0; i < result.image.pixels(); ++i) {
        const auto value = static_cast<double>(result.image.at(i, 1));
        seen.mean += value / static_cast<double>(result.image.pixels());
        if (std::fabs(value - 1.0) > 1e-3) seen.off += 1.0 / static_cast<double>(result.image.pixels());
    }
    return seen;
}

TEST(SmoothNormals, AMirrorInAFurnaceIsTheFurnace) {
    Material mirror;
    mirror.roughness = 0.0F;
    const Furnace seen = inFurnace(mirror, coarseSphere(5, 7));
    EXPECT_EQ(seen.off, 0.0);
    EXPECT_NEAR(seen.mean, 1.0, 1e-3);
}

TEST(SmoothNormals, GlassInAFurnaceIsTheFurnace) {
    Material glass;
    glass.metallic = glass.roughness = 0.0F;
    glass.transmission = glass.thickness = 1.0F;
    const Furnace seen = inFurnace(glass, coarseSphere(12, 20));
    EXPECT_LT(seen.off, 6e-3) << "more than the few paths that facets keep inside for hundreds of reflections";
    EXPECT_NEAR(seen.mean, 1.0, 1e-3);
}

TEST(SmoothNormals, ThinGlassInAFurnaceIsTheFurnace) {
    Material glass;
    glass.metallic = glass.roughness = 0.0F;
    glass.transmission = 1.0F;
    const Furnace seen = inFurnace(glass, coarseSphere(5, 7));
    EXPECT_EQ(seen.off, 0.0);
    EXPECT_NEAR(seen.mean, 1.0, 1e-3);
}

}  // namespace
}  // namespace pellucid

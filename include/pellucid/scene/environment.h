/// Light from infinity: a constant or an equirectangular map, importance-sampled.
/// Mapping (that of Blender, three.js and the Khronos sample viewer): u = 0.5 + atan2(z, x) / (2 pi), v = acos(y) / pi,
/// row 0 at the top. The centre column looks along +x.
#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include <pellucid/math/rgb.h>
#include <pellucid/scene/description.h>

namespace pellucid {

struct DirectionSample {
    glm::vec3 direction{0.0F};
    float pdfSolidAngle = 0.0F;
};

class Environment {
public:
    explicit Environment(EnvironmentDescription description);

    /// Radiance that arrives from `direction` (unit, pointing away from the scene). Bilinear between texels.
    [[nodiscard]] Rgb radiance(const glm::vec3& direction) const noexcept;
    /// A direction drawn from a piecewise constant density that covers everything that radiance() can return. Empty:
    /// black.
    [[nodiscard]] std::optional<DirectionSample> sample(const glm::vec2& u) const noexcept;
    [[nodiscard]] float pdf(const glm::vec3& direction) const noexcept;

    [[nodiscard]] bool black() const noexcept;
    [[nodiscard]] bool isConstant() const noexcept { return map_.pixels() == 0; }
    /// Mean radiance over the sphere: the exact integral of what radiance() returns, over 4 pi.
    [[nodiscard]] Rgb meanRadiance() const noexcept { return mean_; }

private:
    [[nodiscard]] double texelWeight(int x, int y) const noexcept;
    [[nodiscard]] double rowSolidAngle(int y) const noexcept;
    void computeMean();
    void buildTables();

    Rgb constant_{0.0F}, mean_{0.0F};
    Image map_;
    int cell_ = 1;  ///< a cell of the tables covers cell_ x cell_ texels: bounds the memory for huge maps
    int cellRows_ = 0, cellColumns_ = 0;
    double total_ = 0.0;                      ///< integral of the weights over the sphere
    std::vector<double> rowCosine_;           ///< cos(theta) of the texel rows' edges, top to bottom
    std::vector<double> rowCdf_, columnCdf_;  ///< of the sampling density; see environment.cpp
};

}  // namespace pellucid

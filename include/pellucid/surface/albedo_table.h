/// How much light a coat of GGX facets sends back, bounded from above, so that the diffuse base under it never gets
/// more than the rest. The coat's Fresnel term is linear in the exact curve x of its ior (surface/fresnel.h), so its
/// directional albedo is E = f90 (f0 E1 + (1 - f0) Ex) with E1 for F = 1 and Ex for F = x. Each is bounded by e0 + e1
/// (1 - c)^5: the form that DiffuseLobe needs. **Bias**: none; the bound's slack is energy that the material absorbs (a
/// modelling choice).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace pellucid {

/// E(c) <= e0 + e1 (1 - c)^5 for every cosine c in [0, 1]; e1 >= 0 and e0 + e1 <= 1.
struct AlbedoBound {
    float e0 = 1.0F, e1 = 0.0F;

    [[nodiscard]] float at(float cosTheta) const noexcept {
        const float s = 1.0F - cosTheta, s2 = s * s;
        return e0 + e1 * s2 * s2 * s;
    }
};

/// Bounds over roughness for one Fresnel curve. A node holds for both intervals beside it, so that what lies between
/// two nodes holds as well.
class AlbedoTable {
public:
    static constexpr int kSteps = 32;

    AlbedoTable() = default;
    /// Integrates over facets (0.5 million of them, some ms). `eta` 0: Schlick's curve; negative: F = 1.
    explicit AlbedoTable(float eta);

    [[nodiscard]] AlbedoBound smooth() const noexcept { return smooth_; }
    [[nodiscard]] AlbedoBound rough(float roughness) const noexcept;

private:
    AlbedoBound smooth_;
    std::array<AlbedoBound, kSteps> nodes_{};
};

/// One table for each distinct ior of the scene's materials and the one for F = 1.
class AlbedoTables {
public:
    /// Index of the ior's table, made when it is new.
    std::size_t add(float ior);

    /// Bound of the coat's albedo in its most reflecting channel. `delta`: a smooth coat.
    [[nodiscard]] AlbedoBound coat(std::size_t table, float f0, float f90, float roughness, bool delta) const noexcept;

private:
    AlbedoTable one_;  ///< for F = 1; made with the first ior
    std::vector<float> iors_;
    std::vector<AlbedoTable> curves_;
};

/// Directional albedo of GGX facets under a Fresnel curve: `n` x `n` points over the visible normals. `eta` as in
/// AlbedoTable.
[[nodiscard]] double ggxAlbedo(float cosTheta, float alpha, float eta, int n);

}  // namespace pellucid

/// The reference for caustics that are themselves seen in a mirror or through glass, E S+ D S+ L, and for what those make in
/// turn, E S+ D S+ D S+ L: light paths fill fine texels on the receivers in double precision, eye paths look through their S
/// chain at them. Every light is seen, point lights too. Bias enters here, and only by the box of a texel, h^2 lap E / 24 to
/// first order: each look-up is made at h and at h/2 and extrapolated, (4 E(h/2) - E(h)) / 3; what the extrapolation moved is
/// the error bar.
///
/// Texels are congruent parts of the triangles themselves, so that their areas are exact and no light is lost at an edge.
/// Only those that an eye path has looked at are kept: each counts the passes since then.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <pellucid/math/hash.h>
#include <pellucid/scene/scene.h>
#include <pellucid/transport/light_trace.h>
#include <pellucid/transport/seen_receivers.h>

namespace pellucid {

class TexelIrradiance {
public:
    /// `width`: of a coarse texel (h), scene units. `path`: the class, E S+ D ...
    TexelIrradiance(const Scene& scene, const Camera& camera, float width, PathString path)
        : scene_(scene), camera_(camera), width_(width), path_(path) {}

    /// One iteration, part one: keeps the texels that eye paths look at. `seen` must outlive part three.
    void look(const std::vector<SeenReceiver>& seen, std::uint32_t pass);
    /// Part two: the light of a pass that arrives over S lobes. In the order of the paths.
    void deposit(const std::vector<CausticArrival>& arrivals, std::uint32_t pass);
    /// Part three: what the eye paths of part one see, as splats of the class. Odd and even passes never mix.
    void resolve(std::uint32_t pass, std::vector<LightSplat>& splats);

    [[nodiscard]] std::size_t texels() const noexcept { return texels_.size() * 4; }
    /// Share by which extrapolation changed the class's energy, root mean square over blocks of 16 x 16 pixels.
    [[nodiscard]] double extrapolated() const noexcept;

private:
    /// A coarse texel: one of n^2 parts of one side of a triangle.
    struct Key {
        std::uint32_t geometry = 0, primitive = 0;
        std::uint32_t row = 0, column = 0;  ///< lowest bit of row: upper half; of column: back side
        bool operator==(const Key&) const = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& k) const noexcept {
            return hashCombine(static_cast<std::uint64_t>(k.geometry) << 32U | k.primitive,
                               static_cast<std::uint64_t>(k.row) << 32U | k.column);
        }
    };
    struct Texel {
        double sum[2][4][6] = {};  ///< odd or even passes; quarter; E and E5 (surface/bsdf.h), W
        std::uint32_t firstPass = 0;
        double area = 0.0;  ///< of the whole texel
    };
    struct Place {
        Key key;
        std::uint32_t quarter = 0;
        double area = 0.0;
    };
    struct Look {
        Place place;
        const SeenReceiver* seen = nullptr;
    };
    [[nodiscard]] Place placeOf(std::uint32_t geometry, std::uint32_t primitive, const glm::vec2& barycentric,
                                bool back) const noexcept;

    const Scene& scene_;
    const Camera& camera_;
    float width_;
    PathString path_;
    std::unordered_map<Key, Texel, KeyHash> texels_;
    std::vector<Look> looks_;
    std::vector<std::array<double, 2>> seen_;  ///< by pixel: sums of luminance at h and extrapolated
};

}  // namespace pellucid

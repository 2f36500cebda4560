/// Are caustics better left to chance? Where lamps are large (a sky, a window), paths that meet the lamp over the caster
/// resolve a caustic with less noise than photons, and without bias. In the first iterations a quarter of the pixels takes
/// each sample both ways: by the photon map, and by S chains behind the cache (transport/path_classes.h). Their noise,
/// weighed by the rays that it takes, decides; but only if chance has met the caustics often enough to know its own noise,
/// and found as much light in them as the photons did. Counted in rays, so that every machine decides alike.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <pellucid/render/film.h>
#include <pellucid/scene/scene.h>

#include <pellucid/render/plan.h>

namespace pellucid {

/// Rays of one iteration.
struct TrialCosts {
    double photonRays = 0.0;          ///< in units of an eye ray's time
    double eyeRays = 0.0;             ///< of the image by the map
    double chanceRays = 0.0;          ///< of the image by chains
};

struct TrialVerdict {
    bool byChance = false;
    std::string reason;
};

class CausticTrial {
public:
    static constexpr std::uint32_t kIterations = 4;

    CausticTrial(int width, int height);

    /// Pixels that take part: a quarter of all.
    [[nodiscard]] static constexpr bool takes(int x, int y) noexcept { return (x & 1) == 0 && (y & 1) == 0; }
    /// A sample by chance: its luminance, and the part that S chains brought. Only the thread that owns the pixel.
    void add(int x, int y, double luminance, double chains) noexcept;

    /// After kIterations; `film` has taken the same pixels by the map.
    [[nodiscard]] TrialVerdict judge(const Film& film, const TrialCosts& costs) const;

    /// For checkpoints. restore: false when the bytes do not fit.
    [[nodiscard]] std::vector<char> save() const;
    [[nodiscard]] bool restore(const std::vector<char>& bytes);

private:
    struct Sums {
        double luminance = 0.0, square = 0.0;
        double chains = 0.0, chainSquares = 0.0, chainFourths = 0.0;
    };
    int width_, height_;
    std::vector<Sums> sums_;
};

/// Mean share of the directions over a surface in which lamps lie that a path can meet, of what the camera sees; occlusion
/// left aside. 0: points and suns alone.
[[nodiscard]] double lampShare(const Scene& scene, const Survey& seen);

}  // namespace pellucid

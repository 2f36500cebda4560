/// What became of photon paths, by the lamp where they began and the casters that they met: the figures behind "why is there
/// no caustic?". Filled by the pilot alone; a pass that is not asked to count does not pay for it. Counts are integers that
/// commute, so they are the same at any number of threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include <pellucid/scene/scene.h>

namespace pellucid {

/// Paths of one lamp that met one caster.
struct CasterFate {
    std::uint64_t hit = 0;        ///< met it
    std::uint64_t deposited = 0;  ///< went on and left a caustic photon on a diffuse surface
    std::uint64_t useful = 0;     ///< left one where the camera looks
    std::uint64_t escaped = 0;    ///< left none: went out of the scene
};

/// Light sources that belong together: a punctual light, all triangles of an emissive material, the environment.
struct TalliedLamp {
    std::string name;
    LightKind kind = LightKind::Point;
    std::uint32_t source = 0;           ///< of the description's lights (punctual) or materials (triangles); kUnknown
    std::vector<std::uint32_t> lights;  ///< numbers in scene.lights()
    double power = 0.0;                 ///< W
    static constexpr std::uint32_t kUnknown = ~0U;
};

/// A material that casts caustics, or would if it were smoother.
struct TalliedCaster {
    std::string name;
    std::vector<std::uint32_t> materials;  ///< one, but for the last caster of a scene with very many
    bool smooth = true;                    ///< has a lobe that casts
    float roughness = 0.0F;
};

/// Where a stored photon came from.
struct PhotonOrigin {
    glm::vec3 position{0.0F};   ///< where it lies, scene units
    std::uint32_t lamp = 0;     ///< of CasterTally::lamps()
    std::uint64_t casters = 0;  ///< that its path met, a bit each
};

class CasterTally {
public:
    explicit CasterTally(const Scene& scene);

    /// One path while it is traced: sets of casters, a bit each.
    struct Path {
        std::uint64_t met = 0, deposited = 0, useful = 0;
        void leavePhoton(bool seen) noexcept {
            deposited |= met;
            if (seen) useful |= met;
        }
    };
    void meet(Path& path, std::uint32_t material) const noexcept { path.met |= bits_[material]; }
    [[nodiscard]] PhotonOrigin originOf(const glm::vec3& position, std::uint32_t light,
                                        const Path& path) const noexcept {
        return {position, lampOf_[light], path.met};
    }
    /// At its end. `vertices`: how many surfaces it met.
    void add(std::uint32_t light, const Path& path, int vertices, bool escaped) noexcept;

    [[nodiscard]] const std::vector<TalliedLamp>& lamps() const noexcept { return lamps_; }
    [[nodiscard]] const std::vector<TalliedCaster>& casters() const noexcept { return casters_; }
    [[nodiscard]] std::uint64_t emitted(std::size_t lamp) const noexcept;
    /// Paths of the lamp that met nothing at all.
    [[nodiscard]] std::uint64_t missed(std::size_t lamp) const noexcept;
    [[nodiscard]] CasterFate fate(std::size_t lamp, std::size_t caster) const noexcept;

private:
    enum Count : std::size_t { kHit, kDeposited, kUseful, kEscaped, kCounts };
    void findLamps(const Scene& scene);
    void findCasters(const Scene& scene);
    [[nodiscard]] std::size_t cell(std::size_t lamp, std::size_t caster) const noexcept {
        return (lamp * casters_.size() + caster) * kCounts;
    }

    std::vector<TalliedLamp> lamps_;
    std::vector<TalliedCaster> casters_;
    std::vector<std::uint32_t> lampOf_;  ///< by light
    std::vector<std::uint64_t> bits_;    ///< by material
    std::vector<std::atomic<std::uint64_t>> emitted_, missed_, counts_;
};

}  // namespace pellucid

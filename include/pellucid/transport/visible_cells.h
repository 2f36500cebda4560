/// Which parts of space the camera sees at D vertices, on a coarse grid: a photon that lands elsewhere is of no use to the
/// caustic map. A false "seen" costs a photon, a false "unseen" its light.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include <pellucid/math/hash.h>

namespace pellucid {

class VisibleCells {
public:
    explicit VisibleCells(float cellSize) : inverseSize_(1.0F / cellSize), bits_(kBits / 64, 0) {}

    /// Marks the cells within `reach` of the point: a kernel there may ask for photons that far away.
    void mark(const glm::vec3& p, float reach) noexcept {
        const glm::ivec3 from = cell(p - reach), to = cell(p + reach);
        for (int z = from.z; z <= to.z; ++z)
            for (int y = from.y; y <= to.y; ++y)
                for (int x = from.x; x <= to.x; ++x) {
                    const std::uint64_t h = slot({x, y, z});
                    bits_[h >> 6U] |= std::uint64_t{1} << (h & 63U);
                }
    }

    [[nodiscard]] bool seen(const glm::vec3& p) const noexcept { return test(cell(p)); }

private:
    static constexpr std::uint64_t kBits = 1U << 21U;
    [[nodiscard]] glm::ivec3 cell(const glm::vec3& p) const noexcept {
        return glm::ivec3(glm::floor(p * inverseSize_));
    }
    [[nodiscard]] static std::uint64_t slot(const glm::ivec3& c) noexcept {
        const auto u = [](int v) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(v)); };
        return hash64(u(c.x) * 0x9e3779b97f4a7c15ULL ^ u(c.y) * 0xc2b2ae3d27d4eb4fULL ^
                      u(c.z) * 0x165667b19e3779f9ULL) &
               (kBits - 1);
    }
    [[nodiscard]] bool test(const glm::ivec3& c) const noexcept {
        const std::uint64_t h = slot(c);
        return ((bits_[h >> 6U] >> (h & 63U)) & 1U) != 0;
    }
    float inverseSize_;
    std::vector<std::uint64_t> bits_;
};

}  // namespace pellucid

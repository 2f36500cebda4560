/// Where lamps are half hidden: blocks of pixels in which some shadow rays have met their lamp and others something before it.
/// There the lamps' light is the noise of a picture whose other light comes from maps, so from the next iteration on receivers
/// sample the lamps several times: a shadow ray costs a fraction of the eye path that it stands on. Nothing is biased: how
/// many are taken follows from samples that went before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <pellucid/transport/walk.h>

namespace pellucid {

class Penumbrae {
public:
    Penumbrae(int width, int height)
        : across_((width + kBlock - 1) / kBlock),
          blocks_(static_cast<std::size_t>(across_) * static_cast<std::size_t>((height + kBlock - 1) / kBlock), 0) {}

    /// At each served receiver of the pixel.
    [[nodiscard]] int lampSamples(int x, int y) const noexcept {
        return blocks_[blockOf(x, y)] == (kSeen | kHidden) ? kSamples : 1;
    }
    /// Blocks lie within tiles, so that no two threads meet in one.
    void met(int x, int y, const ShadowTally& shadows) noexcept {
        blocks_[blockOf(x, y)] |= static_cast<char>((shadows.seen ? kSeen : 0) | (shadows.hidden ? kHidden : 0));
    }

    /// For checkpoints. restore: false when the bytes do not fit.
    [[nodiscard]] const std::vector<char>& save() const noexcept { return blocks_; }
    [[nodiscard]] bool restore(const std::vector<char>& bytes) {
        if (bytes.size() != blocks_.size()) return false;
        blocks_ = bytes;
        return true;
    }

private:
    static constexpr int kBlock = 2, kSamples = 4;
    static constexpr char kSeen = 1, kHidden = 2;
    [[nodiscard]] std::size_t blockOf(int x, int y) const noexcept {
        return static_cast<std::size_t>(y / kBlock * across_ + x / kBlock);
    }
    int across_;
    std::vector<char> blocks_;
};

}  // namespace pellucid

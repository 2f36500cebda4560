/// The radius of the caustic kernel, pixel by pixel, from the photons themselves: it grows until it holds enough photons, or
/// until the ring that would be added does not look like the disc inside (Lepski's method: the largest radius at which no
/// smaller one contradicts the estimate). So an even glow is averaged over many pixels and a sharp edge over hardly one.
/// Neighbours smooth what chance has ended, but not an edge beyond doubt, which no kernel of that place may cross. Bias enters
/// here: what the test cannot tell from even light is blurred. [Lepski1991]
#pragma once

#include <vector>

#include <pellucid/base/parallel.h>
#include <pellucid/transport/caustic_map.h>
#include <pellucid/transport/walk.h>

namespace pellucid {

struct KernelRadiusOptions {
    float smallest = 0.7F, largest = 12.0F;  ///< in pixel footprints
    double enough = 60.0;                    ///< photons (of equal power) that a kernel needs to hold
};

/// Radii at a point, in footprints.
struct KernelChoice {
    float radius = 0.0F;
    float edge = 0.0F;  ///< the same where what ended its growth is beyond doubt, else the largest
};

[[nodiscard]] KernelChoice chooseKernelRadius(const CausticMap& map, const GatherPoint& point,
                                              const KernelRadiusOptions& options) noexcept;

/// Radii of all pixels: means, in the logarithm, over the passes that they were chosen from.
class KernelRadii {
public:
    KernelRadii(int width, int height, const KernelRadiusOptions& options);

    /// Adds what `map` says at the survey's points.
    void learn(const CausticMap& map, const std::vector<GatherPoint>& points, const Workers& workers);
    /// Corrects them by what the image has shown, with b the bias of the kernels and V the variance of an iteration's
    /// photons: the error V / n + b^2 after n iterations, V ~ 1 / r^2 and b ~ r^2, is least where V / n = 2 b^2.
    /// [KaplanyanDachsbacher2013] `shown(x, y)` gives V and b^2.
    struct Shown {
        double variance = 0.0, bias2 = 0.0;
    };
    template <class Function>
    void correct(std::uint32_t iterations, const Function& shown, const Workers& workers);

    /// In footprints.
    [[nodiscard]] float at(int x, int y) const noexcept { return radii_[blockAt(x / kBlock, y / kBlock)]; }

    /// For checkpoints. restore: false when the bytes do not fit.
    [[nodiscard]] std::vector<char> save() const;
    [[nodiscard]] bool restore(const std::vector<char>& bytes, const Workers& workers);

private:
    /// How far the points of the next pixels are from this one's, in footprints: many, where the view grazes.
    [[nodiscard]] float toNextPixels(const std::vector<GatherPoint>& points, int x, int y) const;
    void smooth(const Workers& workers);
    void correctBlocks(std::uint32_t iterations, const std::vector<Shown>& blocks, const Workers& workers);
    [[nodiscard]] std::size_t blockAt(int bx, int by) const noexcept {
        return static_cast<std::size_t>(by) * static_cast<std::size_t>(blocksX_) + static_cast<std::size_t>(bx);
    }
    static constexpr int kBlock = 2;  ///< pixels that share a radius, a side
    int width_, height_, blocksX_, blocksY_, passes_ = 0;
    KernelRadiusOptions options_;
    std::vector<float> logRadius_;  ///< by block: the newest pass counts half, as the guide gets better
    std::vector<float> logFactor_;  ///< by block: what the image's own noise and bias have corrected
    std::vector<float> logEdge_;    ///< by block: no further, an edge lies there
    std::vector<float> radii_;      ///< by block; smoothed
};

template <class Function>
void KernelRadii::correct(std::uint32_t iterations, const Function& shown, const Workers& workers) {
    std::vector<Shown> blocks(logRadius_.size());
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            const Shown s = shown(x, y);
            Shown& block = blocks[blockAt(x / kBlock, y / kBlock)];
            block.variance += s.variance;
            block.bias2 += s.bias2;
        }
    correctBlocks(iterations, blocks, workers);
}

}  // namespace pellucid

/// The film: sums of the samples of every pixel by path class, in double. A pixel's samples are added in one order, whatever
/// the number of threads. Two interleaved halves of the samples tell how far the mean still is from its limit.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <pellucid/math/image.h>
#include <pellucid/render/render.h>
#include <pellucid/transport/light_trace.h>
#include <pellucid/transport/path_classes.h>
#include <pellucid/transport/walk.h>

namespace pellucid {

class Film {
public:
    Film(int width, int height);

    /// Adds a sample of `pixel`. Values that are not finite are counted and left out. Only the thread that owns the pixel.
    void add(std::size_t pixel, std::uint32_t sample, const LayeredRadiance& radiance, const FirstHit& first) noexcept;
    /// Adds splats of the caustic class, in their order. `pass` counts light passes.
    void addSplats(const std::vector<LightSplat>& splats, std::uint32_t pass) noexcept;
    /// Tells that every pixel has got one more sample (splats count apart).
    void countSamples(std::uint32_t samples) noexcept { samples_ += samples; }

    [[nodiscard]] int width() const noexcept { return width_; }
    [[nodiscard]] int height() const noexcept { return height_; }
    [[nodiscard]] std::size_t pixels() const noexcept { return pixels_.size(); }
    [[nodiscard]] std::uint32_t samples() const noexcept { return samples_; }

    /// The mean: R G B, the four layers, and the auxiliary `layers` asked for.
    [[nodiscard]] Image image(const std::vector<std::string>& layers) const;
    /// Root of the relmse of the mean, estimated from its two halves (noise only, not bias).
    [[nodiscard]] double relativeError() const noexcept;
    /// Of the mean so far, all classes.
    [[nodiscard]] double luminance(int x, int y) const noexcept;
    [[nodiscard]] double meanLuminance() const noexcept;
    [[nodiscard]] NonFinite nonfinite() const noexcept;

    /// For checkpoints: the raw state.
    [[nodiscard]] std::vector<char> save() const;
    /// False when the bytes do not fit this film.
    [[nodiscard]] bool restore(const std::vector<char>& bytes);

private:
    struct Pixel {
        double layer[kPathClasses][3] = {};
        double half[3] = {};          ///< samples with odd index
        double splat[3] = {};
        double splatHalf[3] = {};
        double square = 0.0;          ///< of the luminance
        float albedo[3] = {}, normal[3] = {};
        float depth = 0.0F, radius = 0.0F;
        std::uint32_t nonfinite = 0, firstNonfinite = 0;
    };
    [[nodiscard]] Rgb mean(const Pixel& p, int layer) const noexcept;
    int width_, height_;
    std::uint32_t samples_ = 0, splatPasses_ = 0;
    std::vector<Pixel> pixels_;
};

/// Names that --layers takes beyond the four that are always there.
[[nodiscard]] const std::vector<std::string>& auxiliaryLayers() noexcept;

}  // namespace pellucid

/// The film: sums of the samples of every pixel by path class, in double. A pixel's samples are added in one order, whatever
/// the number of threads. Two interleaved halves of the samples tell how far the mean still is from its limit.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <pellucid/math/image.h>
#include <pellucid/render/render.h>
#include <pellucid/transport/light_trace.h>
#include <pellucid/transport/path_classes.h>
#include <pellucid/transport/walk.h>

namespace pellucid {

/// What a pixel has shown so far. Variances are of one sample, not of the mean.
struct PixelNoise {
    float eyeVariance = 0.0F;     ///< of the luminance of an eye sample, (W m^-2 sr^-1)^2
    float photonVariance = 0.0F;  ///< of the luminance that an iteration's photons give
    float blur2 = 0.0F;           ///< square of the kernels' bias, free of its own noise: may be negative
    float luminance = 0.0F;
    float rays = 1.0F;   ///< of an eye sample
    bool inside = true;  ///< false: not rendered
};

class Film {
public:
    Film(int width, int height);

    /// Keeps radiance by path string, too, for a scene of these lobes (layer "classes"). Before the first sample.
    void keepStrings(LobeKinds kinds);
    [[nodiscard]] bool keepsStrings() const noexcept { return !stringSlots_.empty(); }

    /// Whether a sample is finite; one that is not is counted, and has to be left out. Only the thread that owns the pixel.
    [[nodiscard]] bool admit(std::size_t pixel, std::uint32_t iteration, const LayeredRadiance& radiance) noexcept;
    /// Adds the mean of the samples that `pixel` took in an iteration, if it is finite. Only the thread that owns the pixel.
    void add(std::size_t pixel, std::uint32_t iteration, const LayeredRadiance& radiance, const FirstHit& first,
             int samples = 1, std::uint64_t rays = 0) noexcept;
    /// Adds the splats of a light pass, in their order. `pass` counts light passes.
    void addSplats(const std::vector<LightSplat>& splats, std::uint32_t pass) noexcept;
    /// Of the iterations to come in every pixel's mean. A weight of all pixels, from the noise of all: a pixel's own noise
    /// moves it by about one part in their number, and that is the bias of the mean.
    void setWeight(double weight) noexcept { terms_.weight = weight; }
    [[nodiscard]] double weight() const noexcept { return terms_.weight; }
    /// Tells that an iteration is over: every pixel has got one more term (splats count apart).
    void countSamples(std::uint32_t samples) noexcept { terms_.add(samples); }

    /// How many samples `pixel` takes in an iteration to come, and how many it has taken.
    [[nodiscard]] int share(std::size_t pixel) const noexcept { return pixels_[pixel].share; }
    [[nodiscard]] std::uint32_t taken(std::size_t pixel) const noexcept { return pixels_[pixel].taken; }
    void setShares(const std::vector<std::uint8_t>& shares) noexcept;
    [[nodiscard]] std::vector<std::uint8_t> shares() const;
    [[nodiscard]] std::uint64_t taken() const noexcept;
    /// What `pixel` has shown of its noise. From two iterations on.
    [[nodiscard]] PixelNoise noise(std::size_t pixel) const noexcept;

    [[nodiscard]] int width() const noexcept { return width_; }
    [[nodiscard]] int height() const noexcept { return height_; }
    [[nodiscard]] std::size_t pixels() const noexcept { return pixels_.size(); }
    /// Iterations: terms of every pixel's mean.
    [[nodiscard]] std::uint32_t samples() const noexcept { return terms_.count; }

    /// The mean: R G B, the four layers, and the auxiliary `layers` asked for.
    [[nodiscard]] Image image(const std::vector<std::string>& layers) const;
    /// Root of the relmse of the mean: its noise, from its two halves; the blur of the photons' kernels; and the noise of the
    /// cache's records, which both halves have in common. The bias of their interpolation is not seen.
    [[nodiscard]] double relativeError() const noexcept {
        return std::sqrt(relativeNoise2() + relativeBlur2() + relativeRecordNoise2());
    }
    [[nodiscard]] double relativeNoise2() const noexcept;
    /// Of the mean, without the noise of its own estimate: the product of that from odd and from even iterations.
    [[nodiscard]] double relativeBlur2() const noexcept;
    /// Of the mean over the records' generations: each pixel has carried a draw of their error along.
    [[nodiscard]] double relativeRecordNoise2() const noexcept;
    /// Of the mean so far, all classes.
    [[nodiscard]] double luminanceAt(int x, int y) const noexcept;
    [[nodiscard]] double meanLuminance() const noexcept;
    /// Part of a pixel's luminance that is indirect light, on the mean over pixels; darkness counts as a tenth of the image's mean.
    [[nodiscard]] double indirectShare() const noexcept;
    [[nodiscard]] NonFinite nonfinite() const noexcept;

    /// For checkpoints: the raw state.
    [[nodiscard]] std::vector<char> save() const;
    /// False when the bytes do not fit this film.
    [[nodiscard]] bool restore(const std::vector<char>& bytes);

private:
    /// The terms of every pixel's mean, one an iteration.
    struct Terms {
        std::uint32_t count = 0;
        double weight = 1.0;  ///< of those to come
        /// Of the weights so far: all, of odd iterations; of their squares.
        double sum = 0.0, odd = 0.0, squares = 0.0;

        void add(std::uint32_t terms) noexcept {
            odd += weight * ((count + terms) / 2 - count / 2);
            count += terms;
            sum += weight * terms;
            squares += weight * weight * terms;
        }
        /// To divide sums by, also where there is nothing yet.
        [[nodiscard]] double divisor() const noexcept { return count > 0 ? sum : 1.0; }
    };
    struct Pixel {
        double layer[kPathClasses][3] = {};  ///< weighed, as all sums but those that say otherwise
        double half[3] = {};                 ///< of odd iterations
        double splat[kPathClasses][3] = {};
        double splatHalf[3] = {};
        /// Of the luminance of an iteration's mean, by the weight's square.
        double squareSum = 0.0, squareSquare = 0.0;
        /// Of the luminance without what photons gave, weighed by the number of samples.
        double eyeSum = 0.0, eyeSquare = 0.0;
        double sharedSum = 0.0, sharedSquare = 0.0;  ///< of the luminance that photons gave, unweighed
        double blur = 0.0, blurHalf = 0.0;
        double recordNoise = 0.0;
        std::uint64_t rays = 0;
        std::uint32_t taken = 0;
        std::uint8_t share = 1;
        double splatSquare = 0.0;              ///< of the luminance of a pass's splats
        float splatPass = 0.0F;                ///< while a pass is added
        float albedo[3] = {}, normal[3] = {};  ///< these unweighed
        float depth = 0.0F, radius = 0.0F, photons = 0.0F;
        std::uint32_t nonfinite = 0, firstNonfinite = 0;
    };
    [[nodiscard]] Rgb mean(const Pixel& p, int layer) const noexcept;
    [[nodiscard]] double luminanceOf(const Pixel& p) const noexcept;
    [[nodiscard]] double variance(const Pixel& p) const noexcept;
    [[nodiscard]] double blur2(const Pixel& p) const noexcept;
    /// Of what `square` says of pixels, relative to the squares of their luminance: the mean over them.
    template <class Square>
    [[nodiscard]] double relative(const Square& square) const noexcept;
    [[nodiscard]] std::size_t savedSize() const noexcept;
    [[nodiscard]] double stringMean(std::size_t slot, std::size_t pixel, std::size_t channel) const noexcept;
    /// Strings that have radiance somewhere, as (slot, name).
    [[nodiscard]] std::vector<std::pair<std::size_t, std::string>> litStrings() const;
    int width_, height_;
    Terms terms_;
    std::uint32_t splatPasses_ = 0;
    std::vector<Pixel> pixels_;
    std::vector<PathString> stringSlots_;  ///< empty: not kept
    std::array<std::int16_t, PathString::kCodes> slotOf_{};
    std::vector<double> strings_, splatStrings_;  ///< sums, by slot, pixel, channel
};

/// Names that --layers takes beyond the four that are always there.
[[nodiscard]] const std::vector<std::string>& auxiliaryLayers() noexcept;

}  // namespace pellucid

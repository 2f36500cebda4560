#include <pellucid/surface/dispersion.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace pellucid {

namespace {

constexpr int kSteps = 330;  // of a nm
constexpr float kStep = (kLongestWave - kShortestWave) / kSteps;

/// A lobe of a colour matching function: a Gaussian of two widths.
[[nodiscard]] double lobe(double nm, double middle, double below, double above) noexcept {
    const double t = (nm - middle) / (nm < middle ? below : above);
    return std::exp(-0.5 * t * t);
}

/// Linear Rec.709 of a spectral line, without what is negative. CIE 1931 by [WymanSloanShirley2013, eqs. 2 to 4].
[[nodiscard]] glm::dvec3 spectral(double nm) noexcept {
    const double x =
        1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) - 0.065 * lobe(nm, 501.1, 20.4, 26.2);
    const double y = 0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1);
    const double z = 1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8);
    return glm::max(glm::dvec3(3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z,
                               0.0557 * x - 0.2040 * y + 1.0570 * z),
                    glm::dvec3(0.0));
}

/// The channels at the middles of the steps, each with the integral 1, and the distribution of their mean.
struct Spectrum {
    std::array<Rgb, kSteps> channels;           ///< per nm
    std::array<double, kSteps + 1> cumulative;  ///< of their mean

    Spectrum() noexcept : channels{}, cumulative{} {
        const auto at = [](int i) {
            return spectral(static_cast<double>(kShortestWave) + (i + 0.5) * static_cast<double>(kStep));
        };
        glm::dvec3 whole(0.0);
        for (int i = 0; i < kSteps; ++i) whole += at(i) * static_cast<double>(kStep);
        for (int i = 0; i < kSteps; ++i) {
            const glm::dvec3 share = at(i) / whole;
            const auto k = static_cast<std::size_t>(i);
            channels[k] = Rgb(share);
            cumulative[k + 1] = cumulative[k] + (share.r + share.g + share.b) / 3.0 * static_cast<double>(kStep);
        }
        cumulative.back() = 1.0;
    }
    [[nodiscard]] static const Spectrum& get() noexcept {
        static const Spectrum spectrum;
        return spectrum;
    }
};

}  // namespace

float iorAt(float ior, float dispersion, Wave wave) noexcept {
    if (!wave.chosen() || !(dispersion > 0.0F)) return ior;
    const double nm = static_cast<double>(wave.nanometres), abbe = 20.0 / static_cast<double>(dispersion);
    const double n = static_cast<double>(ior);
    return static_cast<float>(std::max(1.0, n + (n - 1.0) / abbe * (523655.0 / (nm * nm) - 1.5168)));
}

Rgb channelsAt(float nanometres) noexcept {
    const int step = static_cast<int>(std::floor((nanometres - kShortestWave) / kStep));
    return step < 0 || step >= kSteps ? Rgb(0.0F) : Spectrum::get().channels[static_cast<std::size_t>(step)];
}

WaveSample sampleWave(float u) noexcept {
    const Spectrum& s = Spectrum::get();
    const auto target = static_cast<double>(u);
    const auto after = std::upper_bound(s.cumulative.begin() + 1, s.cumulative.end() - 1, target);
    const auto step = static_cast<std::size_t>(after - s.cumulative.begin()) - 1;
    const double below = s.cumulative[step], width = s.cumulative[step + 1] - below;
    const double within = width > 0.0 ? std::clamp((target - below) / width, 0.0, 1.0) : 0.5;
    const Rgb& channels = s.channels[step];
    const float mean = (channels.r + channels.g + channels.b) / 3.0F;
    return {{kShortestWave + kStep * (static_cast<float>(step) + static_cast<float>(within))}, channels / mean};
}

}  // namespace pellucid

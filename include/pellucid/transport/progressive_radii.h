/// How the radius of each pixel's kernel shrinks, by what the pixel itself has met: stochastic progressive photon mapping.
/// [HachisukaJensen2009]
///
/// A pixel keeps N, the photons that it has counted, and R^2. After an iteration that met M photons
///     N' = N + alpha M,   R'^2 = R^2 N' / (N + M),   tau' = (tau + Phi) R'^2 / R^2,   L = tau / (pi R^2 N_emitted).
/// tau / R^2 is the sum over the iterations of Phi_i / R_i^2: the mean of the single iterations' estimates, each with the
/// radius that it had, which is what the film holds already. So N and R^2 are all that has to be kept.
///
/// Or by a test: as long as chi^2 does not tell the photons in the disc from even light, the radius stays [Lin2020]. Then what
/// has been met since the last change is kept instead of N.
///
/// Bias enters by R: it tends to 0 where photons keep coming (by test: where light is not even).
#pragma once

#include <cstddef>
#include <vector>

#include <pellucid/transport/kernel_tally.h>

namespace pellucid {

enum class Shrink { Alpha, ChiSquare };

class ProgressiveRadii {
public:
    ProgressiveRadii(std::size_t pixels, Shrink by, double alpha);

    /// Of the radius, against the first one.
    [[nodiscard]] float scale(std::size_t pixel) const noexcept;
    /// The look-up of this iteration is over. Only the thread that owns the pixel.
    void update(std::size_t pixel, const KernelTally& met) noexcept;

    /// For checkpoints. restore: false when the bytes do not fit.
    [[nodiscard]] std::vector<char> save() const;
    [[nodiscard]] bool restore(const char* bytes, std::size_t size);

private:
    struct State {
        float scale2 = 1.0F;
        float counted = 0.0F;  ///< N; by test: photons that the next one waits for
    };
    Shrink by_;
    double alpha_;
    std::vector<State> pixels_;
    std::vector<KernelTally> evidence_;  ///< by test only
};

}  // namespace pellucid

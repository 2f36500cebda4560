/// The energy account of a photon pass: every watt that a lamp emits ends in exactly one of these sinks. It follows the flux
/// along each path, in double, so what is emitted and the sum of the sinks differ by rounding alone, or there is a place
/// where flux is lost or made.
#pragma once

namespace pellucid {

/// Watts (mean of the colours, per pass), each sink a statistical estimate of its own.
struct EnergyBalance {
    double emitted = 0.0;
    double escaped = 0.0;   ///< left the scene
    double absorbed = 0.0;  ///< by surfaces and by the bodies that the light passes
    double stored = 0.0;    ///< ended where this pass keeps a photon (or a splat)
    double left = 0.0;      ///< ended at a receiver where another estimator carries it
    double roulette = 0.0;  ///< ended by chance, less what the survivors were given: 0 on average
    double dropped = 0.0;  ///< arrived so flatly that its correction for shading normals explodes: the pass's only loss

    [[nodiscard]] double accounted() const noexcept { return escaped + absorbed + stored + left + roulette + dropped; }
    /// What is missing, as a share of what was emitted.
    [[nodiscard]] double residual() const noexcept {
        return emitted > 0.0 ? (accounted() - emitted) / emitted : accounted();
    }
    /// Adds `share` of another account.
    void add(const EnergyBalance& other, double share = 1.0) noexcept {
        emitted += share * other.emitted;
        escaped += share * other.escaped;
        absorbed += share * other.absorbed;
        stored += share * other.stored;
        left += share * other.left;
        roulette += share * other.roulette;
        dropped += share * other.dropped;
    }
};

}  // namespace pellucid

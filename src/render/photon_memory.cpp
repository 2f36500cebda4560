#include "photon_memory.h"

#include <algorithm>

#include <fmt/format.h>

#include <pellucid/transport/photon_trace.h>

#include "other_side.h"

namespace pellucid {

namespace {

/// Bytes a photon at the peak of a caustic pass: the last map, the chunks of the new one, their sum, and what the guide learns
/// from. Measured: 281 when a photon had 48 bytes of its own (docs/benchmarks.md).
constexpr double kCausticBytes = 340.0;
/// Of a global pass: chunks, their sum, and the sorted copy under the tree. Measured: 104.
constexpr double kGlobalBytes = 160.0;
/// The peaks are at different times; while global photons are made the caustic map, 70 bytes a photon, stays.
constexpr double kGlobalShare = 0.75;
/// Progressive photon mapping has two maps at a time.
constexpr double kSppmShare = 0.5;
constexpr std::uint32_t kTrialPaths = 4096;
constexpr std::uint64_t kTrialPass = 0x6d656d6f7279ULL;
/// The trial's photons a path are a sample; so much more is allowed for.
constexpr double kMargin = 1.1;

[[nodiscard]] FittedPaths fit(std::uint32_t wanted, double share, const RenderRequest& request, double bytesPerPhoton,
                              double photonsPerPath) {
    const double megabytes = share * request.settings.photonMemory;
    const double bytesPerPath = bytesPerPhoton * std::max(photonsPerPath, 1e-3);
    FittedPaths fitted;
    fitted.most = static_cast<std::uint32_t>(std::clamp(megabytes * 1e6 / bytesPerPath, 1.0, 4e9));
    fitted.paths = std::min(wanted, fitted.most);
    if (fitted.paths < wanted)
        fitted.remark = fmt::format(
            "photon.memory: {} paths wanted, {} fit in {:.4g} MB at up to {:.3g} photons a path and {:.0f} bytes a "
            "photon",
            wanted, fitted.paths, megabytes, photonsPerPath, bytesPerPhoton);
    return fitted;
}

[[nodiscard]] bool limited(const RenderRequest& request) { return request.settings.photonMemory > 0.0; }

[[nodiscard]] double perPath(std::size_t photons, std::size_t paths) {
    return kMargin * static_cast<double>(photons) / static_cast<double>(std::max<std::size_t>(1, paths));
}

}  // namespace

FittedPaths fitCausticPaths(std::uint32_t wanted, const Plan& plan, const Scene& scene, const RenderRequest& request,
                            const Survey& seen, const Workers& workers) {
    if (!limited(request)) return {wanted, 0, {}};
    const EmissionGuide guide(scene.lights(), plan.training);
    const CausticPass trial =
        traceCausticPhotons(scene, guide, {request.seed, kTrialPass, kTrialPaths}, &seen.visible, workers);
    // As if every path were useful: guiding gets better.
    const double photons = std::max(1.0, perPath(trial.photons.size(), trial.useful.size()));
    return fit(wanted, request.method == Method::Sppm ? kSppmShare : 1.0, request, kCausticBytes, photons);
}

FittedPaths fitOtherPaths(std::uint32_t wanted, const Scene& scene, const RenderRequest& request, const Survey& seen,
                          const Workers& workers) {
    if (!limited(request)) return {wanted, 0, {}};
    const OtherPass trial = traceOtherPhotons(scene, {request.seed, kTrialPass + 2, kTrialPaths},
                                              visibleToOthers(scene, seen, request.settings), workers);
    return fit(wanted, kSppmShare, request, kCausticBytes, perPath(trial.photons.size(), kTrialPaths));
}

FittedPaths fitGlobalPaths(std::uint32_t wanted, const Plan& plan, const Scene& scene, const RenderRequest& request,
                           const Workers& workers) {
    if (!limited(request)) return {wanted, 0, {}};
    const GlobalPass trial = traceGlobalPhotons(scene, {request.seed, kTrialPass + 1, kTrialPaths}, workers);
    return fit(wanted, plan.causticMap ? kGlobalShare : 1.0, request, kGlobalBytes,
               perPath(trial.photons.size(), kTrialPaths));
}

}  // namespace pellucid

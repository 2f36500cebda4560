/// The renderer's front door: a scene, a request, an image and a record.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pellucid/base/log.h>
#include <pellucid/base/parallel.h>
#include <pellucid/base/progress.h>
#include <pellucid/math/image.h>
#include <pellucid/render/settings.h>
#include <pellucid/transport/energy.h>
#include <pellucid/transport/walk_trace.h>

namespace pellucid {

class Scene;

enum class Method { Photon, Path, Light, Reference, Bdpt, Sppm };

/// What a second stands for where costs are counted in rays, so that they are the same on every machine.
inline constexpr double kRaysOfNominalSecond = 2e6;

/// The first of the limits that is reached ends the render. All empty: error 0.05 with the plan's cap on time.
struct Budget {
    std::optional<double> seconds;         ///< wall time, with everything from `startedSecondsAgo` on
    std::optional<std::uint32_t> samples;  ///< per pixel
    std::optional<double> error;           ///< relative error of the image, as estimated
    std::optional<std::uint64_t> rays;     ///< of all passes together: a limit that every machine reaches alike
    double startedSecondsAgo = 0.0;        ///< what loading has taken already

    /// For plans: the time that is left, or what the limit of rays stands for; empty: there is neither.
    [[nodiscard]] std::optional<double> nominalSeconds() const noexcept;
};

/// A part of the image, half open, in pixels from the upper left corner.
struct PixelWindow {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct RenderRequest {
    Method method = Method::Photon;
    int width = 0, height = 0;  ///< 0: 512 wide, the camera's aspect
    std::string camera;         ///< name or index; empty: the first
    std::uint64_t seed = 0;
    Budget budget;
    Settings settings;
    /// Beyond the four that are always there: names of auxiliaryLayers() (render/film.h), or "all".
    std::vector<std::string> layers;
    std::filesystem::path checkpoint;  ///< empty: none
    bool resume = false;
    /// What views have learnt of the light: read if it is there, and written; empty: none.
    std::filesystem::path cacheFile;
    std::filesystem::path pointsFolder;  ///< for PLY files of records and caustic photons; empty: none
    /// Only these pixels are rendered, the rest stays black; empty: all. Plan and photons are those of the whole image, and
    /// all costs, in the budget and in the record, are scaled up to it: a cheap look at what the whole image would be.
    std::vector<PixelWindow> windows;
};

struct StageRecord {
    std::string name;
    double seconds = 0.0;
    std::uint64_t rays = 0, photonsEmitted = 0, photonsStored = 0, records = 0;
    std::uint32_t photonPasses = 0;
    EnergyBalance energy = {};  ///< of the photon passes, W: their mean in a RenderRecord
};

struct Decision {
    std::string name, choice, reason;  ///< the reason holds its number
    bool overridden = false;
};

struct NonFinite {
    std::uint64_t count = 0;
    int x = -1, y = -1;  ///< the first in pixel order
    std::uint32_t sample = 0;
};

/// What the pilot's photon paths of one lamp did at one caster (names of lights and materials), and what became of the photons
/// of a render's first iteration.
struct CausticLink {
    std::string lamp, caster;
    std::size_t lampIndex = 0, casterIndex = 0;  ///< in the scene's CasterTally
    std::uint64_t emitted = 0;                   ///< by the lamp, towards anything
    std::uint64_t hit = 0;                       ///< met the caster
    std::uint64_t deposited = 0;                 ///< and left a caustic photon on a diffuse surface
    std::uint64_t useful = 0;                    ///< and did so where the camera looks
    bool watched = false;                        ///< the first iteration was looked at
    std::uint64_t stored = 0;                    ///< photons of its first 262,144 paths that the caustic map keeps
    std::uint64_t used = 0;                      ///< of them, those that the kernel of a pixel has summed
    std::string reason;                          ///< why there is no caustic; empty where there is one
};

/// How caustics seen in mirrors and through glass were made for a reference.
struct TexelReport {
    std::size_t texels = 0;     ///< 0: they were not
    double width = 0.0;         ///< of the coarse ones, metres
    double extrapolated = 0.0;  ///< relative change of that class by extrapolating the texels' width to 0
};

/// What a render had from a cache file or from other views.
struct ReuseReport {
    bool asked = false;
    std::size_t recordsReused = 0, recordsNew = 0;  ///< of the irradiance cache, in the first generation
    std::size_t placesReused = 0, placesNew = 0;    ///< of the global map
};

struct RenderRecord {
    TexelReport texels;
    ReuseReport reuse;
    std::vector<Decision> decisions;
    /// Lamp x caster, those that matter most first; empty where no photons are planned.
    std::vector<CausticLink> causticLinks;
    std::vector<std::string> blindSpots;  ///< path classes that this method cannot see in this scene
    std::vector<StageRecord> stages;
    std::uint32_t iterations = 0, samplesPerPixel = 0;
    double seconds = 0.0;
    double errorEstimate = 0.0;  ///< relative, root of the estimated relmse
    /// Its parts, added in squares: noise, bias of the photons' kernels, noise of the cache's records.
    double noiseEstimate = 0.0, blurEstimate = 0.0, recordsEstimate = 0.0;
    NonFinite nonfinite;
    Settings resolved;
    int threads = 0;
};

struct RenderResult {
    Image image;  ///< R G B, then emission.R ... and the layers asked for
    RenderRecord record;
    bool interrupted = false;
};

[[nodiscard]] RenderResult render(const Scene& scene, const RenderRequest& request, const Workers& workers,
                                  const Progress& progress = {}, const LogSink& log = {});

/// One sample of a render again, vertex by vertex.
struct SampleReplay {
    std::vector<TracedVertex> vertices;
    std::vector<TracedVertex> lightVertices;  ///< of the light path that a bidirectional sample is joined with
    LayeredRadiance radiance;                 ///< of this pixel; what a light path adds to others is not in it
    int width = 0, height = 0;                ///< of the image that the sample belongs to
};

/// The very sample that render() would take: the iterations before it are made again as far as it depends on them. Throws
/// Error{Usage} for a pixel outside of the image or a method without eye paths of its own.
[[nodiscard]] SampleReplay replaySample(const Scene& scene, const RenderRequest& request, int x, int y,
                                        std::uint32_t sample, const Workers& workers, const Progress& progress = {});

/// What render() would do, with the cost of each pass as one iteration shows it.
[[nodiscard]] RenderRecord planOnly(const Scene& scene, const RenderRequest& request, const Workers& workers,
                                    const LogSink& log = {});

}  // namespace pellucid

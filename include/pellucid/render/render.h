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

namespace pellucid {

class Scene;

enum class Method { Photon, Path, Light, Reference, Bdpt };

/// The first of the limits that is reached ends the render. All empty: error 0.05 with the plan's cap on time.
struct Budget {
    std::optional<double> seconds;          ///< wall time, with everything from `startedSecondsAgo` on
    std::optional<std::uint32_t> samples;   ///< per pixel
    std::optional<double> error;            ///< relative error of the image, as estimated
    double startedSecondsAgo = 0.0;         ///< what loading has taken already
};

struct RenderRequest {
    Method method = Method::Photon;
    int width = 0, height = 0;              ///< 0: 512 wide, the camera's aspect
    std::string camera;                     ///< name or index; empty: the first
    std::uint64_t seed = 0;
    Budget budget;
    Settings settings;
    std::vector<std::string> layers;        ///< beyond the four that are always there: albedo, normal, depth, variance, records, radius, ... ; "all"
    std::filesystem::path checkpoint;       ///< empty: none
    bool resume = false;
};

struct StageRecord {
    std::string name;
    double seconds = 0.0;
    std::uint64_t rays = 0, photonsEmitted = 0, photonsStored = 0, records = 0;
};

struct Decision {
    std::string name, choice, reason;       ///< the reason holds its number
    bool overridden = false;
};

struct NonFinite {
    std::uint64_t count = 0;
    int x = -1, y = -1;                     ///< the first in pixel order
    std::uint32_t sample = 0;
};

/// How caustics seen in mirrors and through glass were made for a reference.
struct TexelReport {
    std::size_t texels = 0;                 ///< 0: they were not
    double width = 0.0;                     ///< of the coarse ones, metres
    double extrapolated = 0.0;              ///< relative change of that class by extrapolating the texels' width to 0
};

struct RenderRecord {
    TexelReport texels;
    std::vector<Decision> decisions;
    std::vector<std::string> blindSpots;    ///< path classes that this method cannot see in this scene
    std::vector<StageRecord> stages;
    std::uint32_t iterations = 0, samplesPerPixel = 0;
    double seconds = 0.0;
    double errorEstimate = 0.0;             ///< relative, root of the estimated relmse
    NonFinite nonfinite;
    Settings resolved;
    int threads = 0;
};

struct RenderResult {
    Image image;                            ///< R G B, then emission.R ... and the layers asked for
    RenderRecord record;
    bool interrupted = false;
};

[[nodiscard]] RenderResult render(const Scene& scene, const RenderRequest& request, const Workers& workers,
                                  const Progress& progress = {}, const LogSink& log = {});

/// What render() would do, with the predicted cost of each pass, without rendering.
[[nodiscard]] RenderRecord planOnly(const Scene& scene, const RenderRequest& request, const Workers& workers,
                                    const LogSink& log = {});

}  // namespace pellucid

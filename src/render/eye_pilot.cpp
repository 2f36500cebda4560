#include "eye_pilot.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <vector>

#include <pellucid/math/hash.h>

#include "stages.h"

namespace pellucid {

namespace {

constexpr int kSamples = 4;  ///< of a pixel
/// Pixels are looked at in rounds until so many rays are traced.
constexpr std::size_t kRound = 64;
constexpr std::uint64_t kEnoughRays = 200'000;
/// Of the pixels, the noisiest: rare events that a few samples see or miss.
constexpr double kLeftOut = 0.01;
constexpr float kFloor = 0.01F;  ///< of relmse, in squares of the mean
constexpr std::uint64_t kPass = 0x657965ULL;

enum class Part : std::uint8_t { Rest, Indirect, Elsewhere };

/// Who would carry the paths of a string.
[[nodiscard]] Part partOf(PathString path, bool causticsApart) {
    const std::string name = path.name();
    if (name == "ESL") return Part::Elsewhere;  // lamp chains
    const std::size_t d = name.find('D');
    if (d == std::string::npos) return Part::Rest;
    const std::string behind = name.substr(d + 1);
    if (behind == "L") return Part::Rest;
    return behind == "SL" && causticsApart ? Part::Elsewhere : Part::Indirect;
}

/// Sums over a pixel's samples.
struct PixelSums {
    double rest = 0.0, restSquare = 0.0, all = 0.0, allSquare = 0.0;

    void add(double restOf, double indirect) noexcept {
        rest += restOf;
        restSquare += restOf * restOf;
        all += restOf + indirect;
        allSquare += (restOf + indirect) * (restOf + indirect);
    }
    [[nodiscard]] static double variance(double sum, double square) noexcept {
        return std::max(0.0, square - sum * sum / kSamples) / (kSamples - 1);
    }
};

using Parts = std::array<Part, PathString::kCodes>;

/// The samples of the pilot's pixel `number`, which is one by chance.
[[nodiscard]] PixelSums samplesOf(Walk& walk, const Camera& camera, std::uint64_t seed, std::size_t number,
                                  const Parts& parts) {
    const std::uint64_t key = hashCombine(seed, kPass);
    const auto width = static_cast<std::uint64_t>(camera.width()), height = static_cast<std::uint64_t>(camera.height());
    const std::uint64_t at = hash64(key + number) % (width * height);
    const glm::vec2 corner(static_cast<float>(at % width), static_cast<float>(at / width));
    PixelSums sums;
    StringSums strings;
    for (std::uint32_t s = 0; s < kSamples; ++s) {
        Sampler sampler(key, number, s);
        const glm::vec2 jitter = sampler.next2D(), lens = sampler.next2D();
        const CameraRay ray = camera.ray(corner + jitter, lens);
        strings.clear();
        const LayeredRadiance sample =
            walk.fromEye({ray.ray, ray.footprintAtOrigin, ray.footprintSpread}, sampler, nullptr, &strings);
        if (!isFinite(sample.total())) continue;
        double rest = 0.0, indirect = 0.0;
        for (const auto& [path, radiance] : strings) {
            const Part part = parts[path.code()];
            const auto y = static_cast<double>(luminance(radiance));
            if (part == Part::Rest) rest += y;
            if (part == Part::Indirect) indirect += y;
        }
        sums.add(rest, indirect);
    }
    return sums;
}

}  // namespace

EyePilot pilotEyePaths(const TransportContext& context, const Camera& camera, std::uint64_t seed, bool causticsApart,
                       std::size_t pixels, const Workers& workers) {
    Parts parts{};
    for (unsigned code = 0; code < PathString::kCodes; ++code)
        parts[code] = partOf(PathString(static_cast<std::uint8_t>(code)), causticsApart);
    EyePilot pilot;
    const WallClock::time_point began = WallClock::now();
    std::vector<PixelSums> sums;
    while (sums.size() < pixels && pilot.rays < kEnoughRays) {
        const std::size_t first = sums.size();
        sums.resize(std::min(pixels, first + kRound));
        std::vector<std::uint64_t> rays(sums.size() - first, 0);
        workers.forEach(rays.size(), 1, [&](std::size_t k) {
            Walk walk(context);
            sums[first + k] = samplesOf(walk, camera, seed, first + k, parts);
            rays[k] = walk.rays();
        });
        pilot.rays += std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
    }
    pilot.seconds = secondsSince(began);
    double mean = 0.0;
    for (const PixelSums& p : sums) mean += p.all / kSamples / static_cast<double>(sums.size());
    const double floor = static_cast<double>(kFloor) * mean * mean + 1e-30;
    std::vector<std::pair<double, double>> noise;  // relative variance: of all, of the rest
    for (const PixelSums& p : sums) {
        const double level = p.all / kSamples, reference = level * level + floor;
        noise.emplace_back(PixelSums::variance(p.all, p.allSquare) / reference,
                           PixelSums::variance(p.rest, p.restSquare) / reference);
    }
    std::sort(noise.begin(), noise.end());
    noise.resize(noise.size() - static_cast<std::size_t>(kLeftOut * static_cast<double>(noise.size())));
    double all = 0.0, rest = 0.0;
    for (const auto& [a, r] : noise) all += a, rest += r;
    pilot.indirectShare = all > 0.0 ? std::clamp(1.0 - rest / all, 0.0, 1.0) : 0.0;
    return pilot;
}

}  // namespace pellucid

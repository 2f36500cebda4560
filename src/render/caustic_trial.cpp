#include "caustic_trial.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include <pellucid/math/constants.h>
#include <pellucid/math/sampler.h>

namespace pellucid {

namespace {

/// Chance knows its own noise when its second moment rests on this many equal samples, its mean on more.
constexpr double kEnoughForMean = 200.0, kEnoughForSquare = 30.0;
/// Light that chance finds in caustics, over what photons find there, if it misses none.
constexpr double kLeastFound = 0.75, kMostFound = 1.33;
/// The map keeps its place unless chance is better by this much; its bias counts about half as much as its noise.
constexpr double kMargin = 1.2, kBiasAndNoise = 1.5;
constexpr double kFloor = 0.01;  ///< of relmse, in squares of the mean

}  // namespace

CausticTrial::CausticTrial(int width, int height)
    : width_((width + 1) / 2), height_((height + 1) / 2), sums_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

void CausticTrial::add(int x, int y, double luminance, double chains) noexcept {
    Sums& s = sums_[static_cast<std::size_t>(y / 2) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x / 2)];
    s.luminance += luminance;
    s.square += luminance * luminance;
    s.chains += chains;
    s.chainSquares += chains * chains;
    s.chainFourths += chains * chains * chains * chains;
}

TrialVerdict CausticTrial::judge(const Film& film, const TrialCosts& costs) const {
    constexpr double n = kIterations;
    const auto pixelOf = [&](int x, int y) { return static_cast<std::size_t>(2 * y) * static_cast<std::size_t>(film.width()) + static_cast<std::size_t>(2 * x); };
    double mean = 0.0;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) mean += static_cast<double>(film.noise(pixelOf(x, y)).luminance);
    mean /= static_cast<double>(std::max<std::size_t>(1, sums_.size()));
    const double floor = std::max(kFloor * mean * mean, 1e-30);
    double photons = 0.0, eye = 0.0, chance = 0.0, mapped = 0.0;
    Sums total;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            const PixelNoise noise = film.noise(pixelOf(x, y));
            const double scale = static_cast<double>(noise.luminance) * static_cast<double>(noise.luminance) + floor;
            const Sums& s = sums_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
            photons += static_cast<double>(noise.photonVariance) / scale;
            eye += static_cast<double>(noise.eyeVariance) / scale;
            chance += std::max(0.0, s.square - s.luminance * s.luminance / n) / (n - 1.0) / scale;
            mapped += n * static_cast<double>(noise.shared);
            total.chains += s.chains;
            total.chainSquares += s.chainSquares;
            total.chainFourths += s.chainFourths;
        }
    TrialVerdict verdict;
    const double forMean = total.chainSquares > 0.0 ? total.chains * total.chains / total.chainSquares : 0.0;
    const double forSquare = total.chainFourths > 0.0 ? total.chainSquares * total.chainSquares / total.chainFourths : 0.0;
    const double found = mapped > 0.0 ? total.chains / mapped : 0.0;
    if (forMean < kEnoughForMean || forSquare < kEnoughForSquare || found < kLeastFound || found > kMostFound) {
        verdict.reason = fmt::format("chance meets the lamps too rarely: {:.2g} equal hits, {:.2g} of the light", forMean, found);
        return verdict;
    }
    const double byMap = (kBiasAndNoise * photons + eye) * (costs.photonRays + costs.eyeRays), byChance = chance * costs.chanceRays;
    verdict.byChance = kMargin * byChance < byMap;
    verdict.reason = fmt::format("paths that meet the lamps take {:.2g} of the photons' time for the same error", byChance / byMap);
    return verdict;
}

std::vector<char> CausticTrial::save() const {
    std::vector<char> bytes(sums_.size() * sizeof(Sums));
    std::memcpy(bytes.data(), sums_.data(), bytes.size());
    return bytes;
}

bool CausticTrial::restore(const std::vector<char>& bytes) {
    if (bytes.size() != sums_.size() * sizeof(Sums)) return false;
    std::memcpy(static_cast<void*>(sums_.data()), bytes.data(), bytes.size());
    return true;
}

double lampShare(const Scene& scene, const Survey& seen) {
    constexpr std::size_t kPoints = 64;
    constexpr std::uint32_t kSamples = 16;
    double sum = 0.0, count = 0.0;
    const std::size_t step = std::max<std::size_t>(1, seen.points.size() / kPoints);
    for (std::size_t i = step / 2; i < seen.points.size(); i += step) {
        const GatherPoint& p = seen.points[i];
        if (!p.valid) continue;
        for (std::uint32_t k = 0; k < kSamples; ++k, count += 1.0) {
            Sampler sampler(0, i, k);
            const float choose = sampler.next1D();
            const auto light = scene.lights().sample(p.position, p.geometricNormal, choose, sampler.next2D());
            if (!light || light->delta || !(light->pdfSolidAngle > 0.0F)) continue;
            sum += static_cast<double>(std::max(0.0F, glm::dot(light->wi, p.geometricNormal)) / light->pdfSolidAngle) / kPiD;
        }
    }
    return count > 0.0 ? sum / count : 0.0;
}

}  // namespace pellucid

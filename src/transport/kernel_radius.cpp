#include <pellucid/transport/kernel_radius.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace pellucid {

namespace {

constexpr float kGrowth = 1.4F;
/// Standard deviations by which disc and ring may differ (p about 0.07 a test: to see an edge matters more than to see one too many).
constexpr double kContradiction = 1.8;
/// By which they differ beyond doubt.
constexpr double kEdge = 3.5;
/// A correction looks at so many blocks to each side, and changes a radius by no more than this.
constexpr int kNeighbours = 2;
constexpr double kLeastFactor = 0.6, kMostFactor = 1.25;
/// r over the root mean square of the radii so far, when r^2 falls as n^(-1/3).
constexpr double kRadiusSoFar = 1.2247;

[[nodiscard]] double equalPhotons(const FluxSums& s) noexcept {
    return s.squares > 0.0 ? s.sum * s.sum / s.squares : 0.0;
}

/// By how many standard deviations of their shot noise, pooled, the flux densities of disc and ring differ.
[[nodiscard]] double contradiction(const FluxSums& disc, double discArea, const FluxSums& both,
                                   double bothArea) noexcept {
    const double ringArea = bothArea - discArea;
    const double difference = disc.sum / discArea - (both.sum - disc.sum) / ringArea;
    const double variance = both.squares / bothArea * (1.0 / discArea + 1.0 / ringArea);
    return variance > 0.0 ? std::abs(difference) / std::sqrt(variance) : 0.0;
}

}  // namespace

KernelChoice chooseKernelRadius(const CausticMap& map, const GatherPoint& point,
                                const KernelRadiusOptions& options) noexcept {
    KernelChoice choice{options.smallest, options.largest};
    const auto scaled = [&](float r) { return r * point.footprint; };
    FluxSums disc = map.fluxWithin(point.position, point.geometricNormal, scaled(choice.radius));
    while (choice.radius < options.largest && equalPhotons(disc) < options.enough) {
        const float next = std::min(choice.radius * kGrowth, options.largest);
        const FluxSums both = map.fluxWithin(point.position, point.geometricNormal, scaled(next));
        const double by = contradiction(disc, static_cast<double>(choice.radius) * static_cast<double>(choice.radius),
                                        both, static_cast<double>(next) * static_cast<double>(next));
        if (by > kContradiction) {
            if (by > kEdge) choice.edge = choice.radius;
            break;
        }
        choice.radius = next;
        disc = both;
    }
    return choice;
}

KernelRadii::KernelRadii(int width, int height, const KernelRadiusOptions& options)
    : width_(width),
      height_(height),
      blocksX_((width + kBlock - 1) / kBlock),
      blocksY_((height + kBlock - 1) / kBlock),
      options_(options),
      logRadius_(static_cast<std::size_t>(blocksX_) * static_cast<std::size_t>(blocksY_), 0.0F),
      logFactor_(logRadius_),
      logEdge_(logRadius_.size(), std::log(options.largest)),
      radii_(logRadius_.size(), options.smallest) {}

float KernelRadii::toNextPixels(const std::vector<GatherPoint>& points, int x, int y) const {
    const auto at = [&](int u, int v) -> const GatherPoint& {
        return points[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u)];
    };
    const GatherPoint& p = at(x, y);
    float longest = 0.0F;
    const auto add = [&](const GatherPoint& next) {
        const float distance = next.valid ? glm::length(next.position - p.position) / p.footprint : 0.0F;
        if (distance < options_.largest) longest = std::max(longest, distance);  // beyond is another surface
    };
    if (width_ > 1) add(at(x > 0 ? x - 1 : x + 1, y));
    if (height_ > 1) add(at(x, y > 0 ? y - 1 : y + 1));
    return longest;
}

void KernelRadii::learn(const CausticMap& map, const std::vector<GatherPoint>& points, const Workers& workers) {
    ++passes_;
    workers.forEach(logRadius_.size(), 256, [&](std::size_t block) {
        const int x0 = static_cast<int>(block) % blocksX_ * kBlock, y0 = static_cast<int>(block) / blocksX_ * kBlock;
        // Another pixel of the block each time.
        const int x = std::min(x0 + (passes_ & 1), width_ - 1), y = std::min(y0 + (passes_ >> 1 & 1), height_ - 1);
        const GatherPoint& p =
            points[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
        KernelChoice choice{options_.smallest, options_.largest};
        if (p.valid && p.footprint > 0.0F) choice = chooseKernelRadius(map, p, options_);
        // The pixel's other samples may lie nearer to the edge, by as much as the next pixels are away.
        if (choice.edge < options_.largest)
            choice.edge = std::max(options_.smallest, choice.edge - toNextPixels(points, x, y));
        const float radius = std::log(choice.radius), edge = std::log(choice.edge);
        logRadius_[block] = passes_ == 1 ? radius : 0.5F * (logRadius_[block] + radius);
        // An edge that the newest pass does not show is forgotten by halves.
        logEdge_[block] = std::min(edge, 0.5F * (logEdge_[block] + std::log(options_.largest)));
    });
    smooth(workers);
}

void KernelRadii::correctBlocks(std::uint32_t iterations, const std::vector<Shown>& blocks, const Workers& workers) {
    workers.forEach(blocks.size(), 256, [&](std::size_t block) {
        const int bx = static_cast<int>(block) % blocksX_, by = static_cast<int>(block) / blocksX_;
        Shown near;
        for (int y = std::max(0, by - kNeighbours); y <= std::min(blocksY_ - 1, by + kNeighbours); ++y)
            for (int x = std::max(0, bx - kNeighbours); x <= std::min(blocksX_ - 1, bx + kNeighbours); ++x) {
                near.variance += blocks[blockAt(x, y)].variance;
                near.bias2 += blocks[blockAt(x, y)].bias2;
            }
        if (!(near.variance > 0.0)) return;
        // Good until as many iterations again have been.
        const double n = 2.0 * iterations,
                     ratio = near.variance / (2.0 * n * std::max(near.bias2, 1e-4 * near.variance / n));
        const double factor = std::clamp(kRadiusSoFar * std::pow(ratio, 1.0 / 6.0), kLeastFactor, kMostFactor);
        const double bounded = std::clamp(std::exp(static_cast<double>(logFactor_[block])) * factor, 0.25, 2.0);
        logFactor_[block] = static_cast<float>(std::log(bounded));
    });
    smooth(workers);
}

/// The median of nine neighbours takes out what single photons did. An edge stays where it was seen.
void KernelRadii::smooth(const Workers& workers) {
    workers.forEach(radii_.size(), 256, [&](std::size_t block) {
        const int bx = static_cast<int>(block) % blocksX_, by = static_cast<int>(block) / blocksX_;
        std::array<float, 9> near{};
        std::size_t n = 0;
        for (int y = std::max(0, by - 1); y <= std::min(blocksY_ - 1, by + 1); ++y)
            for (int x = std::max(0, bx - 1); x <= std::min(blocksX_ - 1, bx + 1); ++x)
                near[n++] = logRadius_[blockAt(x, y)] + logFactor_[blockAt(x, y)];
        std::nth_element(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(n / 2),
                         near.begin() + static_cast<std::ptrdiff_t>(n));
        radii_[block] = std::exp(std::min(near[n / 2], logEdge_[block] + std::min(0.0F, logFactor_[block])));
    });
}

std::vector<char> KernelRadii::save() const {
    const std::size_t size = logRadius_.size() * sizeof(float);
    std::vector<char> bytes(sizeof passes_ + 3 * size);
    std::memcpy(bytes.data(), &passes_, sizeof passes_);
    char* at = bytes.data() + sizeof passes_;
    for (const std::vector<float>* field : {&logRadius_, &logFactor_, &logEdge_}) {
        std::memcpy(at, field->data(), size);
        at += size;
    }
    return bytes;
}

bool KernelRadii::restore(const std::vector<char>& bytes, const Workers& workers) {
    const std::size_t size = logRadius_.size() * sizeof(float);
    if (bytes.size() != sizeof passes_ + 3 * size) return false;
    std::memcpy(&passes_, bytes.data(), sizeof passes_);
    const char* at = bytes.data() + sizeof passes_;
    for (std::vector<float>* field : {&logRadius_, &logFactor_, &logEdge_}) {
        std::memcpy(field->data(), at, size);
        at += size;
    }
    if (passes_ > 0) smooth(workers);
    return true;
}

}  // namespace pellucid

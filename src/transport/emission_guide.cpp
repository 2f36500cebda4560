#include <pellucid/transport/emission_guide.h>

#include <algorithm>
#include <cmath>

namespace pellucid {

namespace {

constexpr float kUniformShare = 0.1F;  ///< of the numbers, and of the choice of light (by power)
constexpr std::size_t kMinItems = 24;  ///< a cell with fewer is not split
constexpr int kMaxDepth = 32;
/// Along the choice of light there are needles to be found: one lamp among a hundred.
constexpr int kBins = 8, kBinsForLights = 64;
constexpr std::size_t kItemsABin = 5;
/// Standard deviations of chi^2 above its mean beyond which a cell is not uniform along an axis (p = 0.003 of eight bins).
constexpr float kSplitDeviation = 3.9F;

/// Chi^2 of the items' positions along `axis` against uniform, as standard deviations above its mean.
[[nodiscard]] float nonUniformity(const std::vector<UsefulEmission>& items, std::size_t begin, std::size_t end,
                                  std::size_t axis, float lower, float upper) {
    std::array<float, kBinsForLights> counts{};
    const int bins = axis == 0 && end - begin >= kItemsABin * kBinsForLights ? kBinsForLights : kBins;
    for (std::size_t i = begin; i < end; ++i) {
        const float t = (items[i].u[axis] - lower) / (upper - lower);
        ++counts[static_cast<std::size_t>(std::clamp(static_cast<int>(t * static_cast<float>(bins)), 0, bins - 1))];
    }
    const float expected = static_cast<float>(end - begin) / static_cast<float>(bins);
    float chi = 0.0F;
    for (int b = 0; b < bins; ++b) {
        const float off = counts[static_cast<std::size_t>(b)] - expected;
        chi += off * off / expected;
    }
    const auto freedom = static_cast<float>(bins - 1);
    return (chi - freedom) / std::sqrt(2.0F * freedom);
}

}  // namespace

EmissionGuide::EmissionGuide(const Lights& lights, std::vector<UsefulEmission> useful, double equalShare)
    : lights_(lights) {
    const auto count = static_cast<std::uint32_t>(lights.count());
    const double power = lights.totalPower();
    double trianglePower = 0.0;
    std::size_t lamps = 0;
    for (std::uint32_t l = 0; l < count; ++l) {
        if (lights.kind(l) == LightKind::Triangle)
            trianglePower += lights.power(l);
        else
            ++lamps;
    }
    if (trianglePower > 0.0) ++lamps;
    double sum = 0.0;
    for (std::uint32_t l = 0; l < count; ++l) {
        const double byPower = power > 0.0 ? lights.power(l) / power : 1.0 / count;
        const double alike = lights.kind(l) != LightKind::Triangle ? 1.0
                             : trianglePower > 0.0                 ? lights.power(l) / trianglePower
                                                                   : 0.0;
        sum += (1.0 - equalShare) * byPower + equalShare * alike / static_cast<double>(std::max<std::size_t>(1, lamps));
        lightCdf_.push_back(sum);
    }
    for (double& c : lightCdf_) c /= sum;
    learn(std::move(useful));
}

EmissionGuide::EmissionGuide(const Lights& lights, const std::vector<std::uint32_t>& only,
                             std::vector<UsefulEmission> useful)
    : lights_(lights), lightCdf_(lights.count(), 0.0) {
    double power = 0.0, sum = 0.0;
    for (const std::uint32_t l : only) power += lights.power(l);
    for (const std::uint32_t l : only)
        lightCdf_[l] = power > 0.0 ? lights.power(l) / power : 1.0 / static_cast<double>(only.size());
    for (double& c : lightCdf_) c = sum += c;
    for (double& c : lightCdf_) c /= sum;
    learn(std::move(useful));
}

void EmissionGuide::learn(std::vector<UsefulEmission> useful) {
    if (useful.size() < kMinItems) return;
    uniformShare_ = kUniformShare;
    nodes_.emplace_back();
    build(0, useful, 0, useful.size(), {0, 0, 0, 0, 0}, {1, 1, 1, 1, 1}, 0);
}

void EmissionGuide::build(std::uint32_t node, std::vector<UsefulEmission>& items, std::size_t begin, std::size_t end,
                          const EmissionNumbers5& lower, const EmissionNumbers5& upper, int depth) {
    const std::size_t count = end - begin;
    if (count < kMinItems || depth >= kMaxDepth) return;
    std::size_t axis = 0;
    float worst = 0.0F;
    for (std::size_t a = 0; a < lower.size(); ++a) {
        const float deviation = nonUniformity(items, begin, end, a, lower[a], upper[a]);
        if (deviation > worst) worst = deviation, axis = a;
    }
    if (worst < kSplitDeviation) return;
    const float middle = 0.5F * (lower[axis] + upper[axis]);
    const auto first = items.begin() + static_cast<std::ptrdiff_t>(begin),
               last = items.begin() + static_cast<std::ptrdiff_t>(end);
    const auto split = std::stable_partition(first, last, [&](const UsefulEmission& e) { return e.u[axis] < middle; });
    const auto cut = begin + static_cast<std::size_t>(split - first);
    double leftMass = 0.0, mass = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
        mass += static_cast<double>(items[i].weight);
        if (i < cut) leftMass += static_cast<double>(items[i].weight);
    }
    // One item of mean weight on each side: an empty half keeps a share that falls with the evidence.
    const double prior = mass / static_cast<double>(count);
    nodes_[node].axis = static_cast<std::int32_t>(axis);
    nodes_[node].left = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].leftShare = static_cast<float>((leftMass + prior) / (mass + 2.0 * prior));
    const std::uint32_t left = nodes_[node].left;
    nodes_.emplace_back();
    nodes_.emplace_back();
    auto middleUpper = upper, middleLower = lower;
    middleUpper[axis] = middleLower[axis] = middle;
    build(left, items, begin, cut, lower, middleUpper, depth + 1);
    build(left + 1, items, cut, end, middleLower, upper, depth + 1);
}

float EmissionGuide::density(const EmissionNumbers5& u) const noexcept {
    if (nodes_.empty()) return 1.0F;
    EmissionNumbers5 local = u;
    float pdf = 1.0F;
    const Node* node = nodes_.data();
    while (node->axis >= 0) {
        float& t = local[static_cast<std::size_t>(node->axis)];
        const bool left = t < 0.5F;
        pdf *= 2.0F * (left ? node->leftShare : 1.0F - node->leftShare);
        t = left ? 2.0F * t : 2.0F * t - 1.0F;
        node = &nodes_[node->left + (left ? 0U : 1U)];
    }
    return pdf;
}

/// Maps uniform numbers to the tree's density by inversion at each split, which keeps their stratification.
void EmissionGuide::warp(EmissionNumbers5& u) const noexcept {
    if (nodes_.empty()) return;
    EmissionNumbers5 lower{}, size{1.0F, 1.0F, 1.0F, 1.0F, 1.0F};
    const Node* node = nodes_.data();
    while (node->axis >= 0) {
        const auto axis = static_cast<std::size_t>(node->axis);
        const bool left = u[axis] < node->leftShare;
        u[axis] = left ? u[axis] / node->leftShare : (u[axis] - node->leftShare) / (1.0F - node->leftShare);
        size[axis] *= 0.5F;
        if (!left) lower[axis] += size[axis];
        node = &nodes_[node->left + (left ? 0U : 1U)];
    }
    for (std::size_t a = 0; a < u.size(); ++a) u[a] = std::min(lower[a] + u[a] * size[a], 0x1.fffffep-1F);
}

std::optional<GuidedEmission> EmissionGuide::sample(Sampler& sampler) const noexcept {
    const float chosen = sampler.next1D();
    const glm::vec2 position = sampler.next2D(), direction = sampler.next2D();
    EmissionNumbers5 u{chosen, position.x, position.y, direction.x, direction.y};
    if (sampler.next1D() >= uniformShare_) warp(u);
    const float pdf = uniformShare_ + (1.0F - uniformShare_) * density(u);
    const auto it = std::upper_bound(lightCdf_.begin(), lightCdf_.end(), static_cast<double>(u[0]));
    const auto light = static_cast<std::uint32_t>(
        std::min<std::ptrdiff_t>(it - lightCdf_.begin(), static_cast<std::ptrdiff_t>(lightCdf_.size()) - 1));
    const double pmf = lightCdf_[light] - (light > 0 ? lightCdf_[light - 1] : 0.0);
    auto emission = lights_.sampleEmissionFrom(light, {u[1], u[2]}, {u[3], u[4]});
    if (!emission || !(pmf > 0.0)) return std::nullopt;
    const auto scale = static_cast<float>(1.0 / (pmf * static_cast<double>(pdf)));
    emission->flux *= scale;
    emission->pmfLight = static_cast<float>(pmf);
    return GuidedEmission{*emission, {u, scale, {}, pdf}};
}

}  // namespace pellucid

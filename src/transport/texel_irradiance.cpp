#include <pellucid/transport/texel_irradiance.h>

#include <algorithm>
#include <cmath>

namespace pellucid {

namespace {

constexpr double kMostParts = 1e4;
constexpr std::size_t kBlock = 16;

}  // namespace

TexelIrradiance::Place TexelIrradiance::placeOf(std::uint32_t geometry, std::uint32_t primitive,
                                                const glm::vec2& barycentric, bool back) const noexcept {
    const auto corner = scene_.corners(geometry, primitive);
    const glm::dvec3 a(corner[0]), b(corner[1]), c(corner[2]);
    const double longest = std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)});
    const double n = std::clamp(std::ceil(longest / static_cast<double>(width_)), 1.0, kMostParts);
    const double u = std::clamp(static_cast<double>(barycentric.x), 0.0, 1.0) * n,
                 v = std::clamp(static_cast<double>(barycentric.y), 0.0, 1.0) * n;
    const double row = std::min(std::floor(u), n - 1.0), column = std::min(std::floor(v), n - 1.0);
    double s = u - row, t = v - column;
    const bool upper = s + t > 1.0;
    if (upper) s = 1.0 - s, t = 1.0 - t;
    Place place;
    place.key = {geometry, primitive, static_cast<std::uint32_t>(row) * 2U + (upper ? 1U : 0U),
                 static_cast<std::uint32_t>(column) * 2U + (back ? 1U : 0U)};
    place.quarter = s > 0.5 ? 1U : t > 0.5 ? 2U : s + t < 0.5 ? 0U : 3U;
    place.area = 0.5 * glm::length(glm::cross(b - a, c - a)) / (n * n);
    return place;
}

void TexelIrradiance::look(const std::vector<SeenReceiver>& seen, std::uint32_t pass) {
    seen_.resize(static_cast<std::size_t>(camera_.width()) * static_cast<std::size_t>(camera_.height()), {0.0, 0.0});
    looks_.clear();
    for (const SeenReceiver& s : seen) {
        looks_.push_back({placeOf(s.geometry, s.primitive, s.barycentric, s.backSide), &s});
        const Place& place = looks_.back().place;
        const auto [it, fresh] = texels_.try_emplace(place.key);
        if (!fresh) continue;
        it->second.firstPass = pass;
        it->second.area = place.area;
    }
}

void TexelIrradiance::deposit(const std::vector<CausticArrival>& arrivals, std::uint32_t pass) {
    for (const CausticArrival& a : arrivals) {
        const Place place = placeOf(a.geometry, a.primitive, a.barycentric, a.backSide);
        const auto it = texels_.find(place.key);
        if (it == texels_.end()) continue;
        double* sum = it->second.sum[pass & 1U][place.quarter];
        const double s = 1.0 - static_cast<double>(a.cosine), s5 = s * s * s * s * s;
        for (glm::length_t c = 0; c < 3; ++c) {
            sum[c] += static_cast<double>(a.flux[c]);
            sum[3 + c] += static_cast<double>(a.flux[c]) * s5;
        }
    }
}

void TexelIrradiance::resolve(std::uint32_t pass, std::vector<LightSplat>& splats) {
    for (const Look& l : looks_) {
        const Texel& texel = texels_.find(l.place.key)->second;
        const SeenReceiver& seen = *l.seen;
        // Passes of this parity from the texel's first one on, this one included.
        const double passes = (pass - texel.firstPass) / 2 + 1;
        const auto& quarters = texel.sum[pass & 1U];
        Rgb value(0.0F), coarse(0.0F);
        for (glm::length_t c = 0; c < 3; ++c) {
            const auto through = [&](const double* sum) {
                return static_cast<double>(seen.lobe.a) * sum[c] - static_cast<double>(seen.lobe.b) * sum[3 + c];
            };
            double all = 0.0;
            for (const auto& q : quarters) all += through(q);
            const double wide = all / (passes * texel.area),
                         fine = through(quarters[l.place.quarter]) / (passes * 0.25 * texel.area);
            value[c] = static_cast<float>((4.0 * fine - wide) / 3.0);
            coarse[c] = static_cast<float>(wide);
        }
        value *= seen.weight;
        seen_[seen.pixel][0] += static_cast<double>(luminance(coarse * seen.weight));
        seen_[seen.pixel][1] += static_cast<double>(luminance(value));
        if (!isBlack(value)) splats.push_back({seen.pixel, value, path_});
    }
}

double TexelIrradiance::extrapolated() const noexcept {
    // In blocks of pixels, so that the photons' noise, which a pixel's texels are full of, does not pass for bias.
    const auto width = static_cast<std::size_t>(camera_.width()), across = (width + kBlock - 1) / kBlock;
    std::vector<std::array<double, 2>> blocks((seen_.size() / width / kBlock + 1) * across, {0.0, 0.0});
    for (std::size_t i = 0; i < seen_.size(); ++i)
        for (std::size_t k = 0; k < 2; ++k) blocks[i / width / kBlock * across + i % width / kBlock][k] += seen_[i][k];
    double difference = 0.0, square = 0.0;
    for (const auto& [coarse, value] : blocks) {
        difference += (value - coarse) * (value - coarse);
        square += value * value;
    }
    return square > 0.0 ? std::sqrt(difference / square) : 0.0;
}

}  // namespace pellucid

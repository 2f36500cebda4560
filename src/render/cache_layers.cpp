#include "cache_layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace pellucid {

namespace {

enum Layer : std::size_t { kRecords, kRadius, kGradient, kAge, kReuse, kReason, kLayers };
constexpr std::array<std::string_view, kLayers> kNames{"records",    "record_radius", "record_gradient",
                                                       "record_age", "record_reuse",  "record_reason"};
constexpr float kPlainGather = 7.0F, kNoReceiver = 8.0F;

using Planes = std::array<std::vector<float>, kLayers>;

[[nodiscard]] bool isAsked(const std::vector<std::string>& layers, std::string_view name) {
    return std::any_of(layers.begin(), layers.end(), [&](const std::string& l) { return l == name || l == "all"; });
}

void countRecords(std::vector<float>& plane, const CacheView& view) {
    const int width = view.camera.width(), height = view.camera.height();
    for (const IrradianceRecord& r : view.cache.records()) {
        const auto film = view.camera.project(r.position, {0.5F, 0.5F});
        if (!film) continue;
        const int x = static_cast<int>(film->position.x), y = static_cast<int>(film->position.y);
        if (x < 0 || y < 0 || x >= width || y >= height) continue;
        plane[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] += 1.0F;
    }
}

/// |grad E| / E over the channels' mean, per scene unit.
[[nodiscard]] float relativeSlope(const IrradianceRecord& r) {
    const float mean = average(r.irradiance);
    const glm::vec3 slope = (r.translation[0] + r.translation[1] + r.translation[2]) * (1.0F / 3.0F);
    return mean > 0.0F ? glm::length(slope) / mean : 0.0F;
}

[[nodiscard]] float reasonOf(bool speaks, Silence objection, bool plain) {
    if (speaks) return 0.0F;
    return plain ? kPlainGather : static_cast<float>(objection);
}

void describeSpeakers(Planes& planes, const CacheView& view, const Workers& workers) {
    const std::vector<GatherPoint>& points = view.seen.points;
    const std::vector<IrradianceRecord>& records = view.cache.records();
    std::vector<std::vector<IrradianceCache::Speaker>> speakers(points.size());
    workers.forEach(points.size(), 256, [&](std::size_t i) {
        if (!points[i].valid) {
            planes[kReason][i] = kNoReceiver;
            return;
        }
        Silence objection = Silence::Nobody;
        speakers[i] = view.cache.speakers(points[i].position, points[i].unmappedNormal, objection);
        planes[kReason][i] = reasonOf(!speakers[i].empty(), objection, !view.plain.empty() && view.plain[i] != 0);
    });
    std::vector<std::uint32_t> uses(records.size(), 0);
    for (const auto& list : speakers)
        for (const auto& s : list) ++uses[s.record];
    const auto metres = static_cast<float>(view.metresPerUnit);
    workers.forEach(points.size(), 256, [&](std::size_t i) {
        float weights = 0.0F;
        for (const auto& s : speakers[i]) weights += s.weight;
        if (!(weights > 0.0F)) return;
        for (const auto& s : speakers[i]) {
            const IrradianceRecord& r = records[s.record];
            const float share = s.weight / weights;
            planes[kRadius][i] += share * r.radius * view.cache.error() * metres;
            planes[kGradient][i] += share * relativeSlope(r) / metres;
            planes[kAge][i] += share * static_cast<float>(view.views - std::min(view.views, r.born + 1));
            planes[kReuse][i] += share * static_cast<float>(uses[s.record]);
        }
    });
}

}  // namespace

void addCacheLayers(Image& image, const std::vector<std::string>& layers, const CacheView& view,
                    const Workers& workers) {
    std::vector<std::size_t> asked;
    for (std::size_t l = 0; l < kLayers; ++l)
        if (isAsked(layers, kNames[l])) asked.push_back(l);
    if (asked.empty()) return;
    Planes planes;
    for (auto& plane : planes) plane.assign(image.pixels(), 0.0F);
    countRecords(planes[kRecords], view);
    if (asked.back() != kRecords && view.seen.points.size() == image.pixels()) describeSpeakers(planes, view, workers);
    std::vector<std::string> names = image.channelNames();
    const auto before = static_cast<int>(names.size());
    for (const std::size_t l : asked) names.push_back(std::string(kNames[l]) + ".Y");
    Image wider(image.width(), image.height(), names);
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        for (int c = 0; c < before; ++c) wider.at(i, c) = image.at(i, c);
        for (std::size_t k = 0; k < asked.size(); ++k) wider.at(i, before + static_cast<int>(k)) = planes[asked[k]][i];
    }
    image = std::move(wider);
}

}  // namespace pellucid

// What the camera sees at D vertices, one look a pixel.
#include <algorithm>
#include <numeric>

#include <pellucid/math/hash.h>
#include <pellucid/render/plan.h>

#include "visible_survey.h"

namespace pellucid {

namespace {

/// The value below which so many per cent of them lie. Reorders them.
[[nodiscard]] float quantile(std::vector<float>& values, std::size_t percent) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() * percent / 100);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/// How large what is seen is on the film.
void measureFootprints(Survey& s) {
    std::vector<float> footprints;
    for (const GatherPoint& p : s.points)
        if (p.valid) footprints.push_back(p.footprint);
    s.receivers = footprints.size();
    if (!footprints.empty()) s.medianFootprint = quantile(footprints, 50);
}

}  // namespace

VisibleCells visibleWithin(const Survey& seen, float footprints, float largest) {
    std::vector<float> widths;
    for (const GatherPoint& p : seen.points)
        if (p.valid) widths.push_back(p.footprint);
    if (widths.empty()) return VisibleCells(1.0F);
    const auto reach = [&](float footprint) { return std::min(footprints * footprint, largest); };
    // Cells of half the reach of all kernels but the largest few: a mark takes at most five cells along an axis.
    const float cell = std::max({8.0F * quantile(widths, 50), 0.5F * reach(quantile(widths, 95)), 1e-4F});
    VisibleCells visible(cell);
    const auto mark = [&](const auto& p) { visible.mark(p.position, std::min(reach(p.footprint), 2.0F * cell)); };
    for (const GatherPoint& p : seen.points)
        if (p.valid) mark(p);
    for (const Receiver& p : seen.beyond) mark(p);
    return visible;
}

Survey survey(const TransportContext& context, const Camera& camera, std::uint64_t seed, float kernelFootprints,
              float largestKernel, const Workers& workers) {
    Survey s;
    const auto width = static_cast<std::size_t>(camera.width());
    s.points.resize(width * static_cast<std::size_t>(camera.height()));
    std::vector<std::uint64_t> rays((s.points.size() + 1023) / 1024, 0);
    std::vector<std::vector<Receiver>> beyond(rays.size());
    workers.forRanges(s.points.size(), 1024, [&](std::size_t begin, std::size_t end) {
        Walk walk(context);
        std::vector<GatherPoint> behind;
        for (std::size_t i = begin; i < end; ++i) {
            Sampler sampler(hash64(seed ^ 0x737572766579ULL), i, 0);
            const CameraRay ray =
                camera.ray({static_cast<float>(i % width) + 0.5F, static_cast<float>(i / width) + 0.5F}, {0.5F, 0.5F});
            behind.clear();
            s.points[i] = walk.findGatherPoint({ray.ray, ray.footprintAtOrigin, ray.footprintSpread}, sampler,
                                               GatherStop::First, &behind);
            for (const GatherPoint& p : behind) beyond[begin / 1024].push_back({p.position, p.footprint});
        }
        rays[begin / 1024] = walk.rays();
    });
    s.rays = std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
    for (const std::vector<Receiver>& of : beyond) s.beyond.insert(s.beyond.end(), of.begin(), of.end());
    measureFootprints(s);
    if (s.receivers > 0) s.visible = visibleWithin(s, kernelFootprints, largestKernel);
    return s;
}

}  // namespace pellucid

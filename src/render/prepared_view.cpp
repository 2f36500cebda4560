#include "prepared_view.h"

#include <algorithm>
#include <cmath>

#include <pellucid/transport/kernel_radius.h>

#include "endless.h"
#include "setting_choices.h"
#include "stages.h"

namespace pellucid {

namespace {

[[nodiscard]] Survey surveyOf(const PreparedView& view) {
    const float kernels =
        std::max(KernelRadiusOptions{}.largest, static_cast<float>(view.request.settings.causticRadius));
    return survey(view.context({}), view.camera, view.request.seed, kernels, kMaxCausticRadius * view.scene.radius(),
                  view.workers);
}

void prepare(PreparedView& view) {
    const StageTimer timer(view.pilot);
    const RenderRequest& request = view.request;
    if (request.method != Method::Path && request.method != Method::Bdpt) {
        view.survey = surveyOf(view);
        view.pilot.rays += view.survey.rays;
    }
    view.plan = makePlan(view.scene, view.camera, request, view.survey, view.workers);
    if (auto remark = endlessRemark(view.scene, view.camera)) view.plan.blindSpots.push_back(*remark);
    view.pilot.rays += view.plan.pilotRays;
    view.pilot.photonsEmitted += view.plan.pilotPhotons;
    if (request.method == Method::Reference) view.options.left = {view.plan.lightPass, view.plan.texelWidth > 0.0F};
    view.options.splitLampChains = view.plan.splitLampChains;
    view.options.splitGlass = view.plan.splitGlass;
    // After the plan, which is that of the whole image.
    view.pixels = RenderedPixels(request.windows, view.camera.width(), view.camera.height());
    for (std::size_t i = 0; i < view.survey.points.size(); ++i)
        if (!view.pixels.contains(i)) view.survey.points[i].valid = false;
}

}  // namespace

RenderedPixels::RenderedPixels(const std::vector<PixelWindow>& windows, int width, int height) {
    if (windows.empty()) return;
    inside_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), false);
    for (const PixelWindow& w : windows)
        for (int y = std::max(0, w.y0); y < std::min(w.y1, height); ++y)
            for (int x = std::max(0, w.x0); x < std::min(w.x1, width); ++x)
                inside_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
                    true;
    const auto count = std::count(inside_.begin(), inside_.end(), true);
    scale_ = static_cast<double>(inside_.size()) / static_cast<double>(std::max<std::ptrdiff_t>(1, count));
}

std::uint64_t RenderedPixels::ofWholeImage(std::uint64_t rays) const noexcept {
    return static_cast<std::uint64_t>(std::llround(static_cast<double>(rays) * scale_));
}

Camera requestedCamera(const Scene& scene, const RenderRequest& request) {
    return scene.camera(request.camera, request.width, request.height, request.settings.aperture,
                        request.settings.focus);
}

PreparedView prepareView(const Scene& scene, const RenderRequest& request, const Workers& workers) {
    PreparedView view{.scene = scene,
                      .request = request,
                      .workers = workers,
                      .camera = requestedCamera(scene, request),
                      .options = transportOptions(request.settings)};
    prepare(view);
    return view;
}

}  // namespace pellucid

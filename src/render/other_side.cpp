#include "other_side.h"

#include <algorithm>
#include <vector>

#include <pellucid/transport/photon_trace.h>

#include "pass_keys.h"
#include "setting_choices.h"
#include "stages.h"
#include "visible_survey.h"

namespace pellucid {

KernelRadiusOptions otherRadiusOptions(const Settings& settings) {
    KernelRadiusOptions options = radiusOptions(settings);
    options.smallest = 2.0F;
    options.largest = 32.0F;
    return options;
}

VisibleCells visibleToOthers(const Scene& scene, const Survey& seen, const Settings& settings) {
    const float kernels = std::max(otherRadiusOptions(settings).largest, static_cast<float>(settings.causticRadius));
    return visibleWithin(seen, kernels, kMaxOtherRadius * scene.radius());
}

OtherSide::OtherSide(const PreparedView& view) : view_(view) {
    if (!view.plan.otherPhotons) return;
    const Settings& settings = view.request.settings;
    visible_ = std::make_unique<VisibleCells>(visibleToOthers(view.scene, view.survey, settings));
    if (view.plan.adaptiveRadius)
        first_ = std::make_unique<KernelRadii>(view.camera.width(), view.camera.height(), otherRadiusOptions(settings));
    shrink_ = std::make_unique<ProgressiveRadii>(view.pixelCount(), shrinkNamed(settings.shrink), settings.alpha);
}

void OtherSide::pass(std::uint32_t iteration) {
    const StageTimer timer(stage_);
    OtherPass pass = traceOtherPhotons(
        view_.scene, {view_.request.seed, kOtherPass + iteration, view_.plan.globalPaths}, *visible_, view_.workers);
    addPhotonPass(stage_, pass);
    stage_.photonsStored += pass.photons.size();
    map_ = std::make_unique<CausticMap>(std::move(pass.photons), photonKernel(view_.request.settings.kernel),
                                        &view_.workers);
    if (first_ && iteration == 0) first_->learn(*map_, view_.survey.points, view_.workers);
}

void OtherSide::giveTo(Maps& maps) const noexcept {
    if (!map_) return;
    maps.others = map_.get();
    maps.causticRadiusMin = kLeastKernelRadius;
    maps.othersRadiusMax = kMaxOtherRadius * view_.scene.radius();
}

float OtherSide::kernelFootprints(int x, int y) const noexcept {
    if (!shrink_) return 0.0F;
    return (first_ ? first_->at(x, y) : view_.plan.causticFootprints) * shrink_->scale(view_.pixelIndex(x, y));
}

void OtherSide::saveTo(CheckpointState& state) const {
    if (first_) state.others = first_->save();
    if (!shrink_) return;
    const std::vector<char> shrunk = shrink_->save();
    state.others.insert(state.others.end(), shrunk.begin(), shrunk.end());
}

bool OtherSide::restoreFrom(const CheckpointState& state) {
    const std::size_t firsts = first_ ? first_->save().size() : 0;
    if (state.others.size() < firsts) return false;
    const auto middle = state.others.begin() + static_cast<std::ptrdiff_t>(firsts);
    if (first_ && !first_->restore({state.others.begin(), middle}, view_.workers)) return false;
    return !shrink_ || shrink_->restore(state.others.data() + firsts, state.others.size() - firsts);
}

}  // namespace pellucid

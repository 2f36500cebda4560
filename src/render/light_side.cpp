#include "light_side.h"

#include <utility>

#include "pass_keys.h"
#include "stages.h"

namespace pellucid {

LightSide::LightSide(const PreparedView& view) : view_(view) {
    if (view.plan.texelWidth > 0.0F)
        texels_ = std::make_unique<TexelIrradiance>(view.scene, view.camera, view.plan.texelWidth);
}

std::vector<LightSplat> LightSide::pass(PhotonSource& source, std::uint32_t iteration) {
    const StageTimer timer(stage_);
    if (texels_) texels_->look(view_.request.seed, iteration, view_.workers);
    LightPass pass = traceLightPaths(view_.scene, view_.camera, source.guide(),
                                     {view_.request.seed, kLightPass + iteration, source.paths()}, view_.workers,
                                     texels_ ? &view_.survey.visible : nullptr);
    addPhotonPass(stage_, pass);
    stage_.photonsStored += pass.splats.size();
    if (texels_) {
        texels_->deposit(pass.arrivals, iteration);
        texels_->resolve(iteration, pass.splats);
    }
    if (source.learnsFrom(iteration)) source.learn(std::move(pass.useful));
    return std::move(pass.splats);
}

TexelReport LightSide::texels() const {
    if (!texels_) return {};
    return {texels_->texels(), static_cast<double>(view_.plan.texelWidth) / view_.scene.normalisation().scale(),
            texels_->extrapolated()};
}

}  // namespace pellucid

#include "light_side.h"

#include <utility>

#include "pass_keys.h"
#include "stages.h"

namespace pellucid {

namespace {

/// Caustics of caustics are softer and fewer photons make them.
constexpr float kWiderBounced = 2.0F;

}  // namespace

LightSide::LightSide(const PreparedView& view) : view_(view) {
    const float width = view.plan.texelWidth;
    if (!(width > 0.0F)) return;
    texels_ = std::make_unique<TexelIrradiance>(view.scene, view.camera, width, kSeenCaustic);
    bounced_ = std::make_unique<TexelIrradiance>(view.scene, view.camera, kWiderBounced * width, kSeenCausticOfCaustic);
}

std::vector<LightSplat> LightSide::pass(PhotonSource& source, std::uint32_t iteration) {
    const StageTimer timer(stage_);
    SeenReceivers seen;
    if (texels_) {
        seen = lookOverSpecular(view_.scene, view_.camera, view_.request.seed, iteration, view_.workers);
        stage_.rays += seen.rays;
        texels_->look(seen.places, iteration);
        bounced_->look(seen.places, iteration);
    }
    LightPass pass = traceLightPaths(view_.scene, view_.camera, source.guide(),
                                     {view_.request.seed, kLightPass + iteration, source.paths()}, view_.workers,
                                     texels_ ? &view_.survey.visible : nullptr);
    addPhotonPass(stage_, pass);
    stage_.photonsStored += pass.splats.size();
    if (texels_) {
        texels_->deposit(pass.arrivals, iteration);
        texels_->resolve(iteration, pass.splats);
        bounced_->deposit(pass.bounced, iteration);
        bounced_->resolve(iteration, pass.splats);
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

#include "photon_source.h"

#include <cstring>
#include <utility>

namespace pellucid {

namespace {

/// The guide learns from each pass until it holds this many useful starts.
constexpr std::size_t kTrainingLimit = 400'000;
/// A pass replaces what was learnt if it has at least one useful start for so many of those.
constexpr std::size_t kLeastOfLast = 4;

}  // namespace

PhotonSource::PhotonSource(const PreparedView& view, std::vector<UsefulEmission> training)
    : view_(view), training_(std::move(training)), paths_(view.plan.causticPaths) {
    if (view.plan.causticMap || view.plan.lightPass) makeGuide();
}

void PhotonSource::makeGuide() { guide_ = std::make_unique<EmissionGuide>(view_.scene.lights(), training_); }

float PhotonSource::photonsPerEtendue() const noexcept { return static_cast<float>(paths_ * view_.plan.guideGain); }

bool PhotonSource::learnsFrom(std::uint32_t iteration) const noexcept {
    return view_.request.settings.guiding != "off" && training_.size() < kTrainingLimit &&
           isLearningIteration(iteration);
}

/// A pass of few photons knows less than what was learnt before.
void PhotonSource::learn(std::vector<UsefulEmission> useful) {
    if (useful.size() < training_.size() / kLeastOfLast) return;
    training_ = std::move(useful);
    makeGuide();
}

void PhotonSource::saveTo(CheckpointState& state) const {
    state.causticPaths = paths_;
    state.training.resize(training_.size() * sizeof(UsefulEmission));
    if (!training_.empty()) std::memcpy(state.training.data(), training_.data(), state.training.size());
}

bool PhotonSource::restoreFrom(const CheckpointState& state) {
    if (state.training.size() % sizeof(UsefulEmission) != 0) return false;
    paths_ = state.causticPaths;
    training_.resize(state.training.size() / sizeof(UsefulEmission));
    if (!training_.empty()) std::memcpy(training_.data(), state.training.data(), state.training.size());
    if (guide_) makeGuide();
    return true;
}

}  // namespace pellucid

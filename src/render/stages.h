/// What the stages of a render cost: wall time, rays, and the energy account of their photons.
#pragma once

#include <chrono>

#include <pellucid/render/render.h>

namespace pellucid {

using WallClock = std::chrono::steady_clock;

[[nodiscard]] inline double secondsSince(WallClock::time_point start) {
    return std::chrono::duration<double>(WallClock::now() - start).count();
}

/// What a render has taken of its budget of time.
class RenderClock {
public:
    explicit RenderClock(const Budget& budget) : budget_(budget), start_(WallClock::now()) {}

    /// Seconds since the budget began, with what passes over some of the pixels would have taken for the whole image.
    [[nodiscard]] double elapsed() const { return secondsSince(start_) + budget_.startedSecondsAgo + unrendered_; }
    /// Whether more than `share` of the budget is gone; without a budget of time never.
    [[nodiscard]] bool past(double share) const { return budget_.seconds && elapsed() > share * *budget_.seconds; }
    void addUnrendered(double seconds) noexcept { unrendered_ += seconds; }

private:
    const Budget& budget_;
    WallClock::time_point start_;
    double unrendered_ = 0.0;
};

/// Adds wall time to a stage while it lives.
class StageTimer {
public:
    explicit StageTimer(StageRecord& stage) : StageTimer(stage, nullptr, 1.0) {}
    /// For a pass over some pixels, `scale` times fewer than the image has: the stage counts for all of them.
    StageTimer(StageRecord& stage, RenderClock& clock, double scale) : StageTimer(stage, &clock, scale) {}
    ~StageTimer() {
        const double seconds = secondsSince(start_);
        stage_.seconds += scale_ * seconds;
        if (clock_ != nullptr) clock_->addUnrendered((scale_ - 1.0) * seconds);
    }
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;

private:
    StageTimer(StageRecord& stage, RenderClock* clock, double scale)
        : stage_(stage), clock_(clock), scale_(scale), start_(WallClock::now()) {}

    StageRecord& stage_;
    RenderClock* clock_;
    double scale_;
    WallClock::time_point start_;
};

inline void addEnergy(StageRecord& stage, const EnergyBalance& pass) {
    stage.energy.add(pass);
    ++stage.photonPasses;
}

/// Of a CausticPass or LightPass.
template <class Pass>
void addPhotonPass(StageRecord& stage, const Pass& pass) {
    stage.rays += pass.rays;
    stage.photonsEmitted += pass.emitted;
    addEnergy(stage, pass.energy);
}

/// The stage with its energy as the mean of its passes, in watts: powers carry the square of the scene's scale.
[[nodiscard]] inline StageRecord withMeanEnergy(const StageRecord& stage, double scale) {
    StageRecord mean = stage;
    mean.energy = {};
    if (stage.photonPasses > 0) mean.energy.add(stage.energy, 1.0 / (stage.photonPasses * scale * scale));
    return mean;
}

}  // namespace pellucid

#include <pellucid/transport/progressive_radii.h>

#include <cmath>
#include <cstring>

namespace pellucid {

namespace {

/// Photons that a test needs: five a cell, as usual. The next one waits for twice as many, so that few tests are made.
constexpr float kEnough = 5.0F * KernelTally::kCells, kPatience = 2.0F;
/// chi^2 with seven degrees of freedom beyond which light is not even (p = 0.01), and what the squared radius becomes then.
constexpr double kUneven = 18.475;
constexpr float kShrunk = 0.75F;

}  // namespace

ProgressiveRadii::ProgressiveRadii(std::size_t pixels, Shrink by, double alpha)
    : by_(by), alpha_(alpha), pixels_(pixels), evidence_(by == Shrink::ChiSquare ? pixels : 0) {
    if (by == Shrink::ChiSquare)
        for (State& s : pixels_) s.counted = kEnough;
}

float ProgressiveRadii::scale(std::size_t pixel) const noexcept { return std::sqrt(pixels_[pixel].scale2); }

void ProgressiveRadii::update(std::size_t pixel, const KernelTally& met) noexcept {
    State& s = pixels_[pixel];
    if (met.photons == 0) return;
    if (by_ == Shrink::Alpha) {
        const double before = static_cast<double>(s.counted), m = met.photons, after = before + alpha_ * m;
        s.scale2 = static_cast<float>(static_cast<double>(s.scale2) * after / (before + m));
        s.counted = static_cast<float>(after);
        return;
    }
    KernelTally& evidence = evidence_[pixel];
    evidence.add(met);
    const auto photons = static_cast<float>(evidence.equalPhotons());
    if (photons < s.counted) return;
    if (evidence.chiSquare() > kUneven) {
        s = {kShrunk * s.scale2, kEnough};
        evidence = {};
    } else {
        s.counted = kPatience * photons;
    }
}

std::vector<char> ProgressiveRadii::save() const {
    const std::size_t states = pixels_.size() * sizeof(State), tallies = evidence_.size() * sizeof(KernelTally);
    std::vector<char> bytes(states + tallies);
    std::memcpy(bytes.data(), pixels_.data(), states);
    if (tallies > 0) std::memcpy(bytes.data() + states, evidence_.data(), tallies);
    return bytes;
}

bool ProgressiveRadii::restore(const char* bytes, std::size_t size) {
    const std::size_t states = pixels_.size() * sizeof(State), tallies = evidence_.size() * sizeof(KernelTally);
    if (size != states + tallies) return false;
    std::memcpy(pixels_.data(), bytes, states);
    if (tallies > 0) std::memcpy(evidence_.data(), bytes + states, tallies);
    return true;
}

}  // namespace pellucid

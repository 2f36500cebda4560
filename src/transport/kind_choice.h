/// One kind of lobe drawn by its share of the value, where several could have made a direction: so every path class gets its
/// own energy.
#pragma once

#include <array>

#include <pellucid/math/rgb.h>
#include <pellucid/surface/bsdf.h>

namespace pellucid {

struct KindChoice {
    LobeKinds kind = kNoLobe;  ///< none: all were black
    Rgb value{0.0F};           ///< of that kind
    float part = 0.0F;         ///< its mean over the colours, and that
    float total = 0.0F;        ///< of all kinds: the estimate is value x total / part
};

/// `byKind`: S, G, D. `choose` is uniform in [0, 1).
[[nodiscard]] inline KindChoice chooseKind(const std::array<Rgb, 3>& byKind, float choose) noexcept {
    const float total = average(byKind[0]) + average(byKind[1]) + average(byKind[2]);
    if (!(total > 0.0F)) return {};
    KindChoice chosen;
    float left = choose * total;
    for (std::size_t k = 0; k < 3; ++k) {
        const float part = average(byKind[k]);
        if (!(part > 0.0F)) continue;
        chosen = {static_cast<LobeKinds>(1U << k), byKind[k], part, total};
        if (left < part) break;
        left -= part;
    }
    return chosen;
}

}  // namespace pellucid

/// Error maps for the eye: a perceptually uniform scale from black over purple and orange to pale yellow.
#pragma once

#include <pellucid/math/image.h>

namespace pellucid {

/// Linear Rec.709 colour of `value` in [0, 1]; values outside are clamped. Lightness rises evenly with the value.
[[nodiscard]] Rgb falseColour(float value) noexcept;

/// R, G, B from the first channel of `map`.
[[nodiscard]] Image falseColourImage(const Image& map);

}  // namespace pellucid

/// Small pictures for the textured scene, drawn pixel by pixel.
#pragma once

#include <glm/glm.hpp>

#include "png.h"

namespace scenes {

/// Two colours (sRGB bytes) in a square of cells x cells.
[[nodiscard]] Pixels checker(int size, int cells, const glm::u8vec3& even, const glm::u8vec3& odd);
/// A leaf in RGBA: alpha 0 outside, and a lighter midrib.
[[nodiscard]] Pixels leaf(int size);
/// A tangent-space normal map (+y up, glTF's convention) of rounded studs, studs x studs, that tiles without a seam.
[[nodiscard]] Pixels studs(int size, int count);
/// Roughness in G and metallic in B: vertical bands from smooth to rough metal.
[[nodiscard]] Pixels roughnessBands(int size, int bands);

}  // namespace scenes

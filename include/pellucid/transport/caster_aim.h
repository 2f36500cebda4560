/// Aiming photons at casters before any photon has found one. A glass ball of ten centimetres in a hall of a hundred metres is
/// met by one path in a million: a pilot learns nothing from so few. So each caster is first replaced by a sphere as large as
/// the scene, which every path meets, and the sphere shrinks to the caster's own: in each step the guide that the last one has
/// taught meets the smaller sphere often enough to teach the next. (Multilevel splitting [KahnHarris1951] in the guide's own
/// space; no ray is traced, only spheres are tested.) What hides a caster is not asked: the pilot's photons tell.
#pragma once

#include <cstdint>
#include <vector>

#include <pellucid/base/parallel.h>
#include <pellucid/scene/scene.h>
#include <pellucid/transport/emission_guide.h>

namespace pellucid {

/// Starts whose rays meet the bounding spheres of casters, as a guide learns from them: each lamp with each caster has the same weight.
/// At most `kMostAimed` casters, the smallest ones: those are hard to find.
[[nodiscard]] std::vector<UsefulEmission> aimAtCasters(const Scene& scene, std::uint64_t seed, const Workers& workers);

inline constexpr std::size_t kMostAimed = 8;

}  // namespace pellucid

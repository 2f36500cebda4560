/// The words of the settings as the types of the floors below.
#pragma once

#include <string>

#include <pellucid/math/sampler.h>
#include <pellucid/render/settings.h>
#include <pellucid/transport/kernel_radius.h>
#include <pellucid/transport/photon_kernel.h>
#include <pellucid/transport/progressive_radii.h>
#include <pellucid/transport/walk.h>

namespace pellucid {

[[nodiscard]] TransportOptions transportOptions(const Settings& settings);
[[nodiscard]] PhotonKernel photonKernel(const std::string& name);
[[nodiscard]] Shrink shrinkNamed(const std::string& name);
[[nodiscard]] KernelRadiusOptions radiusOptions(const Settings& settings);
[[nodiscard]] SamplerKind samplerKind(const std::string& name);

}  // namespace pellucid

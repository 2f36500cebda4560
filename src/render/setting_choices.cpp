#include "setting_choices.h"

#include <tuple>

namespace pellucid {

TransportOptions transportOptions(const Settings& settings) {
    TransportOptions o;
    o.powerHeuristic = settings.misHeuristic == "power";
    const auto& [directions, lights] = std::tie(settings.directions, settings.lightStrategy);
    o.directions = directions == "uniform"  ? Directions::Uniform
                   : directions == "cosine" ? Directions::Cosine
                                            : Directions::Bsdf;
    o.lights = lights == "none"  ? LightStrategy::Chance
               : lights == "nee" ? LightStrategy::NextEvent
                                 : LightStrategy::Both;
    o.rouletteThreshold = static_cast<float>(settings.rouletteThreshold);
    o.maxDepth = settings.maxDepth;
    return o;
}

PhotonKernel photonKernel(const std::string& name) {
    if (name == "uniform") return PhotonKernel::Uniform;
    if (name == "cone") return PhotonKernel::Cone;
    return name == "biweight" ? PhotonKernel::Biweight : PhotonKernel::Epanechnikov;
}

Shrink shrinkNamed(const std::string& name) { return name == "chi2" ? Shrink::ChiSquare : Shrink::Alpha; }

KernelRadiusOptions radiusOptions(const Settings& settings) {
    KernelRadiusOptions options;
    options.enough *= photonsWanted(photonKernel(settings.kernel));
    return options;
}

SamplerKind samplerKind(const std::string& name) {
    if (name == "independent") return SamplerKind::Independent;
    if (name == "stratified") return SamplerKind::Stratified;
    return name == "halton" ? SamplerKind::Halton : SamplerKind::Sobol;
}

}  // namespace pellucid

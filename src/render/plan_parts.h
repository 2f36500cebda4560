/// The parts of makePlan(): each decides about one side of the render and writes down why.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include <pellucid/render/plan.h>

namespace pellucid {

[[nodiscard]] inline bool isOff(const std::string& choice) { return choice == "off"; }
[[nodiscard]] inline bool isOn(const std::string& choice) { return choice == "on"; }

inline void decide(Plan& plan, std::string name, std::string choice, std::string reason, bool overridden = false) {
    plan.decisions.push_back({std::move(name), std::move(choice), std::move(reason), overridden});
}

/// Light paths of an iteration, within what any image needs and gets.
[[nodiscard]] inline std::uint32_t pathsOfPass(double wanted) {
    return static_cast<std::uint32_t>(std::clamp(wanted, 2e4, 4e6));
}

/// Points, spots and directions: light that no path meets by chance.
[[nodiscard]] std::size_t pointLikeLights(const Lights& lights);

/// Trains emission guiding; returns how many pilot photons were useful.
[[nodiscard]] std::size_t pilotCaustics(Plan& plan, const Scene& scene, const RenderRequest& request,
                                        const Survey& seen, const Workers& workers);
void planCaustics(Plan& plan, const Scene& scene, const RenderRequest& request, const Survey& seen,
                  const Workers& workers);
/// Cache and global map.
void planIndirect(Plan& plan, const Scene& scene, const Camera& camera, const RenderRequest& request,
                  const Survey& seen, const Workers& workers);
/// Progressive photon mapping: what the caustic map does not hold.
void planOthers(Plan& plan, const Scene& scene, const RenderRequest& request, const Survey& seen,
                const Workers& workers);

}  // namespace pellucid

// The gates of `pellucid check` must fail when the renderer is wrong: closed forms with a bug planted in the scene, in the
// method's settings or in the samples, beside the same without it.
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <pellucid/math/constants.h>

#include "../../src/study/check_formulas.h"
#include "../../src/study/check_measure.h"

namespace pellucid {
namespace {

using namespace check;

const glm::dvec3 kUp(0, 0, 1);

/// Whether all figures pass, and there are any.
[[nodiscard]] bool holds(const std::vector<Finding>& findings) {
    bool all = !findings.empty();
    for (const Finding& f : findings) all = all && f.passed();
    return all;
}

/// Closed form 2, a room of Le = 1 and rho = 0.8, but of this emission and with paths of at most so many vertices.
[[nodiscard]] std::vector<Finding> room(const Workers& workers, const By& by, float emission, int maxDepth) {
    SceneBuilder b;
    b.box(glm::dvec3(-1.0), glm::dvec3(1.0), lambert(0.8F, emission), true);
    b.perspective({0.1, -0.2, 0.3}, {0.9, 0.5, -0.4}, 1.6);
    Settings settings = smallSettings();
    settings.maxDepth = maxDepth;
    return measure({workers, 0}, {b.description(), {}, 5.0, 1.0, "radiance", {by}, 8, settings});
}

TEST(CheckGate, SeesEnergyThatIsLostOrMade) {
    const Workers workers(2);
    const By path{Method::Path, 32, 0.0, 0.03}, photon{Method::Photon, 4, 0.01, 0.03};
    EXPECT_TRUE(holds(room(workers, path, 1.0F, 0)));
    EXPECT_TRUE(holds(room(workers, photon, 1.0F, 0)));
    EXPECT_FALSE(holds(room(workers, path, 1.05F, 0)));  // 5 % too bright
    EXPECT_FALSE(holds(room(workers, path, 1.0F, 12)));  // paths cut: 5 % lost in the tail
    EXPECT_FALSE(holds(room(workers, photon, 1.05F, 0)));
}

/// Closed form 15, sun through a slab, with glass of this index and half width.
[[nodiscard]] std::vector<Finding> slab(const Workers& workers, float ior, double halfSlab) {
    SceneBuilder b;
    b.square(glm::dvec3(0.0), kUp, 1.0, lambert(0.5F));
    b.box({-halfSlab, -halfSlab, 0.5}, {halfSlab, halfSlab, 0.7}, glass(ior));
    b.sun({0, 0, -1}, 3.0);
    b.view(glm::dvec3(0.0), kUp, 0.8, 0.3);
    return measure({workers, 0}, {b.description(),
                                  {},
                                  3.0 * slabTransmittance(1.0, 1.5),
                                  kPiD / 0.5,
                                  "irradiance",
                                  {{Method::Photon, 16, 0.005, 0.02, "caustic"}},
                                  16,
                                  smallSettings()});
}

TEST(CheckGate, SeesCausticsThatAreWrong) {
    const Workers workers(2);
    EXPECT_TRUE(holds(slab(workers, 1.5F, 1.0)));
    EXPECT_FALSE(holds(slab(workers, 1.6F, 1.0)));   // 2.4 % too little gets through
    EXPECT_FALSE(holds(slab(workers, 1.5F, 0.38)));  // a rim without caustic, 10 % of the patch
}

TEST(CheckGate, AFigureMustBeANumberAndSharp) {
    const Finding good{"x", 1.0, 1.01, 0.02, 0.0, 0.03};
    EXPECT_TRUE(good.passed());
    Finding f = good;
    f.measured = 1.03;  // beyond its interval
    EXPECT_FALSE(f.passed());
    f = good, f.interval = 0.05;  // so noisy that it says nothing
    EXPECT_FALSE(f.passed());
    f = good, f.measured = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(f.passed());
    f = good, f.interval = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(f.passed());
    CheckCase thrown{"thrown", CheckGroup::Extreme,
                     "",       "",
                     true,     [](const CheckContext&) -> std::vector<Finding> { throw std::runtime_error("burst"); }};
    const Workers workers(1);
    EXPECT_FALSE(runCheck(thrown, {workers, 0}).passed());
    CheckCase silent{
        "silent", CheckGroup::Extreme, "", "", true, [](const CheckContext&) { return std::vector<Finding>{}; }};
    EXPECT_FALSE(runCheck(silent, {workers, 0}).passed());  // no figure is no success
}

/// The names carry the numbers of the 28 closed forms: none may go missing.
TEST(CheckCases, EveryClosedFormIsThere) {
    for (int number = 1; number <= 28; ++number) {
        const std::string name = fmt::format("closed-form-{}-", number);
        EXPECT_FALSE(selectChecks(name, false).empty()) << name;
    }
}

}  // namespace
}  // namespace pellucid

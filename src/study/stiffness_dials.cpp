#include "stiffness_dials.h"

#include <array>
#include <cmath>
#include <utility>

#include <pellucid/math/constants.h>

#include "check_formulas.h"
#include "check_scenes.h"

namespace pellucid {

namespace {

using namespace check;

constexpr double kRho = 0.5;
const glm::dvec3 kUp(0, 0, 1);

/// A lamp that faces a mirror, its back to the floor: all light comes over the mirror, from the lamp's image. Its power
/// stays the same. Up to a half width of 0.3 it hangs above the way from its image to the patch.
[[nodiscard]] Known lampSize(double half) {
    const double radiance = 1.0 / (4.0 * half * half);
    SceneBuilder b;
    b.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, lambert(static_cast<float>(kRho)));
    b.quad({1, -1, 0}, {0, 0, 2}, {0, 2, 0}, mirror(1.0F));
    b.quad({0.2, -half, 0.6 - half}, {0, 2.0 * half, 0}, {0, 0, 2.0 * half}, lamp(static_cast<float>(radiance)));
    b.view(glm::dvec3(-0.3, 0, 0), kUp, 0.4, 0.2);
    return {b.description(), [=](const glm::dvec3& p) {
                const std::array<glm::dvec3, 4> image{glm::dvec3(1.8, -half, 0.6 - half),
                                                      {1.8, half, 0.6 - half},
                                                      {1.8, half, 0.6 + half},
                                                      {1.8, -half, 0.6 + half}};
                return kRho / kPiD * radiance * polygonIrradiance(p, kUp, image);
            }};
}

/// A closed room of uniform emission: Le / (1 - rho). The dial is 1 - rho.
[[nodiscard]] Known albedo(double absorbed) {
    const float rho = static_cast<float>(1.0 - absorbed);
    SceneBuilder b;
    b.box(glm::dvec3(-1.0), glm::dvec3(1.0), lambert(rho, 1.0F), true);
    b.perspective({0.1, -0.2, 0.3}, {0.9, 0.5, -0.4}, 1.6);
    Known known{b.description(), [=](const glm::dvec3&) { return 1.0 / (1.0 - static_cast<double>(rho)); }};
    // As many vertices at every step, or nearly so: a path has 1 / (1 - rho) of them.
    known.settings.globalPhotons = absorbed < 0.05 ? 1000 : 5000;
    known.settings.gatherRays = absorbed < 0.05 ? 16 : 64;
    known.pathSamples = absorbed < 0.005 ? 2 : absorbed < 0.05 ? 8 : 32;
    known.photonSamples = 2;
    return known;
}

/// A small lamp faces a metal mirror as in lampSize, and the metal is roughened. The light that a rough mirror throws on the
/// floor has no closed form; it is integrated over the mirror with the same microfacet model [Walter2007], in double and
/// apart from the renderer.
struct RoughMirror {
    double alpha, half = 0.05, radiance = 1.0 / (4.0 * 0.05 * 0.05);
    /// f cos at the mirror x = 1 (normal -x) from direction wi to wo, GGX with Smith's height-correlated masking, F = 1.
    [[nodiscard]] double reflected(const glm::dvec3& wi, const glm::dvec3& wo) const {
        const glm::dvec3 n(-1, 0, 0), h = glm::normalize(wi + wo);
        const double ci = glm::dot(n, wi), co = glm::dot(n, wo), ch = glm::dot(n, h), a2 = alpha * alpha;
        if (ci <= 0.0 || co <= 0.0) return 0.0;
        const double k = ch * ch * (a2 - 1.0) + 1.0, d = a2 / (kPiD * k * k);
        const auto lambda = [a2](double c) { return 0.5 * (std::sqrt(1.0 + a2 * (1.0 - c * c) / (c * c)) - 1.0); };
        return d / (1.0 + lambda(ci) + lambda(co)) / (4.0 * co);  // f cos(theta_i)
    }
};

/// The slab of closed form 15 over a wide lamp: T = 2n / (n^2 + 1) for any index. The dial is n - 1.
[[nodiscard]] Known index(double excess) {
    const auto ior = static_cast<float>(1.0 + excess);
    const double n = static_cast<double>(ior);
    SceneBuilder b;
    b.box({-3, -3, 0}, {3, 3, 0.25}, glass(ior));
    b.square({0, 0, -0.5}, kUp, 3.0, lamp(1.0F));
    b.view(glm::dvec3(0.0), kUp, 0.5, 2.0);
    return {b.description(), [=](const glm::dvec3&) { return 2.0 * n / (n * n + 1.0); }};
}

/// The lamp, the mirror and the floor of lampSize in other units: nothing may change.
[[nodiscard]] Known scale(double factor) {
    Known known = lampSize(0.2);
    known.scene = transformed(std::move(known.scene), factor, glm::dvec3(0.0));
    const auto plain = known.radiance;
    known.radiance = [=](const glm::dvec3& p) { return plain(p / factor); };
    return known;
}

/// Two closed rooms wall to wall, the far side of the wall a thousand times brighter: each is Le / (1 - rho), and what leaks
/// through the wall is error. The camera looks at the foot of the wall in the darker room.
[[nodiscard]] Known wallGap(double gap) {
    SceneBuilder b;
    b.box({-1.0 - gap, 0, 0}, {-gap, 1, 1}, lambert(0.5F, 1000.0F), true);
    b.box({0, 0, 0}, {1, 1, 1}, lambert(0.5F, 1.0F), true);
    b.perspective({0.4, 0.5, 0.3}, {0.0, 0.5, 0.0}, 0.7);
    Known known{b.description(), [](const glm::dvec3&) { return 2.0; }};
    known.settings.gatherRays = 128;
    return known;
}

/// The mirror of lampSize, roughened: glTF squares the roughness to alpha.
[[nodiscard]] Known roughness(double value) {
    const RoughMirror m{value * value};
    SceneBuilder b;
    // No floor before the lamp: what it lights there a rough mirror would throw back to where we look.
    b.quad({-1, -1, 0}, {1.2, 0, 0}, {0, 2, 0}, lambert(static_cast<float>(kRho)));
    b.quad({1, -1, 0}, {0, 0, 2}, {0, 2, 0}, mirror(1.0F, static_cast<float>(value)));
    b.quad({0.2, -m.half, 0.6 - m.half}, {0, 2.0 * m.half, 0}, {0, 0, 2.0 * m.half},
           lamp(static_cast<float>(m.radiance)));
    b.view(glm::dvec3(-0.3, 0, 0), kUp, 0.4, 0.2);
    Known known;
    known.scene = b.description();
    known.radiance = [m](const glm::dvec3& p) {
        if (m.alpha < 1e-4) {
            const std::array<glm::dvec3, 4> image{glm::dvec3(1.8, -m.half, 0.6 - m.half),
                                                  {1.8, m.half, 0.6 - m.half},
                                                  {1.8, m.half, 0.6 + m.half},
                                                  {1.8, -m.half, 0.6 + m.half}};
            return kRho / kPiD * m.radiance * polygonIrradiance(p, kUp, image);
        }
        // Around the mirror image's place, where the integrand is: the narrower, the smoother the metal.
        constexpr int kSteps = 32, kLamp = 3;
        double sum = 0.0;
        for (int i = 0; i < kLamp * kLamp; ++i) {
            const glm::dvec3 light(0.2, m.half * ((i % kLamp + 0.5) * 2.0 / kLamp - 1.0),
                                   0.6 + m.half * ((i / kLamp + 0.5) * 2.0 / kLamp - 1.0));
            const double t = (1.0 - p.x) / (1.8 - p.x);
            const glm::dvec2 spot(p.y + t * (light.y - p.y), p.z + t * (light.z - p.z));
            for (int a = 0; a < 2 * kSteps; ++a)
                for (int r = 0; r < kSteps; ++r) {
                    // Polar around the spot; radius s(u) spreads from alpha's size to the whole mirror.
                    const double u = (r + 0.5) / kSteps, w = 0.5 * m.alpha, s = w * std::sinh(u * std::asinh(3.0 / w)),
                                 ds = std::asinh(3.0 / w) * std::sqrt(w * w + s * s) / kSteps,
                                 phi = kPiD * (a + 0.5) / kSteps;
                    const glm::dvec3 q(1.0, spot.x + s * std::cos(phi), spot.y + s * std::sin(phi));
                    if (std::fabs(q.y) > 1.0 || q.z < 0.0 || q.z > 2.0) continue;
                    const glm::dvec3 toLight = light - q, toFloor = p - q;
                    const double dl = glm::length(toLight), df = glm::length(toFloor);
                    const double lampCosine = (q.x - light.x) / dl, floorCosine = q.z / df;
                    sum += m.reflected(toLight / dl, toFloor / df) * m.radiance * lampCosine / (dl * dl) * floorCosine *
                           ((1.0 - p.x) / df) / (df * df) * s * ds * kPiD / kSteps;
                }
        }
        return kRho / kPiD * sum * 4.0 * m.half * m.half / (kLamp * kLamp);
    };
    known.pathSamples = 128;
    return known;
}

}  // namespace

const std::vector<Dial>& dials() {
    static const std::vector<Dial> list{{"lamp size",
                                         "half width of the lamp, m",
                                         "A lamp of constant power faces a mirror and lights a floor over it.",
                                         "irradiance of the lamp's image",
                                         "[Lambert1760]",
                                         {0.3, 0.1, 0.03, 1e-2, 1e-3, 1e-4},
                                         lampSize},
                                        {"albedo",
                                         "1 - albedo",
                                         "A closed room of uniform emission and reflectance.",
                                         "Le / (1 - rho)",
                                         "Neumann series",
                                         {1.0, 0.5, 0.1, 0.03, 0.01, 0.001},
                                         albedo},
                                        {"roughness",
                                         "roughness of the mirror",
                                         "A lamp of 10 cm faces a metal mirror that is roughened.",
                                         "integral over the mirror with the GGX model",
                                         "[Walter2007]",
                                         {1.0, 0.6, 0.3, 0.1, 0.03, 0.01, 1e-5},
                                         roughness},
                                        {"ior",
                                         "index of refraction - 1",
                                         "A slab of glass over a wide lamp.",
                                         "T = 2n / (n^2 + 1)",
                                         "[Hecht2002, eqs. 4.34-4.40]",
                                         {3.0, 0.5, 0.1, 1e-2, 1e-3, 1e-4, 1e-6},
                                         index},
                                        {"scale",
                                         "factor on all lengths",
                                         "The lamp, the mirror and the floor in other units.",
                                         "irradiance of the lamp's image",
                                         "[Lambert1760]",
                                         {1.0, 1e-6, 1e-4, 1e-2, 1e2, 1e4, 1e7},
                                         scale},
                                        {"wall gap",
                                         "thickness of the wall, m",
                                         "A room behind a wall from one that is a thousand times brighter.",
                                         "Le / (1 - rho)",
                                         "Neumann series",
                                         {1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5},
                                         wallGap}};
    return list;
}

}  // namespace pellucid

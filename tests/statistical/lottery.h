/// What must hold in scenes drawn at random: every method has the light that the reference has, and a furnace is even.
#pragma once

#include <iostream>

#include <gtest/gtest.h>

#include "agreement.h"
#include "random_scene.h"

namespace pellucid::testing {

/// Radiance of the whole image, over seeds.
[[nodiscard]] inline MeanOfSeeds radianceBy(const Scene& scene, Method method, std::uint32_t samples,
                                            std::uint64_t firstSeed, const Workers& workers) {
    Rendering what{method, samples, 10, firstSeed};
    what.width = what.height = 24;
    return imageOverSeeds(valuesOf(renderSeeds(scene, what, workers), 8));
}

/// Caustics of lights without extent in mirrors and through glass are the photons' and the texels' alone.
[[nodiscard]] inline bool seenByPhotonsAlone(const SceneDescription& scene) { return !scene.lights.empty(); }

struct Tried {
    Method method;
    std::uint32_t samples;
    double bias;  ///< that it may have, relative
};
inline constexpr Tried kTried[] = {
    {Method::Path, 24, 0.0}, {Method::Bdpt, 12, 0.0}, {Method::Photon, 8, 0.015}, {Method::Sppm, 8, 0.06}};
inline constexpr const char* kTriedNames[] = {"path", "bdpt", "photon", "sppm"};

/// Standard errors that a method may be off by. A firefly in one of the seeds makes the error, not the distance in errors.
inline constexpr double kMostErrors = 6.0;

/// `effort`: times as many samples as make a quick look.
inline void expectOneLight(int number, std::uint32_t effort) {
    const Workers workers;
    const SmallScene s = SceneLottery(static_cast<std::uint64_t>(number)).draw();
    std::cout << number << " " << s.name << "\n";
    const Scene scene(s.scene, s.environment, SceneOptions{}, workers);
    const MeanOfSeeds reference = radianceBy(scene, Method::Reference, 16 * effort, 1, workers);
    for (std::size_t i = 0; i < std::size(kTried); ++i) {
        const Tried& t = kTried[i];
        const MeanOfSeeds measured = radianceBy(scene, t.method, t.samples * effort, 100, workers);
        const double error = std::sqrt(measured.variance + reference.variance), off = measured.mean - reference.mean;
        std::cout << "  " << kTriedNames[i] << " " << 100.0 * off / reference.mean << " % +- "
                  << 100.0 * error / reference.mean << "\n";
        const double allowed = kMostErrors * error + t.bias * reference.mean;
        EXPECT_LE(off, allowed) << kTriedNames[i] << " in scene " << number << " " << s.name;
        if (t.bias > 0.0 || !seenByPhotonsAlone(s.scene)) {
            EXPECT_GE(off, -allowed) << kTriedNames[i] << " in scene " << number << " " << s.name;
        }
    }
}

inline void expectEvenFurnace(int number, std::uint32_t effort) {
    const Workers workers;
    const SmallScene s = SceneLottery(static_cast<std::uint64_t>(number)).drawFurnace();
    std::cout << number << " " << s.name << "\n";
    const Scene scene(s.scene, s.environment, SceneOptions{}, workers);
    for (std::size_t i = 0; i < std::size(kTried); ++i) {
        const Tried& t = kTried[i];
        const MeanOfSeeds measured = radianceBy(scene, t.method, t.samples * effort, 1, workers);
        const double error = std::sqrt(measured.variance);
        std::cout << "  " << kTriedNames[i] << " " << measured.mean << " +- " << error << "\n";
        EXPECT_NEAR(measured.mean, 1.0, kMostErrors * error + t.bias + 1e-4)
            << kTriedNames[i] << " in furnace " << number << " " << s.name;
    }
}

}  // namespace pellucid::testing

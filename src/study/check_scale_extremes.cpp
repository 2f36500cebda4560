// Extremes of size and place: the same scene in other units, or far from the origin, is the same picture.
#include <array>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "check_cases.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

/// A room corner with a glass ball, a mirror, a lamp, a point light and coloured-by-depth glass: every kind of path.
[[nodiscard]] SceneDescription mixedScene() {
    SceneBuilder b;
    b.square({0, 0, 0}, {0, 0, 1}, 1.0, lambert(0.6F));
    b.quad({-1, 1, 0}, {2, 0, 0}, {0, 0, 1.5}, lambert(0.5F));
    b.quad({1, -1, 0}, {0, 0, 1.5}, {0, 2, 0}, mirror(0.8F));
    b.sphere({0.1, 0, 0.35}, 0.3, 24, glass(1.5F, 2.0F), true);
    b.quad({-0.4, -0.3, 1.4}, {0, 0.5, 0}, {0.5, 0, 0}, lamp(6.0F));
    b.point({0.5, -0.5, 1.2}, 0.7);
    b.perspective({-0.8, -2.2, 1.1}, {0.05, 0.1, 0.3}, 0.7);
    return b.description();
}

/// By every method that shows all of the image.
struct Taken {
    Method method;
    std::uint32_t samples;
    const char* name;
};
constexpr std::array kTaken{Taken{Method::Path, 16, "path"}, Taken{Method::Photon, 4, "photon"},
                            Taken{Method::Bdpt, 8, "bdpt"}, Taken{Method::Reference, 4, "reference"}};
using Pictures = std::array<Image, kTaken.size()>;

[[nodiscard]] Pictures pictures(const CheckContext& context, SceneDescription description, std::uint64_t seed) {
    const Scene scene = makeScene(context, std::move(description));
    Settings settings = smallSettings();
    settings.gatherRays = 128;
    Pictures all;
    context.workers.forEach(all.size(), 1, [&](std::size_t m) {
        Settings own = settings;
        if (kTaken[m].method == Method::Reference) own.causticPhotons = 2000;  // light paths, here
        all[m] = renderOnce(context, scene, {kTaken[m].method, kTaken[m].samples}, own, 24, seed).image;
    });
    return all;
}

[[nodiscard]] double differentBits(const Image& a, const Image& b) {
    double count = 0.0;
    for (std::size_t i = 0; i < a.data().size(); ++i)
        if (std::bit_cast<std::uint32_t>(a.data()[i]) != std::bit_cast<std::uint32_t>(b.data()[i])) count += 1.0;
    return count;
}

/// Powers of two change no bit.
std::vector<Finding> powersOfTwo(const CheckContext& context) {
    std::vector<Finding> all;
    const Pictures plain = pictures(context, mixedScene(), context.seed);
    for (const int exponent : {-20, -10, 10, 23}) {
        const Pictures scaled =
            pictures(context, transformed(mixedScene(), std::ldexp(1.0, exponent), glm::dvec3(0.0)), context.seed);
        for (std::size_t m = 0; m < plain.size(); ++m)
            all.push_back(exact(fmt::format("values that differ at 2^{}, {}", exponent, kTaken[m].name), 0.0,
                                differentBits(plain[m], scaled[m]), 0.0));
    }
    return all;
}

/// Other factors round, and rounding sends a path behind glass elsewhere: the means must agree, paired by seed.
[[nodiscard]] std::vector<Finding> sameMeans(const CheckContext& context, const std::string& what,
                                             const std::function<SceneDescription()>& changed) {
    constexpr int kPairs = 3;
    std::array<double, kTaken.size()> ratio{};
    for (int i = 0; i < kPairs; ++i) {
        const std::uint64_t seed = context.seed + static_cast<std::uint64_t>(i);
        const Pictures a = pictures(context, mixedScene(), seed), b = pictures(context, changed(), seed);
        for (std::size_t m = 0; m < ratio.size(); ++m) ratio[m] += meanOf(b[m]) / meanOf(a[m]) / kPairs;
    }
    std::vector<Finding> all;
    for (std::size_t m = 0; m < ratio.size(); ++m)
        all.push_back(exact(fmt::format("{}: ratio of the means, {}", what, kTaken[m].name), 1.0, ratio[m], 0.01));
    return all;
}

std::vector<Finding> otherScales(const CheckContext& context) {
    std::vector<Finding> all;
    for (const double scale : {1e-6, 1e-3, 1e3, 1e7}) {
        auto found = sameMeans(context, fmt::format("scale {:g}", scale),
                               [=] { return transformed(mixedScene(), scale, glm::dvec3(0.0)); });
        all.insert(all.end(), found.begin(), found.end());
    }
    return all;
}

std::vector<Finding> farAway(const CheckContext& context) {
    return sameMeans(context, "moved by 1e5 radii",
                     [] { return transformed(mixedScene(), 1.0, glm::dvec3(1.3e5, -0.7e5, 0.4e5)); });
}

/// The image must not depend on how many threads made it.
std::vector<Finding> anyThreads(const CheckContext& context) {
    const Pictures one = [&] {
        const Workers workers(1);
        return pictures({workers, context.seed}, mixedScene(), context.seed);
    }();
    std::vector<Finding> all;
    for (const int threads : {2, 3}) {
        const Workers workers(threads);
        const Pictures many = pictures({workers, context.seed}, mixedScene(), context.seed);
        for (std::size_t m = 0; m < one.size(); ++m)
            all.push_back(exact(fmt::format("values that differ with {} threads, {}", threads, kTaken[m].name), 0.0,
                                differentBits(one[m], many[m]), 0.0));
    }
    return all;
}

}  // namespace

void addScaleExtremes(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, bool quick, auto run) {
        cases.push_back({name, CheckGroup::Extreme, guards, "invariance", quick, run});
    };
    add("extreme-scale-powers-of-two", "a scene scaled by 2^k gives the same bits", true, powersOfTwo);
    add("extreme-scale", "a scene scaled by 1e-6 to 1e7 gives the same picture", false, otherScales);
    add("extreme-place", "a scene 1e5 radii from the origin gives the same picture", false, farAway);
    add("extreme-threads", "1, 2 and 3 threads give the same bits", true, anyThreads);
}

}  // namespace pellucid::check

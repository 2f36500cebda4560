// Extremes of the photon method: one photon, none of use, all in one point; cache records in one place.
#include <chrono>
#include <cmath>

#include <pellucid/math/constants.h>
#include <pellucid/transport/caustic_map.h>
#include <pellucid/transport/irradiance_cache.h>

#include "check_cases.h"
#include "check_formulas.h"
#include "check_measure.h"

namespace pellucid::check {

namespace {

constexpr double kRho = 0.5;
const glm::dvec3 kUp(0, 0, 1);

/// Far too few photons give noise, never bias: sun through a slab, form 15.
std::vector<Finding> onePhoton(const CheckContext& context) {
    SceneBuilder b;
    b.square(glm::dvec3(0.0), kUp, 1.0, lambert(static_cast<float>(kRho)));
    b.box({-1, -1, 0.5}, {1, 1, 0.7}, glass(1.5F));
    b.sun({0, 0, -1}, 3.0);
    b.view(glm::dvec3(0.0), kUp, 1.4, 0.3);
    Settings settings = smallSettings();
    settings.causticPhotons = 1;
    settings.globalPhotons = 1;
    settings.causticRadius = 5.0;
    return measure(context, {b.description(),
                             {},
                             3.0 * slabTransmittance(1.0, 1.5),
                             kPiD / kRho,
                             "irradiance from 1 photon an iteration",
                             {{Method::Photon, 1600, 0.02, 0.3, "caustic"}},
                             8,
                             settings});
}

/// The glass stands where neither the lamp nor the camera finds it: the direct light alone remains.
std::vector<Finding> noUsefulPhoton(const CheckContext& context) {
    SceneBuilder b;
    b.square(glm::dvec3(0.0), kUp, 1.0, lambert(static_cast<float>(kRho)));
    b.sphere({0, 0, -0.6}, 0.3, 16, glass(1.5F), true);
    const glm::dvec3 light(0.4, -0.3, 0.8);
    b.point(light, 2.0);
    b.view(glm::dvec3(0.0), kUp, 0.2, 0.3);
    const double expected = meanOverSquare([&](double u, double v) {
        return pointIrradiance({0.2 * (u - 0.5), 0.2 * (v - 0.5), 0}, kUp, light, 2.0);
    });
    return measure(
        context,
        {b.description(), {}, expected, kPiD / kRho, "irradiance", {{Method::Photon, 8, 0.005}}, 16, smallSettings()});
}

std::vector<Finding> identicalPhotons(const CheckContext&) {
    constexpr int kCount = 100'000;
    const auto start = std::chrono::steady_clock::now();
    Photon p;
    p.wi = p.normal = glm::vec3(kUp);
    p.position = {0.3F, 0.2F, 0.0F};
    p.flux = Rgb(1.0F / kCount);
    const CausticMap map(PhotonList(kCount, p));
    const auto at = [&](float radius) {
        return static_cast<double>(map.irradiance(p.position, p.normal, p.normal, {Rgb(1.0F)}, radius).g);
    };
    const double wide = at(0.1F), tiny = at(4e-6F);
    for (int i = 0; i < 20; ++i) (void)at(0.1F);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return {exact("irradiance x pi r^2 / 2 at r = 0.1", 1.0, wide * kPiD * 0.01 / 2.0, 1e-4),
            exact("irradiance x pi r^2 / 2 at r = 4e-6", 1.0, tiny * kPiD * 1.6e-11 / 2.0, 1e-4),
            exact("map and 22 looks within 2 seconds", 1.0, seconds < 2.0 ? 1.0 : 0.0, 0.0)};
}

/// Only photons exist that all lie in a line, or that are one.
std::vector<Finding> fewPhotons(const CheckContext&) {
    const auto value = [](int count) {
        PhotonList photons;
        for (int i = 0; i < count; ++i) {
            Photon p;
            p.position = {0.01F * static_cast<float>(i), 0.0F, 0.0F};
            p.wi = p.normal = glm::vec3(kUp);
            p.flux = Rgb(1.0F);
            photons.push_back(p);
        }
        const CausticMap map(std::move(photons));
        return static_cast<double>(
            map.irradiance(glm::vec3(0.0F), glm::vec3(kUp), glm::vec3(kUp), {Rgb(1.0F)}, 0.005F).g);
    };
    const double alone = 2.0 / (kPiD * 0.005 * 0.005);
    return {exact("irradiance of an empty map", 0.0, value(0), 0.0),
            exact("of a single photon", alone, value(1), 1e-3 * alone),
            exact("of 1000 in a line, one within reach", alone, value(1000), 1e-3 * alone)};
}

/// Two sides of one sheet share places, never records.
std::vector<Finding> recordsOfTwoSides(const CheckContext&) {
    Bounds bounds;
    bounds.extend(glm::vec3(-1.0F));
    bounds.extend(glm::vec3(1.0F));
    IrradianceCache cache(bounds, 0.3F);
    const auto record = [](const glm::vec3& normal, float irradiance, float radius) {
        IrradianceRecord r;
        r.normal = normal;
        r.irradiance = Rgb(irradiance);
        r.radius = r.harmonicDistance = radius;
        return r;
    };
    for (int i = 0; i < 1000; ++i) {
        cache.insert(record(glm::vec3(kUp), 1.0F, 0.5F));
        cache.insert(record(-glm::vec3(kUp), 5.0F, 0.5F));
    }
    const auto at = [&](const glm::vec3& normal) {
        const auto found = cache.lookup(glm::vec3(0.01F, 0.0F, 0.0F), normal);
        return found ? static_cast<double>(found->plain.g) : -1.0;
    };
    const double above = at(glm::vec3(kUp)), below = at(-glm::vec3(kUp)), across = at({1, 0, 0});
    cache.insert(record(glm::vec3(kUp), 1.0F, 0.0F));  // in a crack, where nothing has any distance
    return {exact("irradiance above", 1.0, above, 1e-5), exact("irradiance below", 5.0, below, 1e-4),
            exact("nothing speaks across (-1)", -1.0, across, 0.0),
            exact("irradiance above beside a record of radius 0 is finite", 1.0,
                  std::isfinite(at(glm::vec3(kUp))) ? 1.0 : 0.0, 0.0)};
}

/// Every surface of a closed scene emits 1 and reflects a half, so all of it has radiance 2, however narrow its cracks: the
/// camera looks into a corner of the room, and into a gap of 1e-4 between two blocks.
std::vector<Finding> recordsInCorners(const CheckContext& context) {
    const Material wall = lambert(static_cast<float>(kRho), 1.0F);
    const auto room = [&](const glm::dvec3& eye, const glm::dvec3& target, double fov, const char* quantity) {
        SceneBuilder b;
        b.box(glm::dvec3(-1.0), glm::dvec3(1.0), wall, true);
        b.box({-0.5, -0.3, -1.0 + 1e-4}, {-5e-5, 0.3, -0.4}, wall);
        b.box({5e-5, -0.3, -1.0 + 1e-4}, {0.5, 0.3, -0.4}, wall);
        b.perspective(eye, target, fov);
        return measure(context, {b.description(),
                                 {},
                                 2.0,
                                 1.0,
                                 quantity,
                                 {{Method::Path, 16, 0.0}, {Method::Photon, 8, 0.02, 0.05}},
                                 16,
                                 smallSettings()});
    };
    std::vector<Finding> all = room({0.5, 0.5, 0.5}, glm::dvec3(1.0), 0.3, "radiance in a corner");
    const std::vector<Finding> edge = room({0.7, 0.0, 0.7}, {1.0, 0.05, 1.0}, 0.3, "radiance along an edge");
    const std::vector<Finding> crack = room({0.0, 0.0, -0.39}, {0.0, 0.0, -0.4}, 0.05, "radiance at a crack");
    all.insert(all.end(), edge.begin(), edge.end());
    all.insert(all.end(), crack.begin(), crack.end());
    return all;
}

}  // namespace

void addPhotonExtremes(Cases& cases) {
    const auto add = [&cases](const char* name, const char* guards, const char* source, auto run) {
        cases.push_back({name, CheckGroup::Extreme, guards, source, true, run});
    };
    add("extreme-one-photon", "too few photons are noise, not bias", "form 15", onePhoton);
    add("extreme-no-useful-photon", "glass that plays no part", "form 9", noUsefulPhoton);
    add("extreme-identical-photons", "1e5 photons in one point: 2 flux / (pi r^2), in no time", "[Silverman1986]",
        identicalPhotons);
    add("extreme-few-photons", "maps of no photon, of one, of a line", "[Silverman1986]", fewPhotons);
    add("extreme-records-of-two-sides", "2000 records in one place with opposite normals", "invariance",
        recordsOfTwoSides);
    add("extreme-records-in-corners", "a closed room of Le = 1, rho = 0.5 is 2 all over, in corners and cracks too",
        "Neumann series", recordsInCorners);
}

}  // namespace pellucid::check

/// Every two unbiased estimators must mean the same image, and the gate that says so must see planted bugs.
#include <algorithm>

#include <gtest/gtest.h>

#include <pellucid/math/sampler.h>
#include <pellucid/transport/walk.h>

#include "agreement.h"
#include "class_groups.h"
#include "small_scenes.h"

namespace pellucid {
namespace {

using namespace testing;

Scene made(const SmallScene& s, const Workers& workers) {
    // Rough glass counts as glossy, so that no class is left with a handful of paths: a test by class wants more of them.
    SceneOptions options;
    options.lobeRules.glassCastRoughness = options.lobeRules.castRoughness;
    return Scene(s.scene, s.environment, options, workers);
}

class Estimators : public ::testing::TestWithParam<int> {};

TEST_P(Estimators, BidirectionalMeansWhatPathTracingMeans) {
    const SmallScene small = smallScenes()[static_cast<std::size_t>(GetParam())];
    const Workers workers;
    const Scene scene = made(small, workers);
    Rendering path{Method::Path, 64};
    path.settings = small.settings;
    path.width = path.height = 24;
    Rendering bdpt = path.by(Method::Bdpt, 32, 1000);
    const auto a = renderSeeds(scene, path, workers), b = renderSeeds(scene, bdpt, workers);
    for (const char* layer : {"", "emission", "direct", "caustic", "indirect"}) {
        const Agreement agreement = agreementOf(valuesOf(a, 2, layer), valuesOf(b, 2, layer));
        EXPECT_TRUE(agreement.holds(sidakLevel(40)))
            << small.name << ", " << (*layer == '\0' ? "all" : layer) << ": " << agreement;
        if (*layer == '\0') std::cout << small.name << ": " << agreement << "\n";
    }
}

INSTANTIATE_TEST_SUITE_P(SmallScenes, Estimators, ::testing::Range(0, 8));

/// The photon method has no direction of a D lobe to meet the sky with: it resamples next-event estimation, unbiased.
TEST(Estimators, ResampledSkyMeansTheSkyOfPathTracing) {
    const Workers workers;
    int skies = 0;
    for (const SmallScene& small : smallScenes()) {
        if (!small.environment) continue;
        ++skies;
        const Scene scene = made(small, workers);
        Rendering path{Method::Path, 64};
        path.width = path.height = 24;
        Rendering photon = path.by(Method::Photon, 32, 1000);
        photon.settings.globalPhotons = 5'000;
        const Agreement agreement = agreementOf(valuesOf(renderSeeds(scene, path, workers), 2, "direct"),
                                                valuesOf(renderSeeds(scene, photon, workers), 2, "direct"));
        EXPECT_TRUE(agreement.holds(sidakLevel(3))) << small.name << ": " << agreement;
    }
    EXPECT_GE(skies, 1);
}

/// The ladder of sampling: each rung is unbiased.
TEST(SamplingLadder, EveryRungMeansTheSameImage) {
    // Plastic, rough metal and a large lamp: no rung's noise has long tails, so that t-tests hold.
    check::SceneBuilder b;
    detail::addCorner(b, detail::coated(0.6F, 0.6F), detail::coloured({0.3F, 0.6F, 0.7F}));
    b.sphere({-0.3, 0.45, 0.1}, 0.45, 8, check::mirror(0.8F, 0.8F), true);
    b.square({0.2, 1.7, 0.4}, {0, -1, 0}, 0.7, check::lamp(3.0F));
    const Workers workers;
    const Scene scene(b.description(), std::nullopt, SceneOptions{}, workers);
    Rendering best{Method::Path, 64};
    best.width = best.height = 16;
    const SeedValues expected = valuesOf(renderSeeds(scene, best, workers), 2);
    const std::vector<std::pair<std::string, std::string>> rungs{
        {"path.directions", "cosine"},  {"path.directions", "uniform"}, {"path.lights", "nee"},
        {"path.lights", "none"},        {"path.sampler", "halton"},     {"path.sampler", "independent"},
        {"path.sampler", "stratified"}, {"path.roulette", "0"}};
    std::uint64_t seed = 1000;
    for (const auto& [name, value] : rungs) {
        Rendering rung = best;
        rung.samples = 128;
        rung.firstSeed = seed += 1000;
        setParameter(rung.settings, name, value);
        if (name == "path.roulette")
            rung.settings.maxDepth = 12;  // an open corner: what is farther out is too little to see
        const Agreement agreement = agreementOf(expected, valuesOf(renderSeeds(scene, rung, workers), 2));
        EXPECT_TRUE(agreement.holds(sidakLevel(24))) << name << "=" << value << ": " << agreement;
    }
}

/// Mean variance of a pixel over seeds.
double varianceOf(const Scene& scene, Rendering what, const std::vector<std::pair<std::string, std::string>>& settings,
                  const Workers& workers) {
    for (const auto& [name, value] : settings) setParameter(what.settings, name, value);
    const SeedValues values = valuesOf(renderSeeds(scene, what, workers), 1);
    double sum = 0.0;
    for (std::size_t i = 0; i < values.front().size(); ++i) sum += cellOverSeeds(values, i).variance;
    return sum;
}

/// Where theory says which is better: a small lamp on diffuse walls wants next-event estimation; without it a cosine
/// beats uniform directions; direct light of a soft lamp wants well spread samples.
TEST(SamplingLadder, VarianceFallsFromRungToRung) {
    const Workers workers;
    check::SceneBuilder b;
    detail::addCorner(b, detail::coloured({0.7F, 0.6F, 0.5F}), detail::coloured({0.3F, 0.6F, 0.7F}));
    b.square({0.2, 1.6, 0.3}, {0, -1, 0}, 0.5, check::lamp(4.0F));
    const Scene scene(b.description(), std::nullopt, SceneOptions{}, workers);
    Rendering what{Method::Path, 16, 16};
    what.width = what.height = 16;
    using Settings = std::vector<std::pair<std::string, std::string>>;
    const auto variance = [&](const Settings& s) { return varianceOf(scene, what, s, workers); };
    const double mis = variance({}), none = variance({{"path.lights", "none"}}),
                 nee = variance({{"path.lights", "nee"}});
    EXPECT_LT(mis, 0.5 * none);
    EXPECT_LT(nee, 0.5 * none);
    EXPECT_LT(none, 0.95 * variance({{"path.lights", "none"}, {"path.directions", "uniform"}}));
    const double independent = variance({{"path.sampler", "independent"}});
    EXPECT_LT(mis, 0.6 * independent);
    EXPECT_LT(variance({{"path.sampler", "stratified"}}), 0.8 * independent);
    EXPECT_LT(variance({{"path.sampler", "halton"}}), 0.8 * independent);

    // A rough mirror at a lamp: directions by the lobe.
    check::SceneBuilder m;
    detail::addCorner(m, check::mirror(0.8F, 0.35F), check::mirror(0.6F, 0.35F));
    m.square({0.0, 1.2, 0.0}, {0, -0.4, 1}, 0.6, check::lamp(2.0F));
    const Scene metal(m.description(), std::nullopt, SceneOptions{}, workers);
    const double byLobe = varianceOf(metal, what, {{"path.lights", "none"}}, workers);
    EXPECT_LT(byLobe, 0.5 * varianceOf(metal, what, {{"path.lights", "none"}, {"path.directions", "cosine"}}, workers));
}

/// Next-event estimation by hand at what the camera sees (through smooth glass, too), with or without a planted bug.
enum class Bug { None, MissingCosine, EtaLeftOut, LightTwice };

std::vector<Image> directByHand(const Scene& scene, const Rendering& what, Bug bug) {
    const Camera camera = scene.camera("", what.width, what.height);
    std::vector<Image> images;
    for (int s = 0; s < what.seeds; ++s) {
        Image image(what.width, what.height, {"R", "G", "B"});
        for (std::size_t i = 0; i < image.pixels(); ++i) {
            Rgb sum(0.0F);
            for (std::uint32_t k = 0; k < what.samples; ++k) {
                Sampler sampler(what.firstSeed + static_cast<std::uint64_t>(s), i, k);
                const glm::vec2 corner(i % static_cast<std::size_t>(what.width),
                                       i / static_cast<std::size_t>(what.width));
                Ray ray = camera.ray(corner + sampler.next2D(), {0.5F, 0.5F}).ray;
                Rgb throughput(1.0F);
                for (int bounce = 0; bounce < 4; ++bounce) {
                    const auto hit = scene.intersect(ray, 0.5F);
                    if (!hit) break;
                    const glm::vec3 wo = -ray.direction;
                    const Bsdf bsdf = scene.surfaces().bsdf(hit->point, wo);
                    const glm::vec3 n = bsdf.geometricNormal();
                    if (bsdf.kinds() == kSpecular) {
                        const auto next =
                            bsdf.sample(wo, sampler.next1D(), sampler.next2D(), kAllLobes,
                                        bug == Bug::EtaLeftOut ? TransportMode::Flux : TransportMode::Radiance);
                        if (!next) break;
                        throughput *= next->weight;
                        ray = Ray{offsetOrigin(hit->point.position, glm::dot(next->wi, n) < 0.0F ? -n : n), next->wi,
                                  std::numeric_limits<float>::infinity()};
                        continue;
                    }
                    const auto light =
                        scene.lights().sample(hit->point.position, n, sampler.next1D(), sampler.next2D());
                    if (!light) break;
                    const Ray shadow = shadowRay(hit->point.position, n, light->wi, light->distance);
                    Rgb f = bsdf.eval(wo, light->wi, kAllLobes, TransportMode::Radiance) * scene.visibility(shadow);
                    if (bug == Bug::MissingCosine) f /= std::max(1e-3F, glm::dot(light->wi, n));
                    if (bug == Bug::LightTwice && light->light == 0) f *= 2.0F;
                    sum += throughput * f * light->radiance / light->pdfSolidAngle;
                    break;
                }
            }
            image.setRgb(i, sum / static_cast<float>(what.samples));
        }
        images.push_back(std::move(image));
    }
    return images;
}

/// A camera inside of a glass body that looks out at a lit floor: of the path tracer's image the classes E D L and E S+ D L.
TEST(Estimators, TheGateSeesPlantedBugs) {
    check::SceneBuilder b;
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, check::lambert(0.6F));
    b.box({-0.7, 0.8, -0.7}, {0.7, 2.5, 0.7}, check::glass(1.5F));
    b.perspective({0.0, 2.0, 0.1}, {0.0, 0.0, 0.0}, 0.5);
    for (const double x : {-1.5, 1.6}) b.square({x, 0.7, 0.3}, {-x, -0.6, 0}, 0.3, check::lamp(4.0F));
    const Workers workers;
    const Scene scene(b.description(), std::nullopt, SceneOptions{}, workers);
    Rendering what{Method::Path, 32};
    what.width = what.height = 16;
    what.layers = {"classes"};
    const SeedValues expected = valuesOf(renderSeeds(scene, what, workers), 2, "class.ESDL");
    what.firstSeed = 500;
    const auto held = [&](Bug bug) { return agreementOf(expected, valuesOf(directByHand(scene, what, bug), 2)); };
    const Agreement right = held(Bug::None);
    EXPECT_TRUE(right.holds(sidakLevel(3))) << right;
    for (const Bug bug : {Bug::MissingCosine, Bug::EtaLeftOut, Bug::LightTwice}) {
        const Agreement wrong = held(bug);
        EXPECT_FALSE(wrong.holds(1e-6)) << static_cast<int>(bug) << ": " << wrong;
    }
}

/// Class by class: a double count or a loss names itself.
class ClassLedger : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(ClassLedger, PhotonsCarryWhatBidirectionalPathsCarry) {
    const Workers workers;
    for (const SmallScene& small : {roughGlass(), smoothCasters(), dispersion(), veils()}) {
        const Scene scene = made(small, workers);
        Rendering reference{Method::Bdpt, 64, 6};
        reference.width = reference.height = 20;
        reference.layers = {"classes"};
        Rendering photon = reference.by(Method::Photon, 12, 700);
        photon.settings.globalPhotons = 30'000;
        photon.settings.gatherRays = 256;
        if (*GetParam().first != '\0') {
            setParameter(photon.settings, GetParam().first, GetParam().second);
            photon.samples = 48;  // lamps are met by chance
        }
        expectSameEnergy(small.name, renderSeeds(scene, reference, workers), renderSeeds(scene, photon, workers));
    }
}

/// Caustics by photons, by photons and paths that meet the lamp, and by such paths alone.
INSTANTIATE_TEST_SUITE_P(Ways, ClassLedger,
                         ::testing::Values(std::pair{"", ""}, std::pair{"photon.chance", "on"},
                                           std::pair{"photon.caustic_map", "off"}));

/// Two estimators that both carry the caustics, path tracing with a caustic pass of light tracing on top: the gate says which
/// class is counted twice. And one that carries none of them: which is lost.
TEST(ClassGate, NamesTheClassThatIsCountedTwiceOrLost) {
    const Workers workers;
    const SmallScene small = smoothCasters();
    const Scene scene = made(small, workers);
    Rendering path{Method::Path, 64, 6};
    path.width = path.height = 16;
    path.layers = {"classes"};
    const std::vector<Image> right = renderSeeds(scene, path, workers);
    path.firstSeed = 400;
    const auto planted = [&](double factor) {
        std::vector<Image> images = renderSeeds(scene, path, workers);
        for (Image& image : images)
            for (const char* c : {"R", "G", "B"}) {
                const int channel = image.channel(std::string("class.EDSL.") + c);
                for (std::size_t i = 0; i < image.pixels(); ++i)
                    image.at(i, channel) = static_cast<float>(factor * static_cast<double>(image.at(i, channel)));
            }
        return images;
    };
    const auto none = [](const std::string&) { return 0.0; };
    for (const double factor : {1.0, 2.0, 0.0})
        for (const GroupDifference& d : compareGroups(right, planted(factor), none, 0.0))
            EXPECT_EQ(d.holds(), factor == 1.0 || d.group != "EDSL") << factor << ", " << d.group;
}

TEST(PathStrings, StringsAndGroups) {
    PathString path;
    EXPECT_EQ(path.name(), "EL");
    for (const LobeKinds kind : {kSpecular, kSpecular, kDiffuse, kSpecular}) path.pass(kind);
    EXPECT_EQ(path.name(), "ESDSL");
    path.pass(kSpecular);
    EXPECT_EQ(path.name(), "ESDSL");
    path.pass(kDiffuse);
    EXPECT_EQ(path.name(), "ESDS_L");
    path.pass(kSpecular);
    EXPECT_EQ(path.name(), "ESDS_L");
    EXPECT_EQ(stringOver({kDiffuse}).open().name(), "ED_L");
    EXPECT_EQ(stringOver({kSpecular, kGlossy, kSpecular}).layer(), PathClass::Caustic);
    EXPECT_EQ(stringOver({kSpecular, kDiffuse}).layer(), PathClass::Direct);
    EXPECT_EQ(stringOver({kDiffuse, kSpecular, kDiffuse}).layer(), PathClass::Indirect);
    EXPECT_EQ(stringOver({kSpecular}).open().layer(), PathClass::Indirect);
    EXPECT_NE(stringOver({kSpecular, kDiffuse, kSpecular, kDiffuse}), kSeenCausticOfCaustic);
    // Every string of one to five vertices is among the possible ones, and none of them twice.
    const auto possible = possibleStrings(kAllLobes);
    for (int i = 0; i < 243; ++i) {
        PathString p;
        for (int rest = i, n = 0; n < 5; ++n, rest /= 3) p.pass(static_cast<LobeKinds>(1 << (rest % 3)));
        const auto named = [&p](const PathString& s) { return s.code() == p.code(); };
        EXPECT_EQ(std::count_if(possible.begin(), possible.end(), named), 1) << p.name();
    }
    EXPECT_EQ(groupOf("EL"), "EL");
    EXPECT_EQ(groupOf("EDDS_L"), "ED..L");
    EXPECT_EQ(groupOf("ED_L"), "ED..L");
    EXPECT_EQ(groupOf("EDSL"), "EDSL");
    EXPECT_EQ(groupOf("ESDSL"), "ESDSL");
    EXPECT_EQ(groupOf("EGSD_L"), "EGSD..L");
}

/// A spot through a pane of glass on a floor, seen in a mirror: what light tracing shows a camera behind the mirror, with
/// the image turned over. No ordinary path sees this.
TEST(TexelIrradiance, CausticInAMirrorIsTheCausticSeenFromBehindIt) {
    const auto built = [](bool mirrored) {
        check::SceneBuilder b;
        b.quad({-1.5, 0, 1.5}, {3, 0, 0}, {0, 0, -3}, detail::coated(0.7F, 0.5F));
        b.box({-1, 1.0, -1}, {0.9, 1.15, 1}, detail::tinted(check::glass(1.5F), {0.5F, 1.0F, 2.0F}));
        detail::addSpot(b, {0.1, 1.6, 0.0}, {0.1, 0.0, 0.0}, 2.0F);
        if (mirrored) b.quad({1, -0.2, 1.2}, {0, 1.1, 0}, {0, 0, -2.4}, check::mirror(1.0F));
        const auto x = [mirrored](double v) { return mirrored ? 2.0 - v : v; };
        b.perspective({x(1.8), 0.6, 0.0}, {x(0.1), 0.0, 0.0}, 0.5);
        return b.description();
    };
    const Workers workers;
    const Scene direct(built(false), std::nullopt, SceneOptions{}, workers),
        mirrored(built(true), std::nullopt, SceneOptions{}, workers);
    Rendering light{Method::Light, 12, 6};
    light.width = light.height = 16;
    light.layers = {"classes"};
    Rendering reference = light.by(Method::Reference, 12, 60);
    const SeedValues expected = valuesOf(renderSeeds(direct, light, workers), 4, "class.EDSL");
    SeedValues measured = valuesOf(renderSeeds(mirrored, reference, workers), 4, "class.ESDSL");
    for (auto& seed : measured)
        for (std::size_t row = 0; row < 4; ++row)
            std::reverse(seed.begin() + static_cast<std::ptrdiff_t>(4 * row),
                         seed.begin() + static_cast<std::ptrdiff_t>(4 * row + 4));
    ASSERT_GT(imageOverSeeds(expected).mean, 0.0);
    for (std::size_t i = 0; i < expected.front().size(); ++i) {
        const MeanOfSeeds a = cellOverSeeds(expected, i), b = cellOverSeeds(measured, i);
        EXPECT_NEAR(a.mean, b.mean, 4.5 * std::sqrt(a.variance + b.variance) + 0.01 * imageOverSeeds(expected).mean)
            << "block " << i;
    }
    const MeanOfSeeds a = imageOverSeeds(expected), b = imageOverSeeds(measured);
    EXPECT_NEAR(b.mean / a.mean, 1.0, 4.5 * std::sqrt(a.variance + b.variance) / a.mean + 0.003);
}

/// With a lamp that path tracing meets, the reference's parts add up to the same classes.
TEST(TexelIrradiance, ReferenceMeansWhatPathTracingMeans) {
    const SmallScene small = smoothCasters();
    const Workers workers;
    const Scene scene = made(small, workers);
    Rendering path{Method::Path, 256, 6};
    path.width = path.height = 20;
    path.layers = {"classes"};
    Rendering reference = path.by(Method::Reference, 48, 300);
    for (const GroupDifference& d : compareGroups(
             renderSeeds(scene, path, workers), renderSeeds(scene, reference, workers),
             [](const std::string& group) { return group == "ESDSL" ? 0.02 : 0.0; }, 0.0))
        EXPECT_TRUE(d.holds()) << d.group << ": " << d.measured << " for " << d.expected << " +- " << d.error;
}

/// A white floor under a pane: what the pane lets through to it comes back from the pane's underside as well, and the eye sees
/// both through the pane. Without E S+ D S+ D S+ L the last group would lack most of its light.
TEST(TexelIrradiance, CausticsOfCausticsAreThereToo) {
    check::SceneBuilder b;
    b.quad({-1.5, 0, 1.5}, {3, 0, 0}, {0, 0, -3}, check::lambert(0.9F));
    b.box({-1.4, 0.3, -1.4}, {1.4, 0.4, 1.4}, check::glass(1.8F));
    b.square({0.0, 1.6, 0.0}, {0, -1, 0}, 0.5, check::lamp(8.0F));
    b.perspective({1.2, 1.5, 0.0}, {0.2, 0.0, 0.0}, 0.3);
    const Workers workers;
    const Scene scene(b.description(), std::nullopt, SceneOptions{}, workers);
    Rendering path{Method::Path, 400, 6};
    path.width = path.height = 16;
    path.layers = {"classes"};
    Rendering reference = path.by(Method::Reference, 64, 300);
    bool seen = false;
    for (const GroupDifference& d : compareGroups(
             renderSeeds(scene, path, workers), renderSeeds(scene, reference, workers),
             [](const std::string&) { return 0.01; }, 0.0)) {
        EXPECT_TRUE(d.holds()) << d.group << ": " << d.measured << " for " << d.expected << " +- " << d.error;
        if (d.group != "ESD..L") continue;
        seen = true;
        EXPECT_LT(d.error, 0.03 * d.expected) << "tells if it is missing";
    }
    EXPECT_TRUE(seen);
}

}  // namespace
}  // namespace pellucid

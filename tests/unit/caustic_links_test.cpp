/// "Why is there no caustic?" and photon.memory: the plan names lamp, caster and reason, and sizes its passes.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <pellucid/render/caustic_links.h>
#include <pellucid/render/render.h>
#include <pellucid/study/record_json.h>
#include <pellucid/transport/photon_trace.h>

#include "../../src/study/check_scenes.h"

namespace pellucid {
namespace {

[[nodiscard]] Material named(Material m, const std::string& name) {
    m.name = name;
    return m;
}

[[nodiscard]] RenderRequest small() {
    RenderRequest request;
    request.width = request.height = 24;
    request.budget.samples = 1;
    request.settings.gatherRays = 32;
    request.settings.globalPhotons = 2000;
    return request;
}

/// A glass ball and a rough metal ball over a floor, far apart; a lamp over them, one that looks away, a spot on the glass alone.
[[nodiscard]] SceneDescription twoBalls(bool floor = true) {
    check::SceneBuilder b;
    if (floor) b.quad({-2, 0, 1}, {4, 0, 0}, {0, 0, -2}, named(check::lambert(0.7F), "floor"));
    b.sphere({-0.8, 0.4, 0.0}, 0.25, 12, named(check::glass(1.5F), "ball"), true);
    b.sphere({0.9, 0.4, 0.0}, 0.2, 8, named(check::mirror(0.9F, 0.6F), "brushed"), true);
    b.square({0.0, 1.9, 0.0}, {0, -1, 0}, 0.2, named(check::lamp(9.0F), "lamp"));
    b.square({0.0, 2.0, 0.0}, {0, 1, 0}, 0.2, named(check::lamp(9.0F), "wrong way"));
    b.description().lights.push_back({"spot", PunctualKind::Spot, {-0.8, 1.8, 0.0}, {0, -1, 0}, Rgb(3.0F), 0.1, 0.2});
    b.description().lights.push_back({"black", PunctualKind::Spot, {0, 1, 0}, {0, -1, 0}, Rgb(0.0F), 0.1, 0.2});
    b.description().lights.push_back({"aside", PunctualKind::Spot, {1.6, 1.8, 0.0}, {0, -1, 0}, Rgb(3.0F), 0.1, 0.2});
    b.perspective({0.0, 1.2, 4.0}, {0, 0.3, 0}, 0.8);
    return b.description();
}

[[nodiscard]] CausticLink find(const std::vector<CausticLink>& links, const std::string& lamp,
                               const std::string& caster) {
    const auto it =
        std::ranges::find_if(links, [&](const CausticLink& l) { return l.lamp == lamp && l.caster == caster; });
    EXPECT_NE(it, links.end()) << lamp << " -> " << caster;
    return it == links.end() ? CausticLink{} : *it;
}

TEST(CausticLinks, EachPairHasItsCountsAndItsReason) {
    const Workers workers(2);
    const Scene scene(twoBalls(), std::nullopt, {}, workers);
    const RenderRecord plan = planOnly(scene, small(), workers);
    EXPECT_EQ(plan.causticLinks.size(), 8U);
    const CausticLink lamp = find(plan.causticLinks, "lamp", "ball"), spot = find(plan.causticLinks, "spot", "ball");
    for (const CausticLink& l : {lamp, spot}) {
        EXPECT_GT(l.useful, 0U);
        EXPECT_TRUE(l.watched);
        EXPECT_GT(l.used, 0U);
        EXPECT_GE(l.stored, l.used);
        EXPECT_GE(l.deposited, l.useful);
        EXPECT_GE(l.hit, l.deposited);
        EXPECT_GE(l.emitted, l.hit);
        EXPECT_EQ(l.reason, "");
    }
    EXPECT_TRUE(find(plan.causticLinks, "lamp", "brushed")
                    .reason.starts_with("too rough to cast: 0.6 is above surface.cast_roughness 0.3"));
    EXPECT_GT(find(plan.causticLinks, "lamp", "brushed").hit, 0U);
    EXPECT_EQ(find(plan.causticLinks, "wrong way", "ball").reason, "behind the lamp: it shines the other way");
    EXPECT_EQ(find(plan.causticLinks, "aside", "ball").reason, "outside of the spot's cone");
}

TEST(CausticLinks, NoReceiverAndNoView) {
    const Workers workers(2);
    const Scene bare(twoBalls(false), std::nullopt, {}, workers);
    EXPECT_TRUE(find(planOnly(bare, small(), workers).causticLinks, "lamp", "ball").reason.starts_with("no receiver"));
    // The camera stands in a closed box: something diffuse is in view, but no photon gets there.
    check::SceneBuilder b;
    b.description() = twoBalls();
    b.description().cameras.clear();
    b.box({-2, -1, 10}, {2, 3, 16}, named(check::lambert(0.5F), "box"));
    b.perspective({0.0, 1.0, 12.0}, {0, 1.0, 16}, 0.1);
    const Scene away(b.description(), std::nullopt, {}, workers);
    const CausticLink link = find(planOnly(away, small(), workers).causticLinks, "spot", "ball");
    EXPECT_GT(link.deposited, 0U);
    EXPECT_EQ(link.useful, 0U);
    EXPECT_TRUE(link.reason.starts_with("no receiver in view")) << link.reason;
}

TEST(CausticLinks, CountsAreThoseOfThePassAtAnyNumberOfThreads) {
    const Workers one(1), three(3);
    const Scene scene(twoBalls(), std::nullopt, {}, one);
    const EmissionGuide guide(scene.lights(), {});
    const PhotonPassKey key{5, 1, 20000};
    CasterTally a(scene), b(scene);
    const CausticPass pass = traceCausticPhotons(scene, guide, key, nullptr, one, &a);
    const CausticPass same = traceCausticPhotons(scene, guide, key, nullptr, three, &b);
    const CausticPass uncounted = traceCausticPhotons(scene, guide, key, nullptr, three);
    EXPECT_EQ(pass.photons.size(), uncounted.photons.size());
    EXPECT_EQ(pass.rays, same.rays);
    std::uint64_t emitted = 0, deposited = 0;
    for (std::size_t l = 0; l < a.lamps().size(); ++l) {
        emitted += a.emitted(l);
        EXPECT_EQ(a.emitted(l), b.emitted(l));
        EXPECT_EQ(a.missed(l), b.missed(l));
        for (std::size_t c = 0; c < a.casters().size(); ++c) {
            const CasterFate f = a.fate(l, c), g = b.fate(l, c);
            EXPECT_EQ(f.hit, g.hit);
            EXPECT_EQ(f.useful, g.useful);
            EXPECT_EQ(f.useful, f.deposited);  // everything is in view
            EXPECT_LE(f.deposited + f.escaped, f.hit);
            deposited += f.deposited;
        }
    }
    EXPECT_EQ(emitted, key.paths);
    // One smooth caster: its paths are the useful ones, each counted once.
    EXPECT_EQ(deposited, pass.useful.size());
}

/// A narrow look at the floor beside the ball: most photons are kept, being near, and few lie within a kernel.
TEST(CausticLinks, UsedAreThoseThatKernelsSummedAtAnyNumberOfThreads) {
    const Workers one(1), three(3);
    const Scene scene(twoBalls(), std::nullopt, {}, one);
    RenderRequest request = small();
    request.settings.causticRadius = 0.4;
    const RenderRecord narrow = planOnly(scene, request, one), same = planOnly(scene, request, three);
    request.settings.causticRadius = 12.0;
    const RenderRecord wide = planOnly(scene, request, one);
    const CausticLink n = find(narrow.causticLinks, "lamp", "ball"), s = find(same.causticLinks, "lamp", "ball"),
                      w = find(wide.causticLinks, "lamp", "ball");
    EXPECT_EQ(n.stored, s.stored);
    EXPECT_EQ(n.used, s.used);
    EXPECT_LT(n.used, w.used);
    EXPECT_GT(static_cast<double>(w.used), 0.9 * static_cast<double>(w.stored));
    EXPECT_EQ(find(narrow.causticLinks, "wrong way", "ball").stored, 0U);
}

TEST(CausticLinks, TextAndJsonSumTheRest) {
    RenderRecord record;
    for (std::uint64_t i = 0; i < 300; ++i)
        record.causticLinks.push_back({"lamp " + std::to_string(i), "ball", i, 0, 10, 3, 2, 1, true, 7, 5, ""});
    const RecordContext context;
    const auto json = nlohmann::json::parse(planJson(record, context)).at("caustics");
    EXPECT_EQ(json.size(), 256U);
    EXPECT_EQ(json.back().at("lamp"), "45 more pairs");
    EXPECT_EQ(json.back().at("hit"), 45 * 3);
    EXPECT_EQ(json.back().at("used"), 45 * 5);
    const std::string text = planText(record, context);
    EXPECT_NE(text.find("289 more pairs"), std::string::npos);
    EXPECT_EQ(text.find("lamp 11 "), std::string::npos);
}

TEST(PhotonLayers, PhotonsStandWhereKernelsMeetThem) {
    const Workers workers(2);
    const Scene scene(twoBalls(), std::nullopt, {}, workers);
    RenderRequest request = small();
    request.layers = {"photons", "radius", "density"};
    const Image image = render(scene, request, workers).image;
    const int photons = image.channel("photons.Y"), radius = image.channel("radius.Y"),
              density = image.channel("density.Y"), caustic = image.channel("caustic.G");
    double most = 0.0;
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        most = std::max(most, static_cast<double>(image.at(i, photons)));
        if (image.at(i, radius) == 0.0F) {
            EXPECT_EQ(image.at(i, photons), 0.0F) << i;
            EXPECT_EQ(image.at(i, density), 0.0F) << i;
            continue;
        }
        EXPECT_EQ(image.at(i, photons) > 0.0F, image.at(i, caustic) > 0.0F) << i;
    }
    EXPECT_GT(most, 10.0);
}

TEST(PhotonMemory, SizesThePassesAndSaysSo) {
    const Workers workers(2);
    const Scene scene(twoBalls(), std::nullopt, {}, workers);
    RenderRequest request = small();
    request.settings.causticPhotons = 100'000'000;
    request.settings.globalPhotons = 100'000'000;
    request.settings.photonMemory = 12.0;
    const RenderRecord record = render(scene, request, workers).record;
    for (const std::string pass : {"caustic photons", "global photons"}) {
        const bool told = std::ranges::any_of(record.decisions, [&](const Decision& d) {
            return d.name == pass && d.choice == "fewer" &&
                   d.reason.find("100000000 paths wanted") != std::string::npos;
        });
        EXPECT_TRUE(told) << pass;
        const auto stage = std::ranges::find(record.stages, pass, &StageRecord::name);
        ASSERT_NE(stage, record.stages.end());
        EXPECT_GT(stage->photonsStored, 1000U) << pass;
        // What a photon takes at the peak of its pass, as measured.
        const double bytes = pass == "caustic photons" ? 300.0 : 110.0;
        EXPECT_LT(static_cast<double>(stage->photonsStored / stage->photonPasses) * bytes, 12e6) << pass;
    }
    request.settings.photonMemory = -1.0;
    request.settings.causticPhotons = request.settings.globalPhotons = 3000;
    for (const Decision& d : planOnly(scene, request, workers).decisions) EXPECT_NE(d.choice, "fewer");
}

/// What holds nothing to do ends, and says why: a lamp that hits nothing, a scene without receivers, one photon.
TEST(PhotonExtremes, EndWithAWord) {
    const Workers workers(2);
    const auto reasonOf = [](const RenderRecord& record, const std::string& decision) {
        const auto d = std::ranges::find(record.decisions, decision, &Decision::name);
        return d == record.decisions.end() ? std::string() : d->choice + ": " + d->reason;
    };
    for (const Method method : {Method::Photon, Method::Sppm}) {
        RenderRequest request = small();
        request.method = method;
        check::SceneBuilder away;  // its lamp shines into the void
        away.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, named(check::lambert(0.7F), "floor"));
        away.sphere({0, 0.4, 0}, 0.25, 8, named(check::glass(1.5F), "ball"), true);
        away.square({0.0, 1.9, 0.0}, {0, 1, 0}, 0.2, named(check::lamp(9.0F), "lamp"));
        away.perspective({0.0, 1.2, 3.0}, {0, 0.3, 0}, 0.8);
        const Scene dark(away.description(), std::nullopt, {}, workers);
        const RenderRecord nothing = render(dark, request, workers).record;
        EXPECT_EQ(find(nothing.causticLinks, "lamp", "ball").reason, "behind the lamp: it shines the other way");
        if (method == Method::Photon) {
            EXPECT_NE(reasonOf(nothing, "caustic map").find("off: 0 of "), std::string::npos)
                << reasonOf(nothing, "caustic map");
        }
        const Scene bare(twoBalls(false), std::nullopt, {}, workers);
        const RenderRecord blind = render(bare, request, workers).record;
        EXPECT_EQ(reasonOf(blind, "caustic map"), "off: the camera sees no diffuse surface");
        const Scene balls(twoBalls(), std::nullopt, {}, workers);
        request.settings.causticPhotons = request.settings.globalPhotons = 1;
        const RenderRecord one = render(balls, request, workers).record;
        EXPECT_TRUE(reasonOf(one, "caustic photons").starts_with("1 paths an iteration"));
        EXPECT_EQ(one.nonfinite.count, 0U);
    }
}

/// Rough metal under a small lamp is what next-event estimation shows best; behind glass, under a large lamp, or when it is asked
/// for, photons are. The choice changes who carries the light, not how much there is.
TEST(CausticChoice, RoughMetalUnderASmallLampIsLeftToEyePaths) {
    const Workers workers(2);
    const auto choiceOf = [&](const Material& caster, double lamp, const std::string& asked) {
        check::SceneBuilder b;
        b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, check::lambert(0.7F));
        b.quad({0.7, 0, 0.8}, {0, 0, -1.6}, {0, 1.0, 0}, named(caster, "caster"));
        b.square({0.0, 1.5, 0.0}, {0.3, -1, 0}, lamp, named(check::lamp(9.0F), "lamp"));
        b.perspective({0.0, 1.2, 3.0}, {0, 0.3, 0}, 0.8);
        const Scene scene(b.description(), std::nullopt, {}, workers);
        RenderRequest request = small();
        setParameter(request.settings, "photon.caustic_map", asked);
        const RenderRecord plan = planOnly(scene, request, workers);
        const auto d = std::ranges::find(plan.decisions, "caustic map", &Decision::name);
        if (d == plan.decisions.end()) return std::string();
        if (d->choice == "off") {
            EXPECT_EQ(find(plan.causticLinks, "lamp", "caster").reason,
                      "no photons: eye paths carry it, as the caustic map is off");
            EXPECT_TRUE(plan.blindSpots.empty());
        }
        return d->choice;
    };
    EXPECT_EQ(choiceOf(check::mirror(0.9F, 0.28F), 0.1, "auto"), "off");
    EXPECT_EQ(choiceOf(check::mirror(0.9F, 0.28F), 0.1, "on"), "on");
    EXPECT_EQ(choiceOf(check::mirror(0.9F, 0.28F), 0.7, "auto"), "on");
    EXPECT_EQ(choiceOf(check::mirror(0.9F, 0.1F), 0.1, "auto"), "on");
    EXPECT_EQ(choiceOf(check::glass(1.5F, 0.0F, 0.28F), 0.1, "auto"), "on");
}

}  // namespace
}  // namespace pellucid

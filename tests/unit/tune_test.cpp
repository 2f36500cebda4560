// The tuner's parts: what it may search, its windows, its model, its reference, and the limits that its trials end by.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/base/error.h>
#include <pellucid/math/hash.h>
#include <pellucid/study/tune.h>

#include "../../src/study/tune_front.h"
#include "../../src/study/tune_model.h"
#include "../../src/study/tune_reference.h"
#include "../../src/study/tune_space.h"
#include "../../src/study/tune_windows.h"

namespace pellucid {
namespace {

[[nodiscard]] std::string messageOf(const std::string& over) {
    try {
        static_cast<void>(parseOver(over));
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Usage);
        return error.what();
    }
    return "";
}

TEST(TuneOver, ReadsRangesWordsAndDeclaredRanges) {
    const std::vector<TuneOver> over = parseOver("cache.error=0.05..0.5,photon.guiding=on|off,cache.rays");
    ASSERT_EQ(over.size(), 3U);
    EXPECT_EQ(over[0].low, 0.05);
    EXPECT_EQ(over[0].high, 0.5);
    EXPECT_EQ(over[1].words, (std::vector<std::string>{"on", "off"}));
    EXPECT_EQ(over[2].high, 0.0);
}

TEST(TuneOver, ErrorsNameWhatIsWrong) {
    EXPECT_NE(messageOf("cache.eror=0.1..0.2").find("'cache.error'"), std::string::npos);
    EXPECT_NE(messageOf("cache.error=0.2..0.1").find("below"), std::string::npos);
    EXPECT_NE(messageOf("cache.error=0.1").find("LOW..HIGH"), std::string::npos);
    EXPECT_NE(messageOf("cache.error=0..1").find("0.001"), std::string::npos);
    EXPECT_NE(messageOf("cache.error,cache.error").find("once"), std::string::npos);
    EXPECT_NE(messageOf("photon.guiding").find("words"), std::string::npos);
    EXPECT_NE(messageOf("photon.guiding=on|maybe").find("maybe"), std::string::npos);
    EXPECT_NE(messageOf("path.roulette").find("no declared range"), std::string::npos);
    EXPECT_NE(messageOf("camera.focus=1..2").find("--set"), std::string::npos);
}

TEST(TuneOver, Goals) {
    EXPECT_EQ(parseGoal("error=0.02").kind, TuneGoal::Kind::Error);
    EXPECT_EQ(parseGoal("time=30").value, 30.0);
    for (const char* wrong : {"", "0.02", "error", "error=", "error=0", "error=-1", "noise=0.1", "time=1s"})
        EXPECT_THROW(static_cast<void>(parseGoal(wrong)), Error) << wrong;
}

/// A plan with every pass, or without caustics.
[[nodiscard]] RenderRecord planOf(bool caustics) {
    RenderRecord plan;
    plan.resolved.causticMap = caustics ? "on" : "off";
    plan.resolved.cache = "on";
    plan.resolved.causticPhotons = caustics ? 100'000 : 0;
    plan.resolved.globalPhotons = 150'000;
    plan.resolved.causticRadius = 2.5;
    plan.resolved.cacheError = 0.25;
    plan.resolved.gatherRays = 512;
    plan.resolved.minSpacing = 3.0;
    plan.resolved.maxSpacing = 40.0;
    return plan;
}

TEST(TuneSpace, SearchesOnlyWhatThePlanUses) {
    const SearchSpace all({}, Settings{}, planOf(true), false), noCaustics({}, Settings{}, planOf(false), false);
    EXPECT_GT(all.size(), noCaustics.size());
    for (const Dimension& d : noCaustics.dimensions()) EXPECT_NE(d.row->pass, ParameterPass::CausticMap) << d.row->name;
    Settings fixed;
    fixed.gatherRays = 100;
    const SearchSpace withFixed({}, fixed, planOf(true), false);
    for (const Dimension& d : withFixed.dimensions()) EXPECT_NE(d.row->name, "cache.rays");
    RenderRecord nothing = planOf(false);
    nothing.resolved.cache = "off";
    EXPECT_THROW(SearchSpace({}, Settings{}, nothing, false), Error);
}

TEST(TuneSpace, ValuesAndCoordinatesAreInverse) {
    const SearchSpace space(parseOver("cache.error=0.05..0.8,cache.rays,photon.alpha,photon.guiding=on|off"),
                            Settings{}, planOf(true), false);
    ASSERT_EQ(space.size(), 4U);
    for (const Dimension& d : space.dimensions())
        for (const double x : {0.0, 0.3, 0.77, 1.0}) {
            const std::string value = d.valueAt(x);
            EXPECT_EQ(d.valueAt(d.positionOf(value)), value) << d.row->name;
            Settings settings;
            EXPECT_NO_THROW(setParameter(settings, d.row->name, value)) << d.row->name << "=" << value;
        }
    // Logarithmic: the middle of 0.05 .. 0.8 is 0.2.
    EXPECT_EQ(space.dimensions()[2].row->name, "cache.error");
    EXPECT_EQ(space.dimensions()[2].valueAt(0.5), "0.2");
    const Candidate candidate = space.at({0.1, 0.5, 0.5, 0.9}, "test");
    EXPECT_TRUE(space.contains(candidate));
    EXPECT_FALSE(space.contains({"", {{"photon.radius", "3"}}}));
}

TEST(TuneSpace, HalfOfWhatThePlanCanChooseIsLeftToIt) {
    RenderRecord plan = planOf(true);
    plan.resolved.causticRadius = -1.0;  // pixel by pixel: no number
    const SearchSpace space(parseOver("photon.radius=1..4,photon.alpha=0.5..1"), Settings{}, plan, false);
    EXPECT_FALSE(space.dimensions()[0].hasStandard());
    EXPECT_EQ(space.at({0.2, 0.0}, "").set, (SettingList{{"photon.alpha", "0.5"}}));
    EXPECT_EQ(space.at({0.75, 1.0}, "").set, (SettingList{{"photon.radius", "2"}, {"photon.alpha", "1"}}));
    EXPECT_EQ(space.positions({"", {{"photon.radius", "2"}}})[0], 0.5);
    EXPECT_EQ(space.positions({"", {}})[0], 0.5);
}

TEST(TuneSpace, PeersSettingsAreValidAndDropWhatIsLeftOut) {
    for (const bool caustics : {true, false})
        for (const Candidate& peer : peersSettings(planOf(caustics), 65536)) {
            EXPECT_NO_THROW(static_cast<void>(withSettings(Settings{}, peer.set))) << peer.origin;
            EXPECT_FALSE(peer.set.empty());
            SettingList sorted = peer.set;
            inTableOrder(sorted);
            EXPECT_EQ(sorted, peer.set) << peer.origin;
            for (const auto& [name, value] : peer.set) EXPECT_TRUE(caustics || name != "photon.caustic");
        }
}

TEST(TuneWindows, AreSpreadAndDisjoint) {
    for (const auto& [width, height] : {std::pair{512, 512}, std::pair{640, 360}, std::pair{256, 192}}) {
        const std::vector<PixelWindow> windows = stratifiedWindows(width, height, 1);
        ASSERT_FALSE(windows.empty());
        std::vector<int> covered(static_cast<std::size_t>(width * height), 0);
        for (const PixelWindow& w : windows) {
            EXPECT_GE(w.x0, 0);
            EXPECT_LE(w.x1, width);
            EXPECT_GE(w.y0, 0);
            EXPECT_LE(w.y1, height);
            for (int y = w.y0; y < w.y1; ++y)
                for (int x = w.x0; x < w.x1; ++x) ++covered[static_cast<std::size_t>(y * width + x)];
        }
        int pixels = 0;
        for (const int c : covered) {
            EXPECT_LE(c, 1);
            pixels += c;
        }
        EXPECT_NEAR(pixels, width * height / 7.0, 0.04 * width * height);
    }
    EXPECT_TRUE(stratifiedWindows(64, 48, 1).empty());
    EXPECT_NE(stratifiedWindows(512, 512, 1)[0].x0, stratifiedWindows(512, 512, 2)[0].x0);
}

/// Uniform in [-1, 1), keyed.
[[nodiscard]] double noise(std::uint64_t key) { return static_cast<double>(hash64(key) >> 11U) * 0x1p-52 - 1.0; }

TEST(TuneModel, FindsTheLeastOfASumOfParabolas) {
    std::vector<Observation> observations;
    for (std::uint64_t i = 0; i < 60; ++i) {
        Observation o;
        for (std::uint64_t d = 0; d < 3; ++d) o.coordinates.push_back(0.5 + 0.5 * noise(3 * i + d));
        const double a = o.coordinates[0] - 0.3, b = o.coordinates[1] - 0.8;
        o.score = 3.0 * a * a + 2.0 * b * b + 0.5 * o.coordinates[2] + 0.05 * noise(1000 + i);
        observations.push_back(o);
    }
    const AdditiveModel model(observations, 3);
    ASSERT_TRUE(model.valid());
    const std::vector<double> best = model.best();
    EXPECT_NEAR(best[0], 0.3, 0.07);
    EXPECT_NEAR(best[1], 0.8, 0.07);
    EXPECT_EQ(best[2], 0.0);
    EXPECT_NEAR(model.part(0, 0.9) - model.part(0, 0.3), 3.0 * 0.36, 0.2);
    EXPECT_FALSE(AdditiveModel(std::vector<Observation>(3, observations[0]), 3).valid());
}

/// A constant picture with keyed noise of the given amplitude.
[[nodiscard]] Image picture(double value, double amplitude, std::uint64_t key) {
    Image image(128, 128, {"R", "G", "B"});
    for (std::size_t i = 0; i < image.data().size(); ++i)
        image.data()[i] = static_cast<float>(value + amplitude * noise(hashCombine(key, i)));
    return image;
}

TEST(TuneReference, NoiseOfTheReferenceDropsOut) {
    // Both halves are noisier than the image: uniform noise of amplitude a has the variance a^2/3.
    TuneReference reference;
    reference.first = picture(1.0, 0.3, 1);
    reference.second = picture(1.0, 0.3, 2);
    reference.mean = Image(128, 128, {"R", "G", "B"});
    for (std::size_t i = 0; i < reference.mean.data().size(); ++i)
        reference.mean.data()[i] = 0.5F * (reference.first.data()[i] + reference.second.data()[i]);
    reference.weigh();
    const double truth = 0.1 * 0.1 / 3.0 + 0.02 * 0.02, measured = reference.relmseTrimmed(picture(1.02, 0.1, 3), {});
    EXPECT_NEAR(measured, truth, 0.1 * truth);
    // A glint that one render in a thousand meets decides nothing.
    Image glint = picture(1.02, 0.1, 3);
    glint.at(5, 0) = glint.at(5, 1) = glint.at(5, 2) = 1000.0F;
    EXPECT_NEAR(reference.relmseTrimmed(glint, {}), measured, 0.02 * truth);
    // With one image for both halves the reference's own noise, 0.015, would stand in it: the test can tell.
    TuneReference naive;
    naive.mean = reference.mean;
    naive.weigh();
    EXPECT_GT(naive.relmseTrimmed(picture(1.02, 0.1, 3), {}), 3.0 * truth);
}

/// A finalist with the given errors at 1, 2, 4 seconds, the same for each of three seeds.
[[nodiscard]] Finalist finalistOf(const std::string& name, const std::vector<double>& errors) {
    Finalist f;
    f.name = name;
    double time = 1.0;
    for (const double e : errors) {
        FrontPoint p;
        p.time = time;
        p.relmse = {e * e, e * e * 1.01, e * e * 0.99};
        p.cost = {time, time, time};
        p.error.value = e;
        p.seconds.value = time;
        f.points.push_back(p);
        time *= 2.0;
    }
    return f;
}

TEST(TuneChoice, PicksThePointThatIsAskedFor) {
    Front front;
    front.finalists = {finalistOf("default", {0.08, 0.06, 0.04}), finalistOf("tuned", {0.09, 0.05, 0.025}),
                       finalistOf("quick", {0.05, 0.045, 0.035}), finalistOf("worse", {0.2, 0.1, 0.08})};
    EXPECT_EQ(choose(front, {TuneGoal::Kind::Time, 4.0}).finalist, 1U);
    EXPECT_EQ(choose(front, {TuneGoal::Kind::Time, 1.0}).finalist, 2U);
    const Choice byError = choose(front, {TuneGoal::Kind::Error, 0.03});
    EXPECT_EQ(byError.finalist, 1U);
    EXPECT_TRUE(byError.reached);
    EXPECT_GT(byError.seconds, 2.0);
    EXPECT_LT(byError.seconds, 4.0);
    const Choice never = choose(front, {TuneGoal::Kind::Error, 0.001});
    EXPECT_FALSE(never.reached);
    EXPECT_EQ(never.finalist, 1U);
    // What is not surely better than the default does not replace it.
    front.finalists = {finalistOf("default", {0.08, 0.06, 0.04}), finalistOf("tuned", {0.08, 0.06, 0.0399})};
    EXPECT_EQ(choose(front, {TuneGoal::Kind::Time, 4.0}).finalist, 0U);
}

/// A rare bright pixel in one seed of the default would else make a winner of any that did not render that seed.
TEST(TuneChoice, WhatMissesSeedsDoesNotWin) {
    Front front;
    front.finalists = {finalistOf("default", {0.08, 0.06, 0.04}), finalistOf("Mitsuba 0.6", {0.07, 0.05, 0.02})};
    FrontPoint& last = front.finalists[1].points.back();
    EXPECT_EQ(choose(front, {TuneGoal::Kind::Time, 4.0}).finalist, 1U);
    last.relmse.pop_back();
    last.cost.pop_back();
    EXPECT_EQ(choose(front, {TuneGoal::Kind::Time, 4.0}).finalist, 0U);
}

}  // namespace
}  // namespace pellucid

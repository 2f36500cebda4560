// What must not go unnoticed: samples that are no number, energy that is lost, a sample that cannot be taken again, a
// comparison with the wrong exit status.
#include <cmath>
#include <csignal>
#include <filesystem>
#include <limits>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <pellucid/base/error.h>
#include <pellucid/base/parallel.h>
#include <pellucid/io/gltf.h>
#include <pellucid/render/film.h>
#include <pellucid/render/render.h>
#include <pellucid/scene/scene.h>
#include <pellucid/study/stiffness.h>

#include "../support/command.h"

namespace pellucid {
namespace {

[[nodiscard]] std::string ringFile() { return PELLUCID_SOURCE_DIR "/scenes/ring.glb"; }

[[nodiscard]] RenderRequest smallRequest(Method method, std::uint32_t samples) {
    RenderRequest request;
    request.method = method;
    request.width = 12;
    request.height = 9;
    request.seed = 3;
    request.budget.samples = samples;
    request.settings.gatherRays = 64;
    request.settings.globalPhotons = 5000;
    return request;
}

TEST(NoSilentTrouble, NonFiniteSamplesAreCountedWithPixelAndSample) {
    Film film(4, 3);
    LayeredRadiance good, bad;
    good[PathClass::Direct] = Rgb(1.0F);
    bad[PathClass::Caustic] = Rgb(0.0F, std::numeric_limits<float>::quiet_NaN(), 0.0F);
    for (std::uint32_t s = 0; s < 5; ++s) {
        for (std::size_t p = 0; p < film.pixels(); ++p)
            film.add(p, s, (p == 6 && s >= 2) || (p == 9 && s == 1) ? bad : good, FirstHit{});
        film.countSamples(1);
    }
    const NonFinite found = film.nonfinite();
    EXPECT_EQ(found.count, 4U);
    EXPECT_EQ(found.x, 2);
    EXPECT_EQ(found.y, 1);
    EXPECT_EQ(found.sample, 2U);
    const Image image = film.image({});
    for (const float value : image.data()) EXPECT_TRUE(std::isfinite(value));
}

/// The mean of the samples, taken one by one, is the render's pixel.
TEST(NoSilentTrouble, ReplayedSamplesAreThoseOfTheRender) {
    const Workers workers(2);
    const Scene scene(loadGltf(ringFile(), {}), std::nullopt, SceneOptions{}, workers);
    constexpr std::uint32_t kSamples = 3;
    for (const Method method : {Method::Path, Method::Photon}) {
        const RenderRequest request = smallRequest(method, kSamples);
        const Image image = render(scene, request, workers).image;
        for (const auto& [x, y] : {std::pair(5, 5), std::pair(7, 4), std::pair(0, 8)}) {
            double mean = 0.0;
            for (std::uint32_t s = 0; s < kSamples; ++s) {
                const SampleReplay replay = replaySample(scene, request, x, y, s, workers);
                mean += static_cast<double>(replay.radiance.total().g) / kSamples;
                EXPECT_EQ(replay.width, 12);
                ASSERT_FALSE(replay.vertices.empty());
                EXPECT_EQ(replay.vertices.front().throughput, Rgb(1.0F));
            }
            const auto pixel = static_cast<std::size_t>(y * 12 + x);
            EXPECT_NEAR(mean, static_cast<double>(image.at(pixel, image.channel("G"))), 1e-5 * (mean + 1e-6))
                << x << "," << y;
        }
    }
    const SampleReplay both = replaySample(scene, smallRequest(Method::Bdpt, 1), 5, 5, 0, workers);
    EXPECT_FALSE(both.vertices.empty());
    EXPECT_TRUE(isFinite(both.radiance.total()));
    EXPECT_THROW(static_cast<void>(replaySample(scene, smallRequest(Method::Path, 1), 12, 0, 0, workers)), Error);
    EXPECT_THROW(static_cast<void>(replaySample(scene, smallRequest(Method::Light, 1), 0, 0, 0, workers)), Error);
}

TEST(NoSilentTrouble, EnergyOfEachPhotonPassIsAccountedFor) {
    const Workers workers(2);
    const Scene scene(loadGltf(ringFile(), {}), std::nullopt, SceneOptions{}, workers);
    int passes = 0;
    for (const Method method : {Method::Photon, Method::Reference})
        for (const StageRecord& stage : render(scene, smallRequest(method, 2), workers).record.stages) {
            if (stage.photonPasses == 0) continue;
            ++passes;
            EXPECT_GT(stage.energy.emitted, 0.0);
            EXPECT_LT(std::fabs(stage.energy.residual()), 1e-9) << stage.name;
            EXPECT_GE(stage.energy.escaped, 0.0);
            EXPECT_GE(stage.energy.stored, 0.0);
        }
    EXPECT_GE(passes, 2);
}

TEST(NoSilentTrouble, BreakdownsAreFoundWhereTheyAre) {
    Sweep sweep;
    for (const auto& [value, path, photon] :
         {std::tuple(1.0, 0.01, 0.2), std::tuple(0.1, 0.02, 0.2), std::tuple(0.01, 0.4, 0.2)}) {
        SweepStep step;
        step.value = value;
        step.by[0].error = path;
        step.by[1].error = photon;
        sweep.steps.push_back(step);
    }
    EXPECT_EQ(breakdown(sweep, 0), 2U);
    EXPECT_FALSE(breakdown(sweep, 1));  // short of samples all over, but not broken down
    const std::string svg = sweepsSvg({sweep});
    EXPECT_EQ(svg.substr(0, 4), "<svg");
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_NE(sweepsMarkdown({sweep}, "s.svg").find("path breaks down at 0.01"), std::string::npos);
}

/// A black picture is as far off at the first step as at the last: no breakdown by the error, but it must be told.
TEST(NoSilentTrouble, SweepsTellOfNoiseBlindnessAndBias) {
    Sweep sweep;
    for (const auto& [value, path, photon] :
         {std::tuple(1.0, SweepFigures{3.2, 0.02, 0.5}, SweepFigures{0.05, 0.01, 0.02}),
          std::tuple(0.1, SweepFigures{1.0, -1.0, 0.0}, SweepFigures{0.06, -0.1, 0.06}),
          std::tuple(0.01, SweepFigures{1.0, -1.0, 0.0}, SweepFigures{0.11, -0.1, 0.04})})
        sweep.steps.push_back({value, {path, photon}});
    EXPECT_FALSE(breakdown(sweep, 0));
    EXPECT_EQ(blindness(sweep, 0), 1U);
    EXPECT_FALSE(certainBias(sweep, 0));
    EXPECT_FALSE(blindness(sweep, 1));
    EXPECT_EQ(certainBias(sweep, 1), 2U);
    EXPECT_EQ(sweepVerdict(sweep, 0),
              "path is short of samples from the first step on, with an error of 320 %; it finds no light at all from "
              "0.1 on.");
    EXPECT_NE(sweepVerdict(sweep, 1).find("is biased at 0.01"), std::string::npos);
    sweep.steps.resize(1);
    EXPECT_EQ(sweepVerdict(sweep, 1), "photon holds over the whole sweep.");
}

class Command : public test::CommandTest {
protected:
    [[nodiscard]] int run(const std::string& arguments) const { return runCommand(arguments).status; }
    [[nodiscard]] std::string read(const char* name) const { return test::bytesOf(folder_ / name); }
};

TEST_F(Command, DebugSamplePrintsThePath) {
    EXPECT_EQ(run("render '" + ringFile() + "' --size 12x9 --method path --debug-sample 5,5,2"), 0) << read("stderr");
    const std::string text = read("stdout");
    EXPECT_EQ(text.find("pixel 5,5 of 12x9, sample 2, seed 0, method path"), 0U);
    for (const char* word : {"  1  at ", "material", "throughput 1 1 1", "direct", "radiance"})
        EXPECT_NE(text.find(word), std::string::npos) << word;
    EXPECT_EQ(run("render '" + ringFile() + "' --size 12x9 --debug-sample 12,0,0"), 1);
    EXPECT_EQ(run("render '" + ringFile() + "' --debug-sample 1,2"), 1);
    EXPECT_EQ(run("render '" + ringFile() + "'"), 1);
    EXPECT_NE(read("stderr").find("-o"), std::string::npos);
}

TEST_F(Command, RecordHoldsTheEnergyOfEachPass) {
    const std::string record = (folder_ / "record.json").string();
    ASSERT_EQ(run("render '" + ringFile() + "' -o '" + (folder_ / "a.exr").string() +
                  "' --size 12x9 --spp 2 --record '" + record + "'"),
              0)
        << read("stderr");
    const nlohmann::json json = nlohmann::json::parse(read("record.json"));
    int accounts = 0;
    for (const auto& stage : json.at("stages")) {
        if (!stage.contains("energy")) continue;
        ++accounts;
        const auto& e = stage.at("energy");
        double sum = 0.0;
        for (const char* sink : {"escaped", "absorbed", "stored", "left_to_others", "roulette", "dropped"})
            sum += e.at(sink).get<double>();
        EXPECT_NEAR(sum, e.at("emitted").get<double>(), 1e-6 * sum);
    }
    EXPECT_GE(accounts, 1);
}

/// A signal while there is nothing to save: status 130, at once.
TEST_F(Command, SignalsEndWithStatus130) {
    for (const int signal : {SIGINT, SIGTERM}) {
        int ends[2];
        ASSERT_EQ(pipe(ends), 0);
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            dup2(ends[1], STDERR_FILENO);
            close(ends[0]);
            close(ends[1]);
            execl(PELLUCID_BINARY, PELLUCID_BINARY, "check", "--filter", "closed-form", static_cast<char*>(nullptr));
            _exit(99);
        }
        close(ends[1]);
        char first = 0;
        EXPECT_EQ(::read(ends[0], &first, 1), 1);  // it runs: the first case is told
        kill(child, signal);
        int status = 0;
        ASSERT_EQ(waitpid(child, &status, 0), child);
        close(ends[0]);
        ASSERT_TRUE(WIFEXITED(status));
        EXPECT_EQ(WEXITSTATUS(status), 130);
    }
}

#if defined(PELLUCID_FP_TRAPS) && defined(__x86_64__)
TEST(FloatingPointTraps, TheBirthOfANanEndsTheProgram) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_DEATH(
        {
            const Workers workers(1);
            volatile float zero = 0.0F, result = 0.0F;
            workers.forEach(1, 1, [&](std::size_t) { result = zero / zero; });
        },
        "");
}
#endif

}  // namespace
}  // namespace pellucid

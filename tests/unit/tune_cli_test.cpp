// `pellucid tune` as a user runs it: wrong use, the files, the same front again, interruption, and the warning of
// render.
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "../support/command.h"

namespace pellucid {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

[[nodiscard]] std::string read(const fs::path& file) { return test::bytesOf(file); }

class TuneCli : public test::CommandTest {
protected:
    [[nodiscard]] int run(const std::string& arguments, const std::string& before = "") const {
        return runCommand(arguments, before).status;
    }
    [[nodiscard]] static std::string scene(const std::string& name = "diffuse-room") {
        return "'" PELLUCID_SOURCE_DIR "/scenes/" + name + ".glb'";
    }
    /// Rounds instead of seconds: what is tested does not depend on the machine.
    [[nodiscard]] std::string command(const std::string& name, const std::string& more = "") const {
        return "tune " + scene() + " -o '" + (folder_ / name).string() +
               "' --time 0.01 --iterations 1 --size 24x18 --set photon.global=1000 --set cache.rays=16 "
               "--over cache.error=0.3..1,cache.max_spacing=5..40 " +
               more;
    }
};

TEST_F(TuneCli, WrongUse) {
    const std::string out = " -o '" + folder_.path().string() + "'";
    EXPECT_EQ(run("tune " + scene() + out + " --budget 10"), 1);
    EXPECT_EQ(run("tune " + scene() + out + " --time 1"), 1);
    EXPECT_NE(read(folder_ / "stderr").find("--budget"), std::string::npos);
    EXPECT_EQ(run("tune " + scene() + out + " --time 1 --budget 10 --iterations 2"), 1);
    EXPECT_EQ(run("tune " + scene() + out + " --time 0 --budget 10"), 1);
    EXPECT_EQ(run("tune " + scene() + out + " --time 1 --budget 10 --over cache.eror"), 1);
    EXPECT_NE(read(folder_ / "stderr").find("cache.error"), std::string::npos);
    EXPECT_EQ(run("tune " + scene() + out + " --time 1 --budget 10 --for noise=1"), 1);
    EXPECT_EQ(run("tune " + scene() + out + " --time 1 --budget 10 --reference none.exr"), 2);
    EXPECT_EQ(run("tune none.glb" + out + " --time 1 --budget 10"), 2);
}

TEST_F(TuneCli, TheSameSeedAndRoundsGiveTheSameFrontAlsoAfterAnInterruption) {
    ASSERT_EQ(run(command("a", "--threads 1")), 0) << read(folder_ / "stderr");
    const Json front = Json::parse(read(folder_ / "a" / "front.json"));
    EXPECT_GE(front.at("front").size(), 1U);
    EXPECT_EQ(front.at("parameters").size(), 2U);
    EXPECT_EQ(front.at("seeds"), 4);
    for (const Json& finalist : front.at("finalists"))
        for (const Json& point : finalist.at("points")) EXPECT_GT(point.at("seconds").at("value").get<double>(), 0.0);
    const std::string page = read(folder_ / "a" / "report.html");
    for (const char* mark : {"@TITLE@", "@DATA@", "@TUNE@", "@D3@", "@STYLE@"})
        EXPECT_EQ(page.find(mark), std::string::npos) << mark;
    for (const char* request : {"src=\"http", "href=\"http", "url(", "import("})
        EXPECT_EQ(page.find(request), std::string::npos) << request;

    // Interrupted again and again, until it is done: the same bytes.
    int status = 130;
    for (int attempt = 0; attempt < 12 && status == 130; ++attempt)
        status = run(command("b", "--threads 2"),
                     "timeout --foreground -s INT " + std::to_string(0.5 + 0.5 * attempt) + " ");
    if (status == 130 || status == 124) status = run(command("b"));
    EXPECT_EQ(status, 0) << read(folder_ / "stderr");
    EXPECT_EQ(read(folder_ / "a" / "front.json"), read(folder_ / "b" / "front.json"));

    // Another goal is picked from what is there: no new trial.
    const std::string trials = read(folder_ / "a" / "trials.json");
    ASSERT_EQ(run(command("a", "--for error=0.5")), 0) << read(folder_ / "stderr");
    EXPECT_EQ(read(folder_ / "a" / "trials.json"), trials);
    EXPECT_EQ(Json::parse(read(folder_ / "a" / "front.json")).at("goal").at("kind"), "error");
    // A folder of another tuning is not overwritten.
    EXPECT_EQ(run(command("a", "--camera 0")), 1);
}

TEST_F(TuneCli, ABudgetInSecondsAndAGivenReference) {
    const std::string reference = "'" + (folder_ / "reference.exr").string() + "'";
    ASSERT_EQ(run("render " + scene() + " -o " + reference + " --method path --size 24x18 --spp 64 --layers variance"),
              0);
    const fs::path out = folder_ / "timed";
    ASSERT_EQ(run("tune " + scene() + " -o '" + out.string() +
                  "' --time 0.2 --budget 3 --set photon.global=1000 --set cache.rays=32 " +
                  "--quiet --for time=0.1 --reference " + reference),
              0)
        << read(folder_ / "stderr");
    EXPECT_EQ(read(folder_ / "stdout"), "");
    const Json front = Json::parse(read(out / "front.json"));
    EXPECT_EQ(front.at("width"), 24);
    EXPECT_EQ(front.at("unit"), "seconds");
    EXPECT_EQ(front.at("reference").at("file"), "reference.exr");
    EXPECT_FALSE(fs::exists(out / "reference-a.exr"));
    EXPECT_TRUE(fs::exists(out / "tuned.toml"));
    EXPECT_TRUE(fs::exists(out / "report.html"));
    // A reference of another size is told before anything is rendered.
    EXPECT_EQ(run("tune " + scene() + " -o '" + (folder_ / "other").string() +
                  "' --time 0.2 --budget 3 --size 32x24 --reference " + reference),
              2);
}

TEST_F(TuneCli, RenderTakesTheFileAndWarnsOnAnotherScene) {
    std::ofstream(folder_ / "tuned.toml") << "cache.error = 0.5\n\n[tuned]\nscene_hash = \"0123\"\nerror = 0.01\n";
    const std::string render = " -o '" + (folder_ / "a.exr").string() +
                               "' --size 16x12 --spp 1 --set photon.global=1000 --config '" +
                               (folder_ / "tuned.toml").string() + "'";
    ASSERT_EQ(run("render " + scene() + render), 0) << read(folder_ / "stderr");
    EXPECT_NE(read(folder_ / "stderr").find("tuned for another scene"), std::string::npos);
    // The scene's own hash is right: no warning.
    ASSERT_EQ(run("info " + scene() + " --json"), 0);
    const Json info = Json::parse(read(folder_ / "stdout"));
    ASSERT_TRUE(info.contains("scene_hash") || info.contains("hash"));
    const std::string hash = info.value("scene_hash", info.value("hash", ""));
    std::ofstream(folder_ / "tuned.toml") << "cache.error = 0.5\n\n[tuned]\nscene_hash = \"" << hash << "\"\n";
    ASSERT_EQ(run("render " + scene() + render), 0);
    EXPECT_EQ(read(folder_ / "stderr").find("tuned for another scene"), std::string::npos) << read(folder_ / "stderr");
}

}  // namespace
}  // namespace pellucid

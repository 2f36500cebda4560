// The built command from outside: exit statuses, the form of errors, and that JSON parses.
#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <pellucid/io/image_file.h>
#include <pellucid/io/plain_file.h>
#include <pellucid/study/metrics.h>

#include "../support/command.h"
#include "gltf_builder.h"

namespace pellucid {
namespace {

namespace fs = std::filesystem;

using test::Outcome;

class Cli : public test::CommandTest {
protected:
    [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
    [[nodiscard]] static std::string read(const std::string& file) { return test::bytesOf(file); }
    [[nodiscard]] Outcome run(const std::string& arguments, const std::string& before = "") const {
        return runCommand(arguments, before);
    }

    /// The run fails with `status`, nothing on standard output and one well-formed line that holds `words`.
    void expectError(const std::string& arguments, int status, const std::string& words) const {
        const Outcome result = run(arguments);
        EXPECT_EQ(result.status, status) << arguments << "\n" << result.err;
        static const std::regex form(R"(pellucid: error: .+ \(.*\): .+\n)");
        EXPECT_TRUE(std::regex_match(result.err, form)) << arguments << "\n" << result.err;
        EXPECT_NE(result.err.find(words), std::string::npos) << arguments << "\n" << result.err;
        EXPECT_EQ(result.out, "") << arguments;
    }

    std::string image(const std::string& name, float value, int width = 16, int height = 12) const {
        Image image(width, height, {"R", "G", "B"});
        for (float& v : image.data()) v = value;
        writePfm(path(name), image);
        return path(name);
    }

    [[nodiscard]] static std::string sharedScene(const std::string& name) {
        const fs::path file = fs::path(PELLUCID_SHARED_SCENES) / "generated" / name;
        return fs::exists(file) ? file.string() : "";
    }
};

TEST_F(Cli, WrongUse) {
    expectError("", 1, "subcommand");
    expectError("rendre x.glb", 1, "'render'");
    expectError("render", 1, "");
    expectError("render x.glb", 1, "-o");
    expectError("render x.glb -o out.exr --metod path", 1, "--metod");
    expectError("render x.glb -o out.exr --method magic", 1, "magic");
    expectError("render x.glb -o out.exr --size 12", 1, "--size");
    expectError("render x.glb -o out.exr --size 0x4", 1, "--size");
    expectError("render x.glb -o out.exr --time -1", 1, "--time");
    expectError("render x.glb -o out.exr --spp 0", 1, "--spp");
    expectError("render x.glb -o out.exr --spp -1", 1, "--spp");
    expectError("render x.glb -o out.exr --seed -1", 1, "--seed");
    expectError("render x.glb -o out.exr --resume", 1, "checkpoint");
    expectError("render x.glb -o out.exr --cache c --checkpoint s", 1, "--c");
    expectError("render x.glb -o out.exr --cache c --method path", 1, "--method photon");
    expectError("render x.glb -o out.exr --views v.txt --camera 1", 1, "--views");
    expectError("render x.glb -o out.exr --views v.txt --export-points p", 1, "--views");
    expectError("render x.glb -o out.exr --layers albedos", 1, "'albedo'");
    expectError("render x.glb -o out.tga", 1, ".exr, .png, .hdr, .pfm");
    expectError("diff a.exr", 1, "images");
    expectError("diff a.exr b.exr --crop 1,2,3", 1, "--crop");
    expectError("diff a.exr b.exr --fail-above relmsse=1", 1, "'relmse'");
    expectError("diff a.exr b.exr --fail-above relmse", 1, "--fail-above");
}

TEST_F(Cli, UnknownSettingNamesTheNearest) {
    expectError("render x.glb -o out.exr --set cache.eror=0.2", 1, "'cache.error'");
    expectError("render x.glb -o out.exr --set cache.error=99", 1, "0.001 to 10");
    expectError("render x.glb -o out.exr --set cache.error", 1, "KEY=VALUE");
    std::ofstream(path("bad.toml")) << "[photon]\nalhpa = 0.5\n";
    expectError("render x.glb -o out.exr --config '" + path("bad.toml") + "'", 2,
                "line 2): the nearest name is 'photon.alpha'");
}

TEST_F(Cli, MissingFiles) {
    expectError("info '" + path("none.glb") + "'", 2, "none.glb");
    expectError("render '" + path("none.glb") + "' -o '" + path("out.exr") + "'", 2, "none.glb");
    expectError("diff '" + path("none.exr") + "' '" + path("none.exr") + "'", 2, "none.exr");
    expectError("plan x.glb --config '" + path("none.toml") + "'", 2, "none.toml");
}

/// Each broken in one way: one line that names the place, exit status 2, no output.
TEST_F(Cli, BrokenScenes) {
    const auto text = [](const std::vector<std::byte>& bytes) {
        std::string result;
        for (const std::byte b : bytes) result += static_cast<char>(b);
        return result;
    };
    const auto expectRefused = [&](const std::vector<std::byte>& glb, const std::string& words) {
        std::ofstream(path("broken.glb"), std::ios::binary) << text(glb);
        expectError("render '" + path("broken.glb") + "' -o '" + path("out.exr") + "' --env 1,1,1", 2, words);
        EXPECT_FALSE(fs::exists(path("out.exr")));
    };
    const test::GltfBuilder whole = test::triangle();
    std::vector<std::byte> truncated = whole.glb();
    truncated.resize(truncated.size() - 5);
    expectRefused(truncated, "truncated");

    test::GltfBuilder b = whole;
    b.json["accessors"][0]["count"] = 4;
    expectRefused(b.glb(), "accessors[0]): export");
    b = whole;
    test::primitive(b)["attributes"]["NORMAL"] = 9;
    expectRefused(b.glb(), "index 9 is past the end");
    b = whole;
    test::primitive(b)["indices"] = b.data(std::vector<std::uint16_t>{0, 1, 7}, test::kUnsignedShort, "SCALAR");
    expectRefused(b.glb(), "index 7 is past the end of 3 vertices");
    b = test::GltfBuilder{};
    const int positions = b.floats({0, 0, 0, 1, 0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0}, "VEC3");
    b.node({{"mesh", b.mesh({{"attributes", {{"POSITION", positions}}}})}});
    expectRefused(b.glb(), "not finite");
    b = whole;
    b.json["images"] =
        test::Json::array({{{"bufferView", b.view(std::vector<std::uint8_t>(64, 7))}, {"mimeType", "image/png"}}});
    b.json["textures"] = test::Json::array({{{"source", 0}}});
    b.json["materials"] = test::Json::array({{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
    test::primitive(b)["material"] = 0;
    expectRefused(b.glb(), "images[0]");
    std::ofstream(path("map.exr")) << "no image";
    std::ofstream(path("whole.glb"), std::ios::binary) << text(whole.glb());
    expectError("render '" + path("whole.glb") + "' -o '" + path("out.exr") + "' --env '" + path("map.exr") + "'", 2,
                "map.exr");
    expectError("render '" + path("whole.glb") + "' -o '" + path("out.exr") + "'", 2, "no light");
}

TEST_F(Cli, OutputsAreCheckedBeforeTheSceneIsRead) {
    // The scene is missing too: whichever is looked at first makes the error.
    const std::string scene = "render '" + path("none.glb") + "' ";
    expectError(scene + "-o '" + path("no/such/out.exr") + "'", 3, "out.exr");
    expectError(scene + "-o '" + path("a.exr") + "' --record '" + path("no/r.json") + "'", 3, "r.json");
    expectError(scene + "-o '" + path("a.exr") + "' --checkpoint '" + path("no/c") + "'", 3, "no/c");
    expectError(scene + "-o /proc/out.exr", 3, "/proc/out.exr");  // a folder that nobody may write, root included
    fs::create_directory(path("folder.exr"));
    expectError(scene + "-o '" + path("folder.exr") + "'", 3, "folder.exr");
    EXPECT_FALSE(fs::exists(path("a.exr")));
}

TEST_F(Cli, HelpAndVersion) {
    for (const char* command : {"", "render ", "plan ", "info ", "diff "}) {
        const Outcome help = run(std::string(command) + "--help");
        EXPECT_EQ(help.status, 0);
        EXPECT_NE(help.out.find("pellucid"), std::string::npos) << command;
        EXPECT_EQ(help.err, "");
        EXPECT_EQ(help.out.find("Examples:") == std::string::npos, *command == '\0') << command;
    }
    EXPECT_TRUE(std::regex_match(run("--version").out, std::regex(R"(pellucid \d+\.\d+\.\d+\n)")));
}

TEST_F(Cli, DiffOfIdenticalImagesIsZero) {
    const std::string a = image("a.pfm", 0.5F);
    const Outcome text = run("diff '" + a + "' '" + a + "'");
    EXPECT_EQ(text.status, 0) << text.err;
    EXPECT_NE(text.out.find("relmse_trimmed"), std::string::npos);
    const Outcome result = run("diff '" + a + "' '" + a + "' --json --fail-above relmse=0 --fail-above flip=0");
    EXPECT_EQ(result.status, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("reference"), a);
    for (const char* metric : {"rmse", "relmse", "relmse_trimmed", "smape", "flip", "bias", "nonfinite"})
        EXPECT_EQ(json.at("images").at(0).at(metric), 0) << metric;
    EXPECT_FALSE(json.contains("reference_noise"));
}

TEST_F(Cli, DiffMeasuresEachImageAndGates) {
    const std::string r = image("r.pfm", 0.5F), a = image("a.pfm", 0.75F), b = image("b.pfm", 0.25F);
    const std::string files = "diff '" + r + "' '" + a + "' '" + b + "' --json";
    const Outcome result = run(files + " --map '" + path("map.png") + "'");
    ASSERT_EQ(result.status, 0) << result.err;
    const auto images = nlohmann::json::parse(result.out).at("images");
    ASSERT_EQ(images.size(), 2U);
    EXPECT_EQ(images[0].at("file"), a);
    EXPECT_DOUBLE_EQ(images[0].at("bias"), 0.5);
    EXPECT_DOUBLE_EQ(images[1].at("bias"), -0.5);
    EXPECT_NEAR(images[0].at("relmse").get<double>(), 0.0625 / (0.25 * 1.01), 1e-12);
    EXPECT_TRUE(fs::exists(path("map-1.png")) && fs::exists(path("map-2.png")));

    EXPECT_EQ(run(files + " --fail-above relmse=0.3 --fail-above bias=0.5").status, 0);
    const Outcome gated = run(files + " --fail-above relmse=0.2");
    EXPECT_EQ(gated.status, 4);
    EXPECT_EQ(nlohmann::json::parse(gated.out).at("images").size(), 2U);
    EXPECT_NE(gated.err.find("relmse 0.2475 is above 0.2"), std::string::npos) << gated.err;
    EXPECT_EQ(run(files + " --fail-above bias=0.4").status, 4);

    const Outcome scaled = run(files + " --exposure-invariant");
    const auto scaledImages = nlohmann::json::parse(scaled.out).at("images");
    EXPECT_NEAR(scaledImages[1].at("relmse").get<double>(), 0.0, 1e-12);
    EXPECT_DOUBLE_EQ(scaledImages[1].at("scale"), 2.0);
    EXPECT_DOUBLE_EQ(scaledImages[1].at("bias"), -0.5);
}

TEST_F(Cli, DiffRefusesOtherSizesAndCropsOutside) {
    const std::string a = image("a.pfm", 1.0F), b = image("b.pfm", 1.0F, 8, 8);
    expectError("diff '" + a + "' '" + b + "'", 2, "different sizes");
    expectError("diff '" + a + "' '" + b + "'", 2, "b.pfm");
    expectError("diff '" + a + "' '" + a + "' --crop 0,0,17,3", 1, "--crop");
    EXPECT_EQ(run("diff '" + a + "' '" + b + "' --crop 2,2,8,8").status, 0);
    expectError("diff '" + a + "' '" + a + "' --map '" + path("no/map.png") + "'", 3, "map.png");
}

TEST_F(Cli, DiffKnowsMaskAndReferenceNoise) {
    Image reference(4, 4, {"R", "G", "B", "mask.Y", "variance.R", "variance.G", "variance.B"});
    for (std::size_t p = 0; p < reference.pixels(); ++p) {
        reference.setRgb(p, Rgb(p == 5 ? 17.0F : 1.0F));  // with the masked pixel mean(R) = 2
        reference.at(p, 3) = p == 5 ? 0.0F : 1.0F;
        reference.setRgb(p, Rgb(0.0104F), 4);
    }
    writeExr(path("r.exr"), reference, {});
    const std::string files = "diff '" + path("r.exr") + "' '" + image("i.pfm", 1.0F, 4, 4) + "'";
    const auto json = nlohmann::json::parse(run(files + " --json").out);
    EXPECT_EQ(json.at("images").at(0).at("relmse"), 0.0);
    EXPECT_EQ(json.at("counted_pixels"), 15);
    EXPECT_NEAR(json.at("reference_noise").get<double>(), 0.01, 1e-6);
    const std::string text = run(files).out;
    EXPECT_NE(text.find("mask.Y of the reference leaves out 1 of 16 pixels"), std::string::npos) << text;
    EXPECT_NE(text.find("reference noise 0.01"), std::string::npos) << text;
}

TEST_F(Cli, InfoAsJson) {
    const std::string scene = sharedScene("peer-box.glb");
    if (scene.empty()) GTEST_SKIP() << "the shared scenes are not here";
    const Outcome result = run("info '" + scene + "' --json");
    ASSERT_EQ(result.status, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_GT(json.at("triangles").get<int>(), 0);
    for (const char* key : {"materials", "lights", "cameras", "extensions_used", "extensions_ignored", "warnings"})
        EXPECT_TRUE(json.at(key).is_array()) << key;
    EXPECT_EQ(run("info '" + scene + "'").status, 0);
}

TEST_F(Cli, RenderWritesEveryOutputAndARecord) {
    const std::string scene = sharedScene("peer-box.glb");
    if (scene.empty()) GTEST_SKIP() << "the shared scenes are not here";
    const std::string arguments = "render '" + scene + "' --size 24x24 --spp 1 --exposure -1 --quiet";
    std::string outputs;
    for (const char* name : {"o.exr", "o.png", "o.hdr", "o.pfm"}) outputs += " -o '" + path(name) + "'";
    const Outcome result = run(arguments + outputs + " --record '" + path("record.json") + "' --set photon.alpha=0.7");
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err + result.out, "");
    for (const char* name : {"o.exr", "o.png", "o.hdr", "o.pfm"}) {
        const Image image = readImage(path(name));
        EXPECT_EQ(image.width(), 24) << name;
        EXPECT_EQ(image.height(), 24) << name;
    }
    const auto record = nlohmann::json::parse(read(path("record.json")));
    for (const char* key : {"version", "scene_hash", "settings", "plan", "iterations", "stages", "threads",
                            "peak_rss_bytes", "nonfinite", "error_estimate", "images"})
        EXPECT_TRUE(record.contains(key)) << key;
    EXPECT_DOUBLE_EQ(record.at("settings").at("photon.alpha"), 0.7);
    EXPECT_EQ(record.at("images").size(), 4U);
    EXPECT_NEAR(compareImages(readImage(path("o.exr")), readImage(path("o.pfm")), false).relmse, 0.0, 1e-12);
    EXPECT_LT(compareImages(readImage(path("o.exr")), readImage(path("o.hdr")), false).relmse, 1e-4);
}

TEST_F(Cli, InterruptedRenderIsWritten) {
    const std::string scene = sharedScene("peer-box.glb");
    if (scene.empty()) GTEST_SKIP() << "the shared scenes are not here";
    const Outcome result = run("render '" + scene + "' --size 32x32 --time 60 -o '" + path("o.exr") + "' --record '" +
                                   path("record.json") + "'",
                               "timeout --preserve-status -s INT 5");
    EXPECT_EQ(result.status, 130) << result.err;
    EXPECT_TRUE(fs::exists(path("o.exr")));
    EXPECT_EQ(nlohmann::json::parse(read(path("record.json"))).at("interrupted"), true);
}

}  // namespace
}  // namespace pellucid

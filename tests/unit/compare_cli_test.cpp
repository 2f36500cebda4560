// `pellucid compare` from outside: a tiny comparison end to end, again from stored runs, and wrong use. And the pieces of
// it that need no render: the grammar of --methods, statistics against closed forms, the packing of the page.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <span>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <pellucid/base/error.h>
#include <pellucid/io/image_file.h>
#include <pellucid/study/compare.h>
#include <pellucid/study/diff_report.h>
#include <pellucid/study/report.h>
#include <pellucid/study/statistics.h>

#include "../support/command.h"

namespace pellucid {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

[[nodiscard]] std::string read(const fs::path& file) { return test::bytesOf(file); }

TEST(CompareMethods, CarryTheirOwnSettings) {
    Settings common;
    common.alpha = 0.5;
    const auto methods = parseMethods("path,photon:cache.error=0.1+photon.radius=2,photon:photon.caustic=1e+3", common);
    ASSERT_EQ(methods.size(), 3U);
    EXPECT_EQ(methods[0].method, Method::Path);
    EXPECT_EQ(methods[1].settings.cacheError, 0.1);
    EXPECT_EQ(methods[1].settings.causticRadius, 2.0);
    EXPECT_EQ(methods[1].settings.alpha, 0.5);
    EXPECT_EQ(methods[2].settings.causticPhotons, 1000);
    EXPECT_THROW(static_cast<void>(parseMethods("photon:cache.eror=0.1", {})), Error);
    EXPECT_THROW(static_cast<void>(parseMethods("foton", {})), Error);
    EXPECT_THROW(static_cast<void>(parseMethods("path,path", {})), Error);
    EXPECT_THROW(static_cast<void>(parseMethods("", {})), Error);
    EXPECT_EQ(parseTimes("4,1,2,1"), (std::vector<double>{1, 2, 4}));
    for (const char* wrong : {"", "0", "-1", "1,,2", "inf", "1s"})
        EXPECT_THROW(static_cast<void>(parseTimes(wrong)), Error) << wrong;
}

TEST(CompareStatistics, ClosedForms) {
    EXPECT_NEAR(studentQuantile(0.975, 1), 12.7062, 1e-4);  // published tables of Student's t
    EXPECT_NEAR(studentQuantile(0.975, 2), 4.30265, 1e-5);
    EXPECT_NEAR(studentQuantile(0.975, 7), 2.36462, 1e-5);
    EXPECT_NEAR(studentQuantile(0.975, 30), 2.04227, 1e-5);
    const std::vector<double> a{1, 2, 3}, b{4, 5, 6};
    EXPECT_NEAR(permutationTest(a, b), 2.0 / 20.0, 1e-12);  // 20 splits, two of them as extreme
    const std::vector<double> p{0.01, 0.04, 0.03};
    const std::vector<double> adjusted = holmAdjusted(p);  // 3 x .01, then 2 x .03, then no less
    EXPECT_NEAR(adjusted[0], 0.03, 1e-12);
    EXPECT_NEAR(adjusted[1], 0.06, 1e-12);
    EXPECT_NEAR(adjusted[2], 0.06, 1e-12);
    const std::vector<double> seconds{1, 2, 4, 8}, relmse{0.16, 0.08, 0.04, 0.02};  // 0.16 / t
    EXPECT_NEAR(logLogSlope(seconds, relmse), -1.0, 1e-12);
    EXPECT_EQ(logLogSlope(seconds, std::vector<double>{0.133, 0.133, 0.133, 0.133}), 0.0);
    EXPECT_NEAR(timeToError(seconds, relmse, std::sqrt(0.05)), 3.2, 1e-12);
    EXPECT_EQ(timeToError(seconds, relmse, 0.5), 1.0);
    EXPECT_TRUE(std::isinf(timeToError(seconds, relmse, 0.01)));
}

/// Two seeds, two pixels, no noise in the reference: all can be done by hand.
TEST(CompareStatistics, BiasAndVarianceByHand) {
    const Image reference(2, 1, {"Y"});
    std::vector<Image> images(2, reference);
    images[0].data() = {1.0F, 3.0F};
    images[1].data() = {3.0F, 1.0F};
    const ErrorProducts errors = errorProducts(reference, images, false);
    const std::vector<int> once{1, 1};
    EXPECT_DOUBLE_EQ(meanSquaredError(errors, once), 5.0);
    EXPECT_DOUBLE_EQ(errorVariance(errors, once), 2.0);  // s^2 of {1, 3}
    EXPECT_DOUBLE_EQ(biasSquared(errors, once), 3.0);    // 2^2 - 2/2
}

/// Noise of the colour of the light, a tenth of the radiance in each channel: relative variance 0.01 up to the floor,
/// whether the layer tells each channel's variance or the luminance's.
TEST(CompareStatistics, NoiseOfAColouredReference) {
    const Rgb gold{1.0F, 0.5F, 0.02F};
    const double luminance = 0.2126 * 1.0 + 0.7152 * 0.5 + 0.0722 * 0.02;
    const double floor = 0.01 * std::pow((1.0 + 0.5 + 0.02) / 3.0, 2);
    double expected = 0.0;
    for (const double r : {1.0, 0.5, 0.02}) expected += 0.01 * r * r / (r * r + floor) / 3.0;
    Image grey(2, 1, {"R", "G", "B", "variance.Y"}),
        colours(2, 1, {"R", "G", "B", "variance.R", "variance.G", "variance.B"});
    for (std::size_t p = 0; p < 2; ++p) {
        grey.setRgb(p, gold);
        grey.at(p, 3) = static_cast<float>(0.01 * luminance * luminance);
        colours.setRgb(p, gold);
        colours.setRgb(p, 0.01F * gold * gold, 3);
    }
    for (const Image& reference : {grey, colours}) {
        ASSERT_TRUE(referenceNoise(reference).has_value());
        EXPECT_NEAR(*referenceNoise(reference), expected, 1e-7);
        EXPECT_NEAR(errorProducts(reference, std::span(&reference, 1), true).referenceNoise, expected, 1e-7);
    }
}

TEST(CompareReport, IsOnePageThatAsksForNothing) {
    ReportData data;
    data.title = "</script><b>\"&";
    data.summaryJson = R"({"methods": [], "times": [1]})";
    data.curvesJson = data.runsJson = "[]";
    data.pictures.push_back({"reference", 0.0, 0, Image(300, 200, {"R", "G", "B"})});
    const std::string page = reportHtml(data);
    for (const char* mark : {"@TITLE@", "@DATA@", "@PIXEL_LIST@", "@PIXELS@", "@STYLE@", "@D3@", "<b>"})
        EXPECT_EQ(page.find(mark), std::string::npos) << mark;
    for (const char* request : {"src=\"http", "href=\"http", "url(", "import("})
        EXPECT_EQ(page.find(request), std::string::npos) << request;
    EXPECT_NE(page.find(R"("bytes":4)"), std::string::npos);
}

TEST(CompareReport, StaysBelowItsSize) {
    ReportData data;
    data.summaryJson = data.curvesJson = data.runsJson = "[]";
    const Image picture(512, 512, {"R", "G", "B"}), map(512, 512, {"Y"});
    data.pictures.push_back({"reference", 0.0, 0, picture});
    for (const double budget : {8.0, 4.0})
        for (const char* name : {"a", "b", "c"}) data.pictures.push_back({name, budget, 0, picture});
    for (const char* name : {"a", "b", "c"}) {
        data.maps.push_back({name, "bias", 8.0, map});
        data.maps.push_back({name, "deviation", 8.0, map});
    }
    EXPECT_LT(reportHtml(data).size(), 15'000'000U);
}

class CompareCli : public test::CommandTest {
protected:
    [[nodiscard]] int run(const std::string& arguments) const { return runCommand("compare " + arguments).status; }
    [[nodiscard]] static std::string scene() { return std::string(PELLUCID_SOURCE_DIR) + "/scenes/diffuse-room.glb"; }
};

TEST_F(CompareCli, WrongUse) {
    const std::string out = " -o '" + folder_.path().string() + "'";
    EXPECT_EQ(run(scene() + out + " --times 1"), 1);
    EXPECT_EQ(run(scene() + out + " --methods path"), 1);
    EXPECT_EQ(run(scene() + out + " --methods pth --times 1"), 1);
    EXPECT_NE(read(folder_ / "stderr").find("'path'"), std::string::npos);
    EXPECT_EQ(run(scene() + out + " --methods path --times 0"), 1);
    EXPECT_EQ(run(scene() + out + " --methods path --times 1 --seeds 0"), 1);
    EXPECT_EQ(run(scene() + out + " --methods path --times 1 --reference none.exr"), 2);
    EXPECT_EQ(run("none.glb" + out + " --methods path --times 1"), 2);
}

TEST_F(CompareCli, EndToEndAndAgainFromStoredRuns) {
    ASSERT_TRUE(fs::exists(scene())) << "./run scenes writes the project's own scenes";
    const fs::path study = folder_ / "study";
    const std::string command = "'" + scene() + "' -o '" + study.string() +
                                "' --methods path,photon:cache.error=0.3 --times 0.3,0.6 --seeds 2 --size 32x24 "
                                "--reference-time 1.5";
    ASSERT_EQ(run(command), 0) << read(folder_ / "stderr");
    const Json curves = Json::parse(read(study / "curves.json"));
    ASSERT_EQ(curves.size(), 8U);
    for (const Json& row : curves) {
        EXPECT_GT(row.at("seconds").get<double>(), 0.0);
        EXPECT_TRUE(std::isfinite(row.at("relmse").get<double>()));
        EXPECT_TRUE(fs::exists(study / row.at("image").get<std::string>()));
        EXPECT_EQ(row.at("classes").size(), 3U);
    }
    const Json summary = Json::parse(read(study / "summary.json"));
    ASSERT_EQ(summary.at("methods").size(), 2U);
    for (const Json& method : summary.at("methods"))
        for (const Json& point : method.at("points")) {
            const double parts = point.at("bias2").at("value").get<double>() +
                                 point.at("variance").at("value").get<double>() +
                                 summary.at("reference").at("noise_relmse").get<double>();
            const double whole = point.at("relmse").at("value").get<double>();
            EXPECT_NEAR(parts, whole, 1e-4 * whole);
        }
    EXPECT_EQ(read(study / "report.html").substr(0, 15), "<!DOCTYPE html>");
    const std::string csv = read(study / "curves.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 9);

    // A method more: only its four runs are new, and none of the old images is touched.
    const fs::path old = study / curves[0].at("image").get<std::string>();
    const auto written = fs::last_write_time(old);
    ASSERT_EQ(run(command + " --methods path,photon:cache.error=0.3"), 1);  // twice the same option is wrong use
    const std::string::size_type place = command.find("path,");
    ASSERT_EQ(run(std::string(command).replace(place, 5, "light,path,")), 0) << read(folder_ / "stderr");
    EXPECT_EQ(fs::last_write_time(old), written);
    const Json grown = Json::parse(read(study / "curves.json"));
    ASSERT_EQ(grown.size(), 12U);
    EXPECT_EQ(grown[0].at("method"), "light");  // in the order of --methods, whatever was finished first
    EXPECT_EQ(grown[4].at("method"), "path");
    EXPECT_EQ(grown[8].at("method"), "photon:cache.error=0.3");
    // Six comparisons: with five seeds a side the smallest p of the family is 6 x 2/252 = 0.048, with four 6 x 2/70.
    EXPECT_EQ(Json::parse(read(study / "summary.json")).at("seeds_needed"), 5);
    EXPECT_NE(read(folder_ / "stdout").find("need --seeds 5"), std::string::npos);
    EXPECT_NE(read(folder_ / "stdout").find("report.html"), std::string::npos);
}

/// Whatever ends a comparison, each stored run is whole, and going on renders none of them again.
TEST_F(CompareCli, KilledAndResumed) {
    const fs::path study = folder_ / "study";
    const std::string arguments = "'" + scene() + "' -o '" + study.string() +
                                  "' --methods path --times 0.2 --seeds 6 --size 16x12 --reference-time 0.3 --quiet";
    std::map<fs::path, fs::file_time_type> finished;
    for (const char* signal : {"KILL", "INT"}) {
        const std::string command = std::string("timeout -s ") + signal + " 0.6 '" PELLUCID_BINARY "' compare " +
                                    arguments + " >/dev/null 2>&1";
        static_cast<void>(std::system(command.c_str()));
        for (const auto& [file, written] : finished) EXPECT_EQ(fs::last_write_time(file), written) << file;
        if (!fs::exists(study / "runs")) continue;  // the machine is busy: it never got so far
        for (const fs::directory_entry& entry : fs::directory_iterator(study / "runs")) {
            if (entry.path().extension() != ".json") continue;
            const fs::path image = study / Json::parse(read(entry.path())).at("image").get<std::string>();
            EXPECT_EQ(readImage(image).pixels(), 192U) << image;
            finished[image] = fs::last_write_time(image);
        }
    }
    ASSERT_EQ(run(arguments), 0) << read(folder_ / "stderr");
    for (const auto& [file, written] : finished) EXPECT_EQ(fs::last_write_time(file), written) << file;
    EXPECT_EQ(Json::parse(read(study / "curves.json")).size(), 6U);
}

/// An error that is no number must not come back as "no error" when the stored runs are read again.
TEST_F(CompareCli, InfiniteErrorsStayInfinite) {
    const fs::path reference = folder_ / "black.exr", study = folder_ / "study";
    writeExr(reference, Image(16, 12, {"R", "G", "B"}), {});
    const std::string command = "'" + scene() + "' -o '" + study.string() +
                                "' --methods path --times 0.1,0.10001 --seeds 1 --reference '" + reference.string() +
                                "'";
    for (int time = 0; time < 2; ++time) {
        ASSERT_EQ(run(command), 0) << read(folder_ / "stderr");
        const Json curves = Json::parse(read(study / "curves.json"));
        ASSERT_EQ(curves.size(), 2U);
        for (const Json& row : curves) EXPECT_TRUE(row.at("relmse").is_null()) << row;
        EXPECT_NE(curves[0].at("image"), curves[1].at("image"));  // budgets that print alike are still two
    }
}

}  // namespace
}  // namespace pellucid

// `pellucid diff` against an independent program: the RMS error of `oiiotool --diff`, between EXR, PFM and HDR files.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <pellucid/io/image_file.h>
#include <pellucid/io/plain_file.h>
#include <pellucid/math/hash.h>

#include "../support/files.h"

namespace pellucid {
namespace {

[[nodiscard]] std::string outputOf(const std::string& command) {
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen((command + " 2>&1").c_str(), "r"), pclose);
    std::string text;
    char part[256];
    while (std::fgets(part, sizeof part, pipe.get()) != nullptr) text += part;
    return text;
}

[[nodiscard]] Image noise(std::uint64_t key) {
    Image image(20, 15, {"R", "G", "B"});
    for (std::size_t i = 0; i < image.data().size(); ++i)
        image.data()[i] = 0.1F + static_cast<float>(hashCombine(key, i) >> 40U) * 0x1p-24F;
    return image;
}

TEST(DiffCli, AgreesWithOiiotool) {
    if (std::system("command -v oiiotool >/dev/null 2>&1") != 0) GTEST_SKIP() << "oiiotool is missing";
    const test::TemporaryFolder folder;
    const std::string reference = (folder / "a.exr").string();
    writeExr(reference, noise(1), {});
    writeExr(folder / "b.exr", noise(2), {});
    writePfm(folder / "b.pfm", noise(3));
    writeRadianceHdr(folder / "b.hdr", noise(4));
    for (const char* name : {"b.exr", "b.pfm", "b.hdr"}) {
        const std::string other = (folder / name).string();
        const std::string told = outputOf("oiiotool --diff --fail 1e9 '" + reference + "' '" + other + "'");
        const std::string::size_type place = told.find("RMS error = ");
        ASSERT_NE(place, std::string::npos) << told;
        const double expected = std::stod(told.substr(place + 12));
        const auto json =
            nlohmann::json::parse(outputOf("'" PELLUCID_BINARY "' diff --json '" + reference + "' '" + other + "'"));
        const nlohmann::json& row = json.is_array() ? json.at(0) : json.at("images").at(0);
        EXPECT_NEAR(row.at("rmse").get<double>(), expected, 2e-5 * expected) << name;
    }
}

}  // namespace
}  // namespace pellucid

// The table of parameters and its three doors: --set, a TOML file and the text of records.
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <pellucid/base/error.h>
#include <pellucid/base/nearest_name.h>
#include <pellucid/io/settings_file.h>
#include <pellucid/render/settings.h>

#include "../support/files.h"

namespace pellucid {
namespace {

Error errorOf(const std::string& name, const std::string& value) {
    Settings settings;
    try {
        setParameter(settings, name, value);
    } catch (const Error& error) {
        return error;
    }
    ADD_FAILURE() << name << " = " << value << " was taken";
    return {ErrorKind::Usage, "", "", ""};
}

class SettingsFile : public testing::Test {
protected:
    std::string write(const std::string& text) const {
        const std::filesystem::path file = folder_ / "settings.toml";
        std::ofstream(file) << text;
        return file.string();
    }

private:
    test::TemporaryFolder folder_;
};

TEST(Settings, NamesAreUniqueAndDefaultsRoundTrip) {
    std::set<std::string_view> names;
    for (const Parameter& row : parameters()) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_FALSE(row.help.empty()) << row.name;
    }
    Settings settings;
    for (const auto& [name, value] : settingsAsText(Settings{})) EXPECT_NO_THROW(setParameter(settings, name, value));
    EXPECT_EQ(settingsAsText(settings), settingsAsText(Settings{}));
    EXPECT_EQ(settings.alpha, 2.0 / 3.0);
}

TEST(Settings, SetsEveryKind) {
    Settings settings;
    setParameter(settings, "cache.error", "0.25");
    setParameter(settings, "cache.rays", "1e3");
    setParameter(settings, "photon.guiding", "off");
    EXPECT_EQ(settings.cacheError, 0.25);
    EXPECT_EQ(settings.gatherRays, 1000);
    EXPECT_EQ(settings.guiding, "off");
    setParameter(settings, "cache.error", "auto");
    setParameter(settings, "cache.rays", "-1");
    EXPECT_EQ(settings.cacheError, -1.0);
    EXPECT_EQ(settings.gatherRays, -1);
}

TEST(Settings, UnknownNameSuggestsTheNearest) {
    const Error error = errorOf("cache.eror", "1");
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
    EXPECT_NE(error.mend().find("'cache.error'"), std::string::npos);
    EXPECT_NE(errorOf("alhpa", "1").mend().find("'photon.alpha'"), std::string::npos);
}

TEST(Settings, RefusesWhatIsOutOfRangeOrNoNumber) {
    for (const char* value : {"0", "11", "nan", "inf", "", "0.1x", "x", "-2"})
        EXPECT_NE(errorOf("cache.error", value).mend().find("0.001 to 10"), std::string::npos) << value;
    errorOf("cache.rays", "20.5");
    errorOf("path.max_depth", "-1");
    errorOf("path.max_depth", "auto");
    errorOf("photon.guiding", "on|off");
    errorOf("photon.guiding", "");
    EXPECT_NE(errorOf("path.mis", "max").mend().find("balance|power"), std::string::npos);
}

TEST(NearestName, Distances) {
    EXPECT_EQ(editDistance("", "abc"), 3U);
    EXPECT_EQ(editDistance("kitten", "sitting"), 3U);
    EXPECT_EQ(editDistance("alhpa", "alpha"), 1U);
    EXPECT_EQ(editDistance("same", "same"), 0U);
    EXPECT_TRUE(nearestName("x", {}).empty());
}

TEST_F(SettingsFile, ReadsTablesAndDottedKeys) {
    Settings settings;
    loadSettings(settings, write("camera.aperture = 0.02\n[cache]\nmode = true\nerror = 0.5\nrays = 64\n"));
    EXPECT_EQ(settings.aperture, 0.02);
    EXPECT_EQ(settings.cache, "on");
    EXPECT_EQ(settings.cacheError, 0.5);
    EXPECT_EQ(settings.gatherRays, 64);
}

TEST_F(SettingsFile, KeepsTheOrderOfTheFile) {
    const auto entries = readSettingsFile(write("b = 1\na = 'word'\n[t]\nz = 0.1\nc = false\n"));
    ASSERT_EQ(entries.size(), 4U);
    EXPECT_EQ(entries[0].key, "b");
    EXPECT_EQ(entries[1].value, "word");
    EXPECT_EQ(entries[2].key, "t.z");
    EXPECT_EQ(entries[2].value, "0.1");
    EXPECT_EQ(entries[3].value, "off");
    EXPECT_EQ(entries[3].line, 5);
}

TEST_F(SettingsFile, NamesFileAndLineOfWhatIsWrong) {
    for (const char* text : {"\ncache.errr = 1\n", "\ncache.error = 100\n", "\ncache.error = [1, 2]\n", "\n= = =\n"}) {
        const std::string file = write(text);
        Settings settings;
        try {
            loadSettings(settings, file);
            ADD_FAILURE() << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::BadInput);
            EXPECT_EQ(error.where(), file + ", line 2");
        }
    }
    Settings settings;
    EXPECT_THROW(loadSettings(settings, "no/such/file.toml"), Error);
    EXPECT_THROW(loadSettings(settings, testing::TempDir()), Error);
}

}  // namespace
}  // namespace pellucid

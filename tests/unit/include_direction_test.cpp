/// The house rule, read from the sources: a floor includes only its own and lower floors, and each third-party library
/// is seen in one room. Whoever breaks it gets the file, the line and the reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 10> kFloors{"base", "math",      "geometry", "surface", "scene",
                                                   "io",   "transport", "render",   "study",   "cli"};

/// A library and the beginning of the paths that may include it. `sourcesOnly`: never in a header
/// (nanoflann's adapters and CLI11's options may stand in a private header of their room).
struct Guest {
    std::string_view library;
    std::string_view header;  ///< regular expression over the included name
    std::string_view room;
    bool sourcesOnly;
};

constexpr std::array<Guest, 10> kGuests{{
    {"Embree", "embree3/.*", "src/geometry/", true},
    {"nanoflann", "nanoflann\\.hpp", "src/transport/", false},
    {"OpenImageIO", "OpenImageIO/.*", "src/io/image", true},
    {"OpenEXR", "OpenEXR/.*", "src/io/exr", true},
    {"tinygltf", "tiny_gltf\\.h", "src/io/", true},
    {"oneTBB", "(tbb|oneapi)/.*", "src/base/", true},
    {"CLI11", "CLI/.*", "src/cli/", false},
    {"fmt", "fmt/.*", "src/", true},
    {"nlohmann-json", "nlohmann/.*", "src/", true},
    {"toml++", "toml\\+\\+/.*|toml\\.hpp", "src/", true},
}};

struct Include {
    std::string file;  ///< relative to the root, with forward slashes
    int line = 0;
    std::string name;
    bool quoted = false;
};

std::optional<std::size_t> floorNumber(std::string_view floor) {
    const auto found = std::find(kFloors.begin(), kFloors.end(), floor);
    if (found == kFloors.end()) return std::nullopt;
    return static_cast<std::size_t>(found - kFloors.begin());
}

/// The floor of "src/<floor>/..." or "include/pellucid/<floor>/...".
std::string floorOfFile(const std::string& file) {
    const std::string rest = file.substr(file.starts_with("src/") ? 4 : std::string_view("include/pellucid/").size());
    return rest.substr(0, rest.find('/'));
}

std::vector<Include> parseIncludes(const std::string& file, std::istream& text) {
    static const std::regex pattern(R"rx(^\s*#\s*include\s*([<"])([^>"]+)[>"])rx");
    std::vector<Include> includes;
    std::string line;
    for (int number = 1; std::getline(text, line); ++number) {
        std::smatch match;
        if (std::regex_search(line, match, pattern)) includes.push_back({file, number, match[2], match[1] == "\""});
    }
    return includes;
}

/// What is wrong with an include, or nothing.
std::optional<std::string> complaint(const Include& include) {
    const bool header = include.file.ends_with(".h");
    const std::string mine = floorOfFile(include.file);
    const auto floor = floorNumber(mine);
    if (!floor) return "'" + mine + "' is no floor of the house";

    if (include.name.starts_with("pellucid/")) {
        const std::string rest = include.name.substr(std::string_view("pellucid/").size());
        const std::string theirs = rest.substr(0, rest.find('/'));
        const auto other = floorNumber(theirs);
        if (!other) return "'" + theirs + "' is no floor of the house";
        if (*other > *floor) return mine + "/ may not include the higher floor " + theirs + "/";
        return std::nullopt;
    }
    if (include.quoted) {
        const bool sameFolder = include.name.find('/') == std::string::npos;
        if (sameFolder && include.file.starts_with("src/")) return std::nullopt;
        return "quotes are for a private header of the same room; others are <pellucid/floor/x.h>";
    }
    for (const Guest& guest : kGuests) {
        if (!std::regex_match(include.name, std::regex(std::string(guest.header)))) continue;
        if (!include.file.starts_with(guest.room)) {
            return std::string(guest.library) + " may be included only in " + std::string(guest.room) + "*";
        }
        if (guest.sourcesOnly && header) return std::string(guest.library) + " may be included only in .cpp files";
        return std::nullopt;
    }
    const bool glm = include.name.starts_with("glm/");
    const bool standard = include.name.find('/') == std::string::npos || include.name.starts_with("sys/");
    if (glm || standard) return std::nullopt;
    return "a library without a room; give it one in include_direction_test.cpp";
}

std::optional<std::string> complaintAbout(const std::string& file, const std::string& line) {
    std::istringstream text(line);
    return complaint(parseIncludes(file, text).at(0));
}

TEST(IncludeDirection, TheHouseKeepsItsFloors) {
    const fs::path root(PELLUCID_SOURCE_DIR);
    int files = 0;
    for (const char* folder : {"include", "src"}) {
        for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".h" && extension != ".cpp") continue;
            ++files;
            std::ifstream text(entry.path());
            for (const Include& include : parseIncludes(fs::relative(entry.path(), root).generic_string(), text)) {
                const auto wrong = complaint(include);
                EXPECT_FALSE(wrong) << include.file << ":" << include.line << ": <" << include.name << ">: " << *wrong;
            }
        }
    }
    EXPECT_GT(files, 20);
}

TEST(IncludeDirection, TheRuleItselfSeesWhatItShould) {
    EXPECT_FALSE(complaintAbout("src/math/a.cpp", "#include <pellucid/base/error.h>"));
    EXPECT_FALSE(complaintAbout("src/math/a.cpp", "#include <pellucid/math/ray.h>"));
    EXPECT_TRUE(complaintAbout("src/math/a.cpp", "#include <pellucid/geometry/mesh.h>"));
    EXPECT_TRUE(complaintAbout("include/pellucid/io/a.h", "  #  include <pellucid/render/plan.h>"));
    EXPECT_TRUE(complaintAbout("src/math/a.cpp", "#include <pellucid/attic/x.h>"));
    EXPECT_FALSE(complaintAbout("src/geometry/accel.cpp", "#include <embree3/rtcore.h>"));
    EXPECT_TRUE(complaintAbout("src/transport/a.cpp", "#include <embree3/rtcore.h>"));
    EXPECT_TRUE(complaintAbout("include/pellucid/geometry/a.h", "#include <embree3/rtcore.h>"));
    EXPECT_TRUE(complaintAbout("src/geometry/private.h", "#include <embree3/rtcore.h>"));
    EXPECT_FALSE(complaintAbout("src/io/image_file.cpp", "#include <OpenImageIO/imageio.h>"));
    EXPECT_TRUE(complaintAbout("src/io/gltf.cpp", "#include <OpenImageIO/imageio.h>"));
    EXPECT_TRUE(complaintAbout("src/render/a.cpp", "#include <tbb/parallel_for.h>"));
    EXPECT_TRUE(complaintAbout("include/pellucid/io/a.h", "#include <nlohmann/json.hpp>"));
    EXPECT_FALSE(complaintAbout("include/pellucid/math/a.h", "#include <glm/glm.hpp>"));
    EXPECT_FALSE(complaintAbout("src/scene/a.cpp", "#include \"private.h\""));
    EXPECT_TRUE(complaintAbout("src/scene/a.cpp", "#include \"../math/private.h\""));
    EXPECT_TRUE(complaintAbout("src/scene/a.cpp", "#include <boost/any.hpp>"));
}

}  // namespace

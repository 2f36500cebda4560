/// The pages of docs/ against the code: what they name must exist, what is cited must be in references.bib, and what is
/// generated must be what the code would generate now.
#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/render/settings_page.h>

#include "../support/files.h"

namespace pellucid {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot(PELLUCID_SOURCE_DIR);

std::string read(const fs::path& file) { return test::bytesOf(file); }

std::vector<fs::path> filesUnder(const std::vector<std::string>& folders, const std::set<std::string>& extensions) {
    std::vector<fs::path> files;
    for (const std::string& folder : folders)
        for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder))
            if (entry.is_regular_file() && extensions.contains(entry.path().extension().string()))
                files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
    std::vector<std::string> found;
    for (auto at = std::sregex_iterator(text.begin(), text.end(), pattern); at != std::sregex_iterator(); ++at)
        found.push_back((*at)[1].str());
    return found;
}

std::set<std::string> words(const std::string& text) {
    std::set<std::string> result;
    std::string word;
    for (const char c : text + " ") {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_')
            word += c;
        else if (!word.empty())
            result.insert(std::exchange(word, {}));
    }
    return result;
}

/// Name and year in brackets, then maybe a tag in small letters, then the bracket or a place in the work.
std::vector<std::string> citedKeys(const std::string& text) {
    static const std::regex citation(R"(\[([A-Z][A-Za-z]+[12][0-9]{3}[a-z0-9]*)(?=[\],;]))");
    return matches(text, citation);
}

TEST(Docs, EveryCitedKeyIsInTheBibliography) {
    const std::vector<std::string> entries =
        matches(read(kRoot / "docs/references.bib"), std::regex(R"(@[a-z]+\{([A-Za-z0-9]+),)"));
    const std::set<std::string> known(entries.begin(), entries.end());
    EXPECT_EQ(known.size(), entries.size()) << "a key stands twice";
    std::set<std::string> cited;
    for (const fs::path& file : filesUnder({"src", "include", "tests", "scenes", "docs"}, {".h", ".cpp", ".md"}))
        for (const std::string& key : citedKeys(read(file))) {
            cited.insert(key);
            EXPECT_TRUE(known.contains(key)) << key << " in " << file.lexically_relative(kRoot);
        }
    EXPECT_GT(cited.size(), 20U) << "the pattern finds no citations any more";
    for (const std::string& key : known) EXPECT_TRUE(cited.contains(key)) << key << " is cited nowhere";
}

/// `path/file` in code quotes, if it has a folder and an extension.
void expectFilesExist(const fs::path& page) {
    static const std::regex quoted(R"(`((?:src|include|tests|docs|scenes|cmake)/[A-Za-z0-9_./-]*\.[a-z]+)`)");
    for (const std::string& name : matches(read(page), quoted))
        EXPECT_TRUE(fs::exists(kRoot / name)) << page.filename() << " names " << name;
}

/// `name()` and `Type::name()` in code quotes: one file must hold all the words.
void expectFunctionsExist(const fs::path& page, const std::vector<std::set<std::string>>& sources) {
    static const std::regex quoted(R"(`([A-Za-z_][A-Za-z0-9_:]*)\(\)`)");
    for (const std::string& name : matches(read(page), quoted)) {
        const std::set<std::string> parts = words(name);
        const bool found = std::ranges::any_of(sources, [&](const std::set<std::string>& source) {
            return std::ranges::all_of(parts, [&](const std::string& part) { return source.contains(part); });
        });
        EXPECT_TRUE(found) << page.filename() << " names " << name << "()";
    }
}

void expectLinksExist(const fs::path& page) {
    static const std::regex link(R"(\]\(([^)#:]+)(?:#[^)]*)?\))");
    for (const std::string& target : matches(read(page), link))
        EXPECT_TRUE(fs::exists(page.parent_path() / target)) << page.filename() << " links to " << target;
}

TEST(Docs, WhatThePagesNameExists) {
    std::vector<std::set<std::string>> sources;
    for (const fs::path& file : filesUnder({"src", "include"}, {".h", ".cpp"})) sources.push_back(words(read(file)));
    std::vector<fs::path> pages = filesUnder({"docs", "scenes"}, {".md"});
    pages.push_back(kRoot / "README.md");
    for (const fs::path& page : pages) {
        expectFilesExist(page);
        expectFunctionsExist(page, sources);
        expectLinksExist(page);
    }
}

TEST(Docs, TheOptionsPageIsFresh) {
    EXPECT_EQ(read(kRoot / "docs/options.md"), settingsMarkdown()) << "docs/options.md is stale: ./run docs";
}

}  // namespace
}  // namespace pellucid

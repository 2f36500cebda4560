#include <pellucid/io/settings_file.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <optional>

#include <toml++/toml.h>

#include <pellucid/base/error.h>

namespace pellucid {
namespace {

std::string place(const std::filesystem::path& file, int line) {
    return file.string() + ", line " + std::to_string(line);
}

std::optional<std::string> valueText(const toml::node& node) {
    if (const auto* word = node.as_string()) return word->get();
    if (const auto* whole = node.as_integer()) return std::to_string(whole->get());
    if (const auto* truth = node.as_boolean()) return truth->get() ? "on" : "off";
    if (const auto* number = node.as_floating_point()) {
        std::array<char, 32> text{};
        const auto end = std::to_chars(text.data(), text.data() + text.size(), number->get()).ptr;
        return std::string(text.data(), end);
    }
    return std::nullopt;
}

void flatten(const toml::table& table, const std::string& prefix, const std::filesystem::path& file,
             std::vector<SettingsFileEntry>& entries) {
    for (const auto& [name, node] : table) {
        const std::string key = prefix + std::string(name.str());
        if (const auto* inner = node.as_table()) {
            flatten(*inner, key + ".", file, entries);
            continue;
        }
        const int line = static_cast<int>(node.source().begin.line);
        std::optional<std::string> value = valueText(node);
        if (!value)
            throw Error(ErrorKind::BadInput, "'" + key + "' is no single value", place(file, line),
                        "give a number or a word in quotes");
        entries.push_back({key, std::move(*value), line});
    }
}

}  // namespace

std::vector<SettingsFileEntry> readSettingsFile(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::error_code ignored;
    if (!stream || std::filesystem::is_directory(file, ignored))
        throw Error(ErrorKind::BadInput, "cannot read the settings", file.string(), "name a TOML file that exists");
    std::vector<SettingsFileEntry> entries;
    try {
        flatten(toml::parse(stream, file.string()), "", file, entries);
    } catch (const toml::parse_error& error) {
        throw Error(ErrorKind::BadInput, "this is not TOML: " + std::string(error.description()),
                    place(file, static_cast<int>(error.source().begin.line)), "write lines such as cache.error = 0.2");
    }
    std::stable_sort(entries.begin(), entries.end(),
                     [](const SettingsFileEntry& a, const SettingsFileEntry& b) { return a.line < b.line; });
    return entries;
}

}  // namespace pellucid

/// A TOML file as a flat list of dotted keys. The only room that sees toml++; what the keys mean is the reader's affair
/// (render/settings.h).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pellucid {

struct SettingsFileEntry {
    std::string key;    ///< with its tables: "cache.error" for `error` in `[cache]`
    std::string value;  ///< words as they are, numbers in their shortest form, true and false as "on" and "off"
    int line = 0;
};

/// The entries in the order of the file. Throws Error{BadInput} with file and line when the file is missing, is no TOML
/// or holds a value that is no word, number or truth value.
[[nodiscard]] std::vector<SettingsFileEntry> readSettingsFile(const std::filesystem::path& file);

}  // namespace pellucid

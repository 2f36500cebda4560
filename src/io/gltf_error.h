/// One way to say what is wrong in a glTF file, and the list of what is only worth a warning.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <pellucid/base/error.h>
#include <pellucid/base/log.h>

namespace pellucid {

/// `path` is the place in the JSON, such as meshes[2].primitives[0].indices; empty: the file as a whole.
[[noreturn]] inline void badGltf(const std::string& file, const std::string& path, const std::string& what,
                                 const std::string& mend) {
    throw Error(ErrorKind::BadInput, what, path.empty() ? file : file + ": " + path, mend);
}

[[nodiscard]] inline std::string element(const std::string& array, std::size_t index) {
    return array + "[" + std::to_string(index) + "]";
}

/// Warnings go to the log and into the description, each text once.
class GltfNotes {
public:
    explicit GltfNotes(LogSink log) : log_(std::move(log)) {}

    void warn(const std::string& text) {
        if (seen_.size() > kMost || !seen_.insert(text).second) return;
        warnings_.push_back(seen_.size() > kMost ? "further warnings about this file are left out" : text);
        logTo(log_, LogLevel::Warning, warnings_.back());
    }
    void note(const std::string& text) const { logTo(log_, LogLevel::Info, text); }

    [[nodiscard]] std::vector<std::string> takeWarnings() { return std::move(warnings_); }

private:
    static constexpr std::size_t kMost = 200;
    LogSink log_;
    std::set<std::string> seen_;
    std::vector<std::string> warnings_;
};

}  // namespace pellucid

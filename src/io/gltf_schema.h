/// What glTF 2.0 and the extensions that we know allow in the JSON, as a table: which members an object may have, of
/// which kind, which are required, and which array an index points into. gltf_json.cpp holds a file against it.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace pellucid {

enum class RuleKind : std::uint8_t {
    Integer,
    Number,
    Boolean,
    String,
    Numbers,
    Strings,  ///< arrays
    Object,
    Objects,  ///< one, or an array of them, with `members`
    Reference,
    References,  ///< an index into `target`, or an array of indices
    ReferenceMap,
    ReferenceMaps  ///< an object whose values are indices into `target`, or an array of such objects
};

struct Rule {
    const char* key = "";
    RuleKind kind = RuleKind::Integer;
    bool required = false;
    double low = -std::numeric_limits<double>::infinity();  ///< of the number, or of the array's length
    double high = std::numeric_limits<double>::infinity();
    const char* target = "";  ///< references: a JSON pointer from the root. Others: the allowed values, between bars
    std::span<const Rule> members = {};
};

/// Members of the root object.
[[nodiscard]] std::span<const Rule> gltfRules() noexcept;

/// Extensions that the loader reads, or knows to be harmless when left out (unlit shading).
[[nodiscard]] bool isKnownExtension(std::string_view name) noexcept;

}  // namespace pellucid

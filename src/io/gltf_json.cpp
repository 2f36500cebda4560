#include "gltf_json.h"

#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "gltf_error.h"
#include "gltf_schema.h"

namespace pellucid {
namespace {

using Json = nlohmann::json;

constexpr int kMaxDepth = 64;                       // glTF needs about ten; tinygltf and we walk extensions recursively
constexpr double kMaxInteger = 9007199254740992.0;  // 2^53

[[nodiscard]] std::string member(const std::string& path, std::string_view key) {
    return path.empty() ? std::string(key) : path + "." + std::string(key);
}

/// Holds one document against the rules; on the way integers written as 1.0 become integers and other numbers doubles.
class SchemaCheck {
public:
    SchemaCheck(Json& root, const std::string& file) : root_(root), file_(file) {}

    void checkObject(Json& object, std::span<const Rule> rules, const std::string& path) const {
        if (!object.is_object()) bad(path, "this must be an object");
        for (const Rule& rule : rules) {
            const auto found = object.find(rule.key);
            if (found != object.end())
                check(*found, rule, member(path, rule.key));
            else if (rule.required)
                bad(path, "'" + std::string(rule.key) + "' is missing");
        }
    }

private:
    [[noreturn]] void bad(const std::string& path, const std::string& what) const {
        badGltf(file_, path, what, "export the file again or correct it by the glTF 2.0 schema");
    }

    void check(Json& value, const Rule& rule, const std::string& path) const {
        switch (rule.kind) {
            case RuleKind::Integer:
                return checkInteger(value, rule, path);
            case RuleKind::Number:
                return checkNumber(value, rule, path);
            case RuleKind::Boolean:
                if (!value.is_boolean()) bad(path, "this must be true or false");
                return;
            case RuleKind::String:
                return checkString(value, rule, path);
            case RuleKind::Object:
                return checkObject(value, rule.members, path);
            case RuleKind::Reference:
                return checkReference(value, rule, path);
            case RuleKind::ReferenceMap:
                return checkReferenceMap(value, rule, path);
            case RuleKind::Numbers:
            case RuleKind::Strings:
            case RuleKind::Objects:
            case RuleKind::References:
            case RuleKind::ReferenceMaps:
                return checkArray(value, rule, path);
        }
    }

    void checkArray(Json& value, const Rule& rule, const std::string& path) const {
        if (!value.is_array()) bad(path, "this must be an array");
        const auto size = static_cast<double>(value.size());
        if (size < rule.low || size > rule.high)
            bad(path, "an array of " + std::to_string(value.size()) + " values has the wrong length");
        Rule one = rule;
        one.low = -std::numeric_limits<double>::infinity();
        one.high = std::numeric_limits<double>::infinity();
        one.kind = elementKind(rule.kind);
        for (std::size_t i = 0; i < value.size(); ++i) check(value[i], one, element(path, i));
    }

    [[nodiscard]] static RuleKind elementKind(RuleKind array) {
        switch (array) {
            case RuleKind::Numbers:
                return RuleKind::Number;
            case RuleKind::Strings:
                return RuleKind::String;
            case RuleKind::Objects:
                return RuleKind::Object;
            case RuleKind::References:
                return RuleKind::Reference;
            default:
                return RuleKind::ReferenceMap;
        }
    }

    void checkInteger(Json& value, const Rule& rule, const std::string& path) const {
        const double number = value.is_number() ? value.get<double>() : -1.0;
        if (!(number >= 0.0) || number > kMaxInteger || std::floor(number) != number)
            bad(path, "this must be an integer of 0 or more");
        if (number < rule.low || number > rule.high) bad(path, "the value " + value.dump() + " is out of range");
        value = static_cast<std::uint64_t>(number);
        checkChoice(value.dump(), rule, path);
    }

    void checkNumber(Json& value, const Rule& rule, const std::string& path) const {
        if (!value.is_number()) bad(path, "this must be a number");
        const auto number = value.get<double>();
        if (!std::isfinite(number) || number < rule.low || number > rule.high)
            bad(path, "the value " + value.dump() + " is out of range");
        value = number;
    }

    void checkString(const Json& value, const Rule& rule, const std::string& path) const {
        if (!value.is_string()) bad(path, "this must be a string");
        checkChoice(value.get_ref<const std::string&>(), rule, path);
    }

    void checkChoice(const std::string& value, const Rule& rule, const std::string& path) const {
        std::string_view choices = rule.target;
        if (choices.empty()) return;
        for (;;) {
            const std::size_t bar = choices.find('|');
            if (choices.substr(0, bar) == value) return;
            if (bar == std::string_view::npos) break;
            choices.remove_prefix(bar + 1);
        }
        bad(path, "the value '" + value + "' is none of " + rule.target);
    }

    void checkReference(Json& value, const Rule& rule, const std::string& path) const {
        checkInteger(value, {.key = rule.key}, path);
        const Json::json_pointer pointer(rule.target);
        const std::size_t count = root_.contains(pointer) && root_[pointer].is_array() ? root_[pointer].size() : 0;
        if (value.get<std::uint64_t>() >= count)
            bad(path, "index " + value.dump() + " is past the end: there are " + std::to_string(count) + " " +
                          (rule.target + 1));
    }

    void checkReferenceMap(Json& value, const Rule& rule, const std::string& path) const {
        if (!value.is_object()) bad(path, "this must be an object");
        for (auto& item : value.items()) checkReference(item.value(), rule, member(path, item.key()));
    }

    Json& root_;
    const std::string& file_;
};

[[nodiscard]] Json parse(std::string_view text, const std::string& file) {
    while (text.ends_with('\0')) text.remove_suffix(1);  // some writers pad the chunk with zeros
    const auto limitDepth = [&file](int depth, Json::parse_event_t, Json&) {
        if (depth > kMaxDepth) badGltf(file, "", "the JSON is nested too deeply", "flatten its extras or extensions");
        return true;
    };
    try {
        Json root = Json::parse(text.begin(), text.end(), limitDepth);
        if (!root.is_object()) badGltf(file, "", "the JSON is no object", "name a glTF 2.0 file");
        return root;
    } catch (const Json::exception& e) {
        std::string reason = e.what();
        if (const auto colon = reason.find("] "); colon != std::string::npos) reason = reason.substr(colon + 2);
        badGltf(file, "", "this is no glTF: " + reason, "name a .gltf or .glb file that is whole");
    }
}

/// glTF 2.0 section 3.2: the major version must be ours, and minVersion, if there is one, not newer.
void checkVersion(const Json& asset, const std::string& file) {
    const std::string version = asset.value("version", std::string()), least = asset.value("minVersion", std::string());
    if (!version.starts_with("2.") || version.size() < 3)
        badGltf(file, "asset.version", "version '" + version + "' is not 2.x", "convert the file to glTF 2.0");
    if (!least.empty() && least != "2.0")
        badGltf(file, "asset.minVersion", "the file asks for glTF " + least, "export it as glTF 2.0");
}

/// Takes out extras and unknown extensions everywhere, and notes the names of all extensions.
void prune(Json& value, std::set<std::string>& extensions) {
    if (value.is_object()) {
        value.erase("extras");
        if (const auto found = value.find("extensions"); found != value.end() && found->is_object()) {
            for (auto it = found->begin(); it != found->end();) {
                extensions.insert(it.key());
                it = isKnownExtension(it.key()) ? std::next(it) : found->erase(it);
            }
        }
    }
    if (value.is_structured())
        for (auto& part : value) prune(part, extensions);
}

/// What the table cannot say.
void checkRelations(const Json& root, const std::string& file) {
    const Json none = Json::array();
    const auto each = [&](const char* pointer, const auto& visit) {
        const Json& array = root.contains(Json::json_pointer(pointer)) ? root[Json::json_pointer(pointer)] : none;
        for (std::size_t i = 0; i < array.size(); ++i) visit(array[i], element(pointer + 1, i));
    };
    each("/cameras", [&](const Json& camera, const std::string& path) {
        const std::string type = camera["type"];
        if (!camera.contains(type)) badGltf(file, path, "'" + type + "' is missing", "export the camera again");
    });
    each("/extensions/KHR_lights_punctual/lights", [&](const Json& light, const std::string& path) {
        if (light["type"] == "spot" && !light.contains("spot"))
            badGltf(file, path, "'spot' is missing", "export the light again");
    });
    each("/bufferViews", [&](const Json& view, const std::string& path) {
        if (view.value("byteStride", std::uint64_t{4}) % 4 != 0)
            badGltf(file, path + ".byteStride", "the stride is no multiple of 4", "export the file again");
    });
}

[[nodiscard]] std::vector<std::string> strings(const Json& root, const char* key) {
    return root.value(key, std::vector<std::string>());
}

void takeSources(Json& root, GltfJson& result) {
    for (const Json& buffer : root.value("buffers", Json::array()))
        result.buffers.push_back({buffer.value("uri", std::string()), buffer.contains("uri"), buffer["byteLength"]});
    for (const Json& image : root.value("images", Json::array()))
        result.images.push_back(
            {image.value("uri", std::string()), image.contains("uri"), image.value("bufferView", -1)});
    root.erase("buffers");
    root.erase("images");
}

void addZeroView(Json& root, GltfJson& result) {
    Json& views = root["bufferViews"];
    if (views.is_null()) views = Json::array();
    result.zeroView = static_cast<int>(views.size());
    views.push_back({{"buffer", result.buffers.size()}, {"byteLength", 1U}});
    if (!root.contains("accessors")) return;
    for (Json& accessor : root["accessors"])
        if (!accessor.contains("bufferView")) accessor["bufferView"] = result.zeroView;
}

}  // namespace

GltfJson readGltfJson(std::string_view text, const std::string& file) {
    Json root = parse(text, file);
    GltfJson result;
    result.hasAnimations = root.contains("animations");
    root.erase("animations");
    std::set<std::string> extensions;
    prune(root, extensions);
    SchemaCheck(root, file).checkObject(root, gltfRules(), "");
    checkVersion(root["asset"], file);
    checkRelations(root, file);

    for (std::string& name : strings(root, "extensionsUsed")) extensions.insert(std::move(name));
    result.extensionsRequired = strings(root, "extensionsRequired");
    extensions.insert(result.extensionsRequired.begin(), result.extensionsRequired.end());
    result.extensionsUsed.assign(extensions.begin(), extensions.end());
    takeSources(root, result);
    addZeroView(root, result);
    result.text = root.dump();
    return result;
}

}  // namespace pellucid

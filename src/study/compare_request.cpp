// The small grammar of --methods and --times.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <pellucid/base/error.h>
#include <pellucid/base/nearest_name.h>
#include <pellucid/study/compare.h>
#include <pellucid/study/record_json.h>

namespace pellucid {
namespace {

constexpr std::array kMethods{Method::Photon,    Method::Path, Method::Light,
                              Method::Reference, Method::Bdpt, Method::Sppm};

[[nodiscard]] std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts{""};
    for (const char c : text) {
        if (c == separator)
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

/// KEY=VALUE parts between plus signs; a plus sign inside of a number (1e+3) stays.
[[nodiscard]] std::vector<std::string> splitSettings(const std::string& text) {
    std::vector<std::string> settings;
    for (const std::string& part : split(text, '+')) {
        if (part.find('=') == std::string::npos && !settings.empty())
            settings.back() += "+" + part;
        else
            settings.push_back(part);
    }
    return settings;
}

[[nodiscard]] Method methodNamed(const std::string& name) {
    std::vector<std::string> names;
    for (const Method method : kMethods) {
        names.push_back(methodName(method));
        if (names.back() == name) return method;
    }
    const std::vector<std::string_view> candidates(names.begin(), names.end());
    throw Error(ErrorKind::Usage, "there is no method '" + name + "'", "--methods",
                "the nearest name is '" + std::string(nearestName(name, candidates)) + "'");
}

}  // namespace

std::vector<CompareMethod> parseMethods(const std::string& text, const Settings& common) {
    std::vector<CompareMethod> methods;
    for (const std::string& label : split(text, ',')) {
        const std::size_t colon = label.find(':');
        CompareMethod method{label, methodNamed(label.substr(0, colon)), common};
        if (colon != std::string::npos)
            for (const std::string& setting : splitSettings(label.substr(colon + 1))) {
                const std::size_t equals = setting.find('=');
                if (equals == std::string::npos)
                    throw Error(ErrorKind::Usage, "'" + setting + "' is no setting", "--methods " + label,
                                "write METHOD:KEY=VALUE+KEY=VALUE");
                setParameter(method.settings, setting.substr(0, equals), setting.substr(equals + 1));
            }
        for (const CompareMethod& other : methods)
            if (other.method == method.method && settingsAsText(other.settings) == settingsAsText(method.settings))
                throw Error(ErrorKind::Usage, "'" + label + "' is '" + other.label + "' again", "--methods",
                            "name each method once");
        methods.push_back(std::move(method));
    }
    return methods;
}

std::vector<double> parseTimes(const std::string& text) {
    std::vector<double> times;
    for (const std::string& part : split(text, ',')) {
        double value = 0.0;
        const auto [end, status] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (status != std::errc{} || end != part.data() + part.size() || !std::isfinite(value) || !(value > 0.0))
            throw Error(ErrorKind::Usage, "'" + part + "' is no time", "--times",
                        "give seconds above 0, such as --times 1,2,4");
        times.push_back(value);
    }
    std::ranges::sort(times);
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

}  // namespace pellucid

/// Pieces of JSON that the study's files share, as templates over the JSON type: nlohmann's headers stay in the .cpp files.
#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <pellucid/render/render.h>
#include <pellucid/study/metrics.h>
#include <pellucid/study/statistics.h>

namespace pellucid {

/// Null where the value is not finite.
template <class Json>
[[nodiscard]] Json numberAs(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

template <class Json>
[[nodiscard]] Json intervalAs(const Interval& interval) {
    return {{"value", numberAs<Json>(interval.value)},
            {"low", numberAs<Json>(interval.low)},
            {"high", numberAs<Json>(interval.high)}};
}

/// The names of `diff --json`.
template <class Json>
[[nodiscard]] Json metricsAs(const Metrics& m) {
    return {{"rmse", numberAs<Json>(m.rmse)},
            {"relmse", numberAs<Json>(m.relmse)},
            {"relmse_trimmed", numberAs<Json>(m.relmseTrimmed)},
            {"smape", numberAs<Json>(m.smape)},
            {"flip", numberAs<Json>(m.flip)},
            {"bias", numberAs<Json>(m.bias)},
            {"nonfinite", m.nonfinite}};
}

template <class Json>
[[nodiscard]] Json stagesAs(const std::vector<StageRecord>& stages) {
    Json json = Json::array();
    for (const StageRecord& s : stages)
        json.push_back({{"name", s.name},
                        {"seconds", s.seconds},
                        {"rays", s.rays},
                        {"photons_emitted", s.photonsEmitted},
                        {"photons_stored", s.photonsStored},
                        {"records", s.records}});
    return json;
}

template <class Json>
[[nodiscard]] Json decisionsAs(const std::vector<Decision>& decisions) {
    Json json = Json::array();
    for (const Decision& d : decisions)
        json.push_back({{"name", d.name}, {"choice", d.choice}, {"reason", d.reason}, {"overridden", d.overridden}});
    return json;
}

/// What `read` makes of the JSON in a file that this program keeps for itself; `fresh` where there is no such file, or it is
/// damaged, or its "key" says that it was made from something else: it is then made anew.
template <class Json, class Value, class Read>
[[nodiscard]] Value readKeyed(const std::filesystem::path& file, const std::string& key, Value fresh,
                              const Read& read) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return fresh;
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const Json json = Json::parse(text, nullptr, false);
    try {
        if (json.is_discarded() || json.at("key").template get<std::string>() != key) return fresh;
        return read(json);
    } catch (const typename Json::exception&) {
        return fresh;
    }
}

/// Text with a final newline; bytes from files that are no UTF-8 are replaced.
template <class Json>
[[nodiscard]] std::string dumped(const Json& json, int indent = 2) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace pellucid

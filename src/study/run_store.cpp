#include "run_store.h"

#include <bit>
#include <cctype>
#include <cstdio>
#include <limits>

#include <nlohmann/json.hpp>

#include <pellucid/base/error.h>
#include <pellucid/io/image_file.h>
#include <pellucid/io/plain_file.h>
#include <pellucid/math/hash.h>
#include <pellucid/study/text_table.h>

#include "study_json.h"

namespace pellucid {
namespace {

using Json = nlohmann::ordered_json;

[[nodiscard]] std::string hex(std::uint64_t value) {
    char text[20];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
    return text;
}

[[nodiscard]] Json metricsJson(const RunMetrics& metrics) {
    Json json = metricsAs<Json>(metrics.whole);
    json["reference_hash"] = metrics.referenceHash;
    for (const auto& [name, value] : metrics.classRelmse) json["classes"][name] = numberAs<Json>(value);
    return json;
}

/// A figure that was not finite is stored as null: it comes back as infinite, never as "no error".
[[nodiscard]] double numberOrInfinity(const Json& json) {
    return json.is_number() ? json.get<double>() : std::numeric_limits<double>::infinity();
}

[[nodiscard]] RunMetrics metricsFrom(const Json& json) {
    RunMetrics metrics;
    metrics.referenceHash = json.at("reference_hash").get<std::string>();
    metrics.whole = {numberOrInfinity(json.at("rmse")),           numberOrInfinity(json.at("relmse")),
                     numberOrInfinity(json.at("relmse_trimmed")), numberOrInfinity(json.at("smape")),
                     numberOrInfinity(json.at("flip")),           numberOrInfinity(json.at("bias")),
                     json.at("nonfinite").get<std::size_t>()};
    if (json.contains("classes"))
        for (const auto& [name, value] : json.at("classes").items())
            metrics.classRelmse[name] = numberOrInfinity(value);
    return metrics;
}

[[nodiscard]] Json runJson(const StoredRun& run) {
    Json json{{"key", run.key.text},
              {"method", run.key.label},
              {"budget", run.key.budget},
              {"seed", run.key.seed},
              {"image", run.image.generic_string()},
              {"image_hash", run.imageHash},
              {"seconds", run.seconds},
              {"error_estimate", numberAs<Json>(run.errorEstimate)},
              {"iterations", run.iterations},
              {"samples_per_pixel", run.samplesPerPixel},
              {"peak_rss_bytes", run.peakRssBytes},
              {"nonfinite", run.nonfinite},
              {"threads", run.threads},
              {"blind_spots", run.blindSpots},
              {"stages", stagesAs<Json>(run.stages)},
              {"plan", decisionsAs<Json>(run.decisions)},
              {"settings", Json::object()}};
    for (const auto& [name, value] : run.resolved) json["settings"][name] = value;
    if (run.metrics) json["metrics"] = metricsJson(*run.metrics);
    return json;
}

[[nodiscard]] StoredRun runFrom(const Json& json, const RunKey& key) {
    StoredRun run;
    run.key = key;
    run.image = json.at("image").get<std::string>();
    run.imageHash = json.at("image_hash").get<std::string>();
    run.seconds = json.at("seconds").get<double>();
    run.errorEstimate = numberOrInfinity(json.at("error_estimate"));
    run.iterations = json.at("iterations").get<std::uint32_t>();
    run.samplesPerPixel = json.at("samples_per_pixel").get<std::uint32_t>();
    run.peakRssBytes = json.at("peak_rss_bytes").get<std::uint64_t>();
    run.nonfinite = json.at("nonfinite").get<std::uint64_t>();
    run.threads = json.at("threads").get<int>();
    run.blindSpots = json.at("blind_spots").get<std::vector<std::string>>();
    for (const Json& s : json.at("stages"))
        run.stages.push_back({s.at("name"), s.at("seconds"), s.at("rays"), s.at("photons_emitted"),
                              s.at("photons_stored"), s.at("records")});
    for (const Json& d : json.at("plan"))
        run.decisions.push_back({d.at("name"), d.at("choice"), d.at("reason"), d.at("overridden").get<bool>()});
    for (const auto& [name, value] : json.at("settings").items()) run.resolved.emplace_back(name, value);
    if (json.contains("metrics")) run.metrics = metricsFrom(json.at("metrics"));
    return run;
}

}  // namespace

std::string hashText(std::string_view text) {
    std::uint64_t hash = text.size();
    for (const char c : text) hash = hashCombine(hash, static_cast<unsigned char>(c));
    return hex(hash);
}

std::string imageHash(const Image& image) {
    std::uint64_t hash =
        hashCombine(static_cast<std::uint64_t>(image.width()), static_cast<std::uint64_t>(image.height()));
    for (const float value : image.data()) hash = hashCombine(hash, std::bit_cast<std::uint32_t>(value));
    return hex(hash);
}

namespace {

[[nodiscard]] std::string readableName(const std::string& label) {
    std::string readable;
    for (const char c : label)
        if (readable.size() < 40)
            readable += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' ? c : '_';
    return readable;
}

}  // namespace

std::string RunKey::name() const {
    return readableName(label) + "_" + figure(budget) + "s_" + std::to_string(seed) + "_" + hashText(text).substr(0, 8);
}

std::string RunKey::series() const {
    return readableName(label) + "_" + figure(budget) + "s_" + hashText(label).substr(0, 8);
}

RunStore::RunStore(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::error_code status;
    std::filesystem::create_directories(folder_ / "runs", status);
    if (status)
        throw Error(ErrorKind::CannotFinish, "cannot make the folder: " + status.message(), folder_.string(),
                    "give -o a folder that can be written");
    checkFolderWritable(folder_ / "runs" / "probe.json");
}

std::optional<StoredRun> RunStore::find(const RunKey& key) const {
    // A record of another version is not read: the run is done again.
    return readKeyed<Json>(folder_ / "runs" / (key.name() + ".json"), key.text, std::optional<StoredRun>(),
                           [&](const Json& json) -> std::optional<StoredRun> {
                               StoredRun run = runFrom(json, key);
                               if (!std::filesystem::exists(folder_ / run.image)) return std::nullopt;
                               return run;
                           });
}

void RunStore::save(StoredRun& run, const Image& image, const std::map<std::string, std::string>& metadata) const {
    run.image = std::filesystem::path("runs") / (run.key.name() + ".exr");
    run.imageHash = imageHash(image);
    writeExr(folder_ / run.image, image, metadata);
    saveRecord(run);
}

void RunStore::saveRecord(const StoredRun& run) const {
    writeFile(folder_ / "runs" / (run.key.name() + ".json"), dumped(runJson(run)));
}

Image RunStore::readImage(const StoredRun& run) const { return pellucid::readImage(folder_ / run.image); }

}  // namespace pellucid

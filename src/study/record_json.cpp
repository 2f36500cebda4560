#include <pellucid/study/record_json.h>

#include <nlohmann/json.hpp>

#include <pellucid/render/caustic_links.h>
#include <pellucid/study/text_table.h>

#include "study_json.h"

namespace pellucid {
namespace {

using Json = nlohmann::ordered_json;

[[nodiscard]] Json settingsJson(const Settings& settings) {
    Json json = Json::object();
    for (const Parameter& row : parameters())
        json[std::string(row.name)] =
            std::visit([&settings](auto member) { return Json(settings.*member); }, row.member);
    return json;
}

/// Rows of "caustics" in JSON, and in the plan's table: the rest is summed.
constexpr std::size_t kMostLinks = 256, kMostLinkRows = 12;

[[nodiscard]] Json linksJson(const std::vector<CausticLink>& links) {
    Json json = Json::array();
    for (const CausticLink& l : shortened(links, kMostLinks)) {
        json.push_back({{"lamp", l.lamp},
                        {"caster", l.caster},
                        {"emitted", l.emitted},
                        {"hit", l.hit},
                        {"deposited", l.deposited},
                        {"useful", l.useful},
                        {"reason", l.reason}});
        if (l.watched) json.back()["stored"] = l.stored, json.back()["used"] = l.used;
    }
    return json;
}

/// Watts; `residual` is the share of the emitted power that no sink accounts for: rounding, or a defect.
[[nodiscard]] Json energyJson(const EnergyBalance& e) {
    return {{"emitted", e.emitted},     {"escaped", e.escaped},   {"absorbed", e.absorbed}, {"stored", e.stored},
            {"left_to_others", e.left}, {"roulette", e.roulette}, {"dropped", e.dropped},   {"residual", e.residual()}};
}

[[nodiscard]] Json stagesJson(const std::vector<StageRecord>& stages) {
    Json json = stagesAs<Json>(stages);
    for (std::size_t i = 0; i < stages.size(); ++i)
        if (stages[i].photonPasses > 0) json[i]["energy"] = energyJson(stages[i].energy);
    return json;
}

/// What is known before as well as after a render.
[[nodiscard]] Json commonJson(const RenderRecord& record, const RecordContext& context) {
    Json json;
    json["version"] = context.version;
    json["scene"] = context.sceneFile;
    json["scene_hash"] = context.sceneHash;
    json["method"] = methodName(context.method);
    json["width"] = context.width;
    json["height"] = context.height;
    json["seed"] = context.seed;
    json["threads"] = record.threads;
    json["settings"] = settingsJson(record.resolved);
    json["plan"] = decisionsAs<Json>(record.decisions);
    json["caustics"] = linksJson(record.causticLinks);
    json["blind_spots"] = record.blindSpots;
    json["stages"] = stagesJson(record.stages);
    return json;
}

/// Text from files may hold any bytes: what is no UTF-8 is replaced.
[[nodiscard]] std::string dump(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

[[nodiscard]] std::string countText(std::uint64_t count) { return count == 0 ? "-" : std::to_string(count); }

/// Of the first iteration's photons.
[[nodiscard]] std::string usedText(const CausticLink& l) {
    return l.stored == 0 ? "-" : std::to_string(l.used) + " of " + std::to_string(l.stored);
}

/// "Why is there no caustic?"
[[nodiscard]] std::string linksText(const std::vector<CausticLink>& links) {
    TextTable table(
        {"lamp", "caster", "pilot paths", "hit it", "left photons", "in view", "used", "no caustic, because"});
    for (const CausticLink& l : shortened(links, kMostLinkRows))
        table.add({printable(l.lamp), printable(l.caster), countText(l.emitted), countText(l.hit),
                   countText(l.deposited), countText(l.useful), usedText(l), l.reason});
    return table.text();
}

}  // namespace

std::string methodName(Method method) {
    switch (method) {
        case Method::Photon:
            return "photon";
        case Method::Path:
            return "path";
        case Method::Light:
            return "light";
        case Method::Reference:
            return "reference";
        case Method::Bdpt:
            return "bdpt";
        case Method::Sppm:
            return "sppm";
    }
    return "photon";
}

std::string recordJson(const RenderRecord& record, const RecordContext& context) {
    Json json = commonJson(record, context);
    json["iterations"] = record.iterations;
    json["samples_per_pixel"] = record.samplesPerPixel;
    json["seconds"] = record.seconds;
    json["peak_rss_bytes"] = context.peakRssBytes;
    json["nonfinite"] = record.nonfinite.count;
    if (record.nonfinite.count > 0)
        json["nonfinite_first"] = {
            {"x", record.nonfinite.x}, {"y", record.nonfinite.y}, {"sample", record.nonfinite.sample}};
    json["error_estimate"] = record.errorEstimate;
    json["error_parts"] = {{"noise", record.noiseEstimate},
                           {"kernel_bias", record.blurEstimate},
                           {"record_noise", record.recordsEstimate}};
    if (record.texels.texels > 0)
        json["texel_reference"] = {{"texels", record.texels.texels},
                                   {"width_metres", record.texels.width},
                                   {"extrapolated", record.texels.extrapolated}};
    if (const ReuseReport& reuse = record.reuse; reuse.asked)
        json["cache_file"] = {{"records_reused", reuse.recordsReused},
                              {"records_new", reuse.recordsNew},
                              {"places_reused", reuse.placesReused},
                              {"places_new", reuse.placesNew}};
    json["interrupted"] = context.interrupted;
    json["images"] = context.images;
    return dump(json);
}

std::string planJson(const RenderRecord& plan, const RecordContext& context) { return dump(commonJson(plan, context)); }

std::string planText(const RenderRecord& plan, const RecordContext& context) {
    std::string text = context.sceneFile + ", " + std::to_string(context.width) + "x" + std::to_string(context.height) +
                       ", method " + methodName(context.method) + "\n\n";
    TextTable decisions({"decision", "choice", "reason"});
    for (const Decision& d : plan.decisions)
        decisions.add({d.name, d.overridden ? d.choice + " (set)" : d.choice, d.reason});
    text += decisions.text();
    if (!plan.causticLinks.empty()) text += "\n" + linksText(plan.causticLinks);
    if (!plan.stages.empty()) {
        TextTable stages({"pass", "seconds, one iteration", "photons", "records"});
        for (const StageRecord& s : plan.stages)
            stages.add({s.name, figure(s.seconds), countText(s.photonsEmitted), countText(s.records)});
        text += "\n" + stages.text();
    }
    for (const std::string& blind : plan.blindSpots) text += "\nblind spot: " + blind;
    return plan.blindSpots.empty() ? text : text + "\n";
}

}  // namespace pellucid

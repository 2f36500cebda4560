// report.html of a tuning: the page of src/study/report/tune.html, made whole at once so that it opens offline.
#include <algorithm>
#include <array>
#include <string_view>

#include <nlohmann/json.hpp>

#include <pellucid/io/image_file.h>
#include <pellucid/study/image_pair.h>

#include "report_parts.h"
#include "report_pixels.h"
#include "study_json.h"
#include "tune_files.h"

namespace pellucid {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kWidestPicture = 640;

/// Inside of <script> no "</script" and no "<!--" may stand; in JSON every "<" can be written as an escape.
[[nodiscard]] std::string scriptSafe(std::string_view json) {
    std::string text;
    for (const char c : json) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
    return text;
}

[[nodiscard]] std::string htmlSafe(std::string_view raw) {
    std::string text;
    for (const char c : raw) text += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
    return text;
}

void replaceMark(std::string& page, std::string_view mark, std::string_view text) {
    if (const std::size_t place = page.find(mark); place != std::string::npos) page.replace(place, mark.size(), text);
}

/// Half floats in base64, small enough for a page.
[[nodiscard]] Json pictureJson(const std::string& name, const Image& image) {
    const std::array<int, 3> channels = colourChannels(image);
    Image colour(image.width(), image.height(), {"R", "G", "B"});
    for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel)
        for (int c = 0; c < 3; ++c) colour.at(pixel, c) = image.at(pixel, channels[static_cast<std::size_t>(c)]);
    while (colour.width() > kWidestPicture) colour = halved(colour);
    return {{"name", name},
            {"width", colour.width()},
            {"height", colour.height()},
            {"halves", pixelsAsBase64(colour, 0, 3, PixelBytes::Half)}};
}

}  // namespace

std::string tuneReportHtml(const TuneFindings& findings, const std::string& frontJson) {
    Json data = Json::parse(frontJson);
    data["command"] = findings.request.command;
    data["pictures"] = Json::array();
    for (const Finalist& finalist : findings.front.finalists) {
        const std::filesystem::path file = findings.request.folder / "pictures" / (finalist.name + ".exr");
        if ((finalist.name == "default" || finalist.name == "tuned") && std::filesystem::exists(file))
            data["pictures"].push_back(pictureJson(finalist.name, readImage(file)));
    }
    data["pictures"].push_back(pictureJson("reference", findings.reference.mean));
    std::string page(report_parts::kTuneTemplate);
    replaceMark(page, "/*@STYLE@*/", report_parts::kStyle);
    replaceMark(page, "/*@D3@*/", report_parts::kD3);
    replaceMark(page, "/*@TUNE@*/", report_parts::kTune);
    const std::string title = htmlSafe(data["scene"].get<std::string>());
    replaceMark(page, "@TITLE@", title);
    replaceMark(page, "@TITLE@", title);
    replaceMark(page, "@DATA@", scriptSafe(dumped(data, -1)));  // last: no mark is looked for in what comes from files
    return page;
}

}  // namespace pellucid

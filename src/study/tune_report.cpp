// report.html of a tuning: the page of src/study/report/tune.html, made whole at once so that it opens offline.
#include <string_view>

#include <nlohmann/json.hpp>

#include <pellucid/io/image_file.h>

#include "html_page.h"
#include "report_parts.h"
#include "report_pixels.h"
#include "study_json.h"
#include "tune_files.h"

namespace pellucid {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kWidestPicture = 640;

/// Half floats in base64, small enough for a page.
[[nodiscard]] Json pictureJson(const std::string& name, const Image& image) {
    Image colour = colourOf(image);
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
    std::string page = reportPage(report_parts::kTuneTemplate, "tuning", "tuned settings");
    replaceMark(page, "/*@TUNE@*/", report_parts::kTune);
    const std::string title = htmlSafe(data["scene"].get<std::string>());
    replaceMark(page, "@TITLE@", title);
    replaceMark(page, "@DATA@", scriptSafe(dumped(data, -1)));  // last: no mark is looked for in what comes from files
    return page;
}

}  // namespace pellucid

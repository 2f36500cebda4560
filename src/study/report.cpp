#include <pellucid/study/report.h>

#include <algorithm>
#include <string_view>

#include <nlohmann/json.hpp>

#include "html_page.h"
#include "report_parts.h"
#include "report_pixels.h"
#include "study_json.h"

namespace pellucid {
namespace {

using Json = nlohmann::ordered_json;

/// What the page holds: maps are halves, and half the size where space is short.
struct Choice {
    PixelBytes bytes = PixelBytes::Full;
    std::size_t pictures = 0;
    bool small = false, smallMaps = false;
};

[[nodiscard]] std::size_t sizeOf(const ReportData& data, const Choice& choice) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < choice.pictures; ++i)
        size += base64Length(data.pictures[i].image.pixels() * 3, choice.bytes) / (choice.small ? 4 : 1);
    for (const ReportMap& map : data.maps)
        size += base64Length(map.image.pixels(), PixelBytes::Half) / (choice.smallMaps ? 4 : 1);
    return size;
}

/// Exact pixels come before more budgets; the first budget's pictures and the reference come before all.
[[nodiscard]] Choice choose(const ReportData& data, std::size_t space) {
    std::size_t needed = 0;  // the reference and one budget
    while (needed < data.pictures.size() &&
           (data.pictures[needed].budget == 0.0 || data.pictures[needed].budget == data.pictures[1].budget))
        ++needed;
    Choice choice;
    for (const bool small : {false, true})
        for (const PixelBytes bytes : {PixelBytes::Full, PixelBytes::Short, PixelBytes::Half})
            for (const bool smallMaps : {false, true}) {
                choice = {bytes, needed, small, smallMaps || small};
                if (sizeOf(data, choice) > space) continue;
                while (choice.pictures < data.pictures.size()) {
                    ++choice.pictures;
                    if (sizeOf(data, choice) <= space) continue;
                    --choice.pictures;
                    break;
                }
                return choice;
            }
    return choice;
}

/// One <script> that the browser does not run, and its row in the list of pictures.
class PixelWriter {
public:
    void add(Json row, const Image& image, int channels, PixelBytes bytes) {
        const std::string id = "pixels-" + std::to_string(list_.size());
        row.update({{"id", id},
                    {"width", image.width()},
                    {"height", image.height()},
                    {"channels", channels},
                    {"bytes", static_cast<int>(bytes)}});
        list_.push_back(std::move(row));
        scripts_ += "<script type=\"text/plain\" id=\"" + id + "\">" + pixelsAsBase64(image, 0, channels, bytes) +
                    "</script>\n";
    }
    [[nodiscard]] const Json& list() const noexcept { return list_; }
    [[nodiscard]] const std::string& scripts() const noexcept { return scripts_; }

private:
    Json list_ = Json::array();
    std::string scripts_;
};

[[nodiscard]] PixelWriter writePixels(const ReportData& data, const Choice& choice) {
    PixelWriter writer;
    for (std::size_t i = 0; i < choice.pictures; ++i) {
        const ReportPicture& picture = data.pictures[i];
        const Image colour = colourOf(picture.image);
        writer.add({{"kind", "picture"},
                    {"label", picture.label},
                    {"budget", picture.budget},
                    {"seed", picture.seed},
                    {"halved", choice.small}},
                   choice.small ? halved(colour) : colour, 3, choice.bytes);
    }
    for (const ReportMap& map : data.maps)
        writer.add({{"kind", map.kind}, {"label", map.label}, {"budget", map.budget}, {"halved", choice.smallMaps}},
                   choice.smallMaps ? halved(map.image) : map.image, 1, PixelBytes::Half);
    return writer;
}

}  // namespace

std::string reportHtml(const ReportData& data) {
    const std::string json = dumped(Json{{"title", data.title},
                                         {"summary", Json::parse(data.summaryJson)},
                                         {"curves", Json::parse(data.curvesJson)},
                                         {"runs", Json::parse(data.runsJson)}},
                                    -1);
    std::string page = reportPage(report_parts::kTemplate, "comparison", "error against run time");
    std::size_t fixed = page.size() + json.size();
    for (const std::string_view part : {report_parts::kCharts, report_parts::kViewer, report_parts::kTables})
        fixed += part.size();
    const PixelWriter pixels = writePixels(data, choose(data, kReportBytes - std::min(kReportBytes, fixed + 100'000)));
    // What comes from files goes in last: no mark is looked for in it.
    replaceMark(page, "/*@CHARTS@*/", report_parts::kCharts);
    replaceMark(page, "/*@VIEWER@*/", report_parts::kViewer);
    replaceMark(page, "/*@TABLES@*/", report_parts::kTables);
    replaceMark(page, "<!--@PIXELS@-->", pixels.scripts());
    replaceMark(page, "@PIXEL_LIST@", scriptSafe(pixels.list().dump(-1, ' ', false, Json::error_handler_t::replace)));
    replaceMark(page, "@DATA@", scriptSafe(json));
    replaceMark(page, "@TITLE@", htmlSafe(data.title));
    return page;
}

}  // namespace pellucid

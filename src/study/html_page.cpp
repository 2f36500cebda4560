#include "html_page.h"

#include "report_parts.h"

namespace pellucid {

std::string scriptSafe(std::string_view json) {
    std::string text;
    for (const char c : json) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
    return text;
}

std::string htmlSafe(std::string_view raw) {
    std::string text;
    for (const char c : raw) text += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
    return text;
}

void replaceMark(std::string& page, std::string_view mark, std::string_view text) {
    for (std::size_t place = page.find(mark); place != std::string::npos; place = page.find(mark, place + text.size()))
        page.replace(place, mark.size(), text);
}

std::string reportPage(std::string_view body, std::string_view kind, std::string_view about) {
    std::string page = std::string(report_parts::kHead) + std::string(body);
    replaceMark(page, "@KIND@", kind);
    replaceMark(page, "@ABOUT@", about);
    replaceMark(page, "/*@STYLE@*/", report_parts::kStyle);
    replaceMark(page, "/*@D3@*/", report_parts::kD3);
    return page;
}

}  // namespace pellucid

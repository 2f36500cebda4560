#include <pellucid/study/text_table.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string_view>
#include <utility>

namespace pellucid {
namespace {

/// Characters, not bytes, of UTF-8 text.
[[nodiscard]] std::size_t width(std::string_view text) noexcept {
    return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

[[nodiscard]] bool looksNumeric(std::string_view cell) noexcept {
    const std::size_t start = cell.starts_with('-') || cell.starts_with('+') ? 1 : 0;
    return cell.empty() || cell == "-" || cell.find("nan") <= start || cell.find("inf") <= start ||
           (start < cell.size() && cell[start] >= '0' && cell[start] <= '9');
}

}  // namespace

void TextTable::add(std::vector<std::string> row) {
    for (std::string& cell : row) cell = printable(std::move(cell));
    rows_.push_back(std::move(row));
}

std::string TextTable::text() const {
    const std::size_t columns = rows_.front().size();
    std::vector<std::size_t> widths(columns, 0);
    std::vector<bool> numeric(columns, true);
    for (const auto& row : rows_)
        for (std::size_t c = 0; c < std::min(columns, row.size()); ++c) {
            widths[c] = std::max(widths[c], width(row[c]));
            if (&row != &rows_.front() && !looksNumeric(row[c])) numeric[c] = false;
        }
    std::string text;
    const auto line = [&](const std::vector<std::string>& row) {
        std::string cells;
        for (std::size_t c = 0; c < columns; ++c) {
            const std::string cell = c < row.size() ? row[c] : "";
            const std::string space(widths[c] - width(cell), ' ');
            cells += (c == 0 ? "" : "  ") + (numeric[c] ? space + cell : cell + space);
        }
        text += cells.substr(0, cells.find_last_not_of(' ') + 1) + '\n';
    };
    line(rows_.front());
    std::vector<std::string> rule;
    for (const std::size_t w : widths) rule.emplace_back(w, '-');
    line(rule);
    for (std::size_t r = 1; r < rows_.size(); ++r) line(rows_[r]);
    return text;
}

std::string printable(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
    return text;
}

std::string figure(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

std::string duration(double seconds) {
    char text[64];
    if (!std::isfinite(seconds)) return "?";
    const double whole = std::round(seconds);
    const double hours = std::floor(whole / 3600.0), minutes = std::floor((whole - 3600.0 * hours) / 60.0);
    if (hours > 0.0)
        std::snprintf(text, sizeof text, "%.0f h %.0f min", hours, minutes);
    else if (minutes > 0.0)
        std::snprintf(text, sizeof text, "%.0f min %.0f s", minutes, whole - 60.0 * minutes);
    else
        std::snprintf(text, sizeof text, seconds < 10.0 ? "%.2f s" : "%.1f s", seconds);
    return text;
}

}  // namespace pellucid

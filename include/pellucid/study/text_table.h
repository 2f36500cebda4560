/// Rows of text in aligned columns for people; the same facts leave as JSON for programs.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pellucid {

class TextTable {
public:
    explicit TextTable(std::vector<std::string> header) : rows_{std::move(header)} {}

    /// Missing cells at the end are empty.
    void add(std::vector<std::string> row);
    [[nodiscard]] bool empty() const noexcept { return rows_.size() == 1; }

    /// The header, a rule and the rows; two blanks between columns, none at a line's end. Columns whose cells below the
    /// header all begin like numbers stand to the right.
    [[nodiscard]] std::string text() const;

private:
    std::vector<std::vector<std::string>> rows_;
};

/// Control characters become blanks: names from files may hold line breaks and terminal escapes.
[[nodiscard]] std::string printable(std::string text);
/// A figure for people: four significant digits.
[[nodiscard]] std::string figure(double value);
/// Seconds as "8.2 s", "3 min 20 s" or "2 h 5 min".
[[nodiscard]] std::string duration(double seconds);

}  // namespace pellucid

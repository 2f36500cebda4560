/// A page whose marks are replaced by styles, scripts and data, so that one file opens offline. What comes from files goes in
/// last: no mark is looked for in it.
#pragma once

#include <string>
#include <string_view>

namespace pellucid {

/// The head that all reports share, then `body`, with styles and D3. `kind`: of report; `about`: what follows the title.
[[nodiscard]] std::string reportPage(std::string_view body, std::string_view kind, std::string_view about);
/// For JSON inside of <script>, where no "</script" and no "<!--" may stand: every "<" becomes an escape.
[[nodiscard]] std::string scriptSafe(std::string_view json);
/// For text and attributes.
[[nodiscard]] std::string htmlSafe(std::string_view raw);
/// Puts `text` in place of every `mark`.
void replaceMark(std::string& page, std::string_view mark, std::string_view text);

}  // namespace pellucid

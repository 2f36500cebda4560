/// The project's one error type: bad input, an impossible request or a failed write is thrown as Error at the edge and
/// caught once in main, which prints `pellucid: error: WHAT (WHERE): MEND` and exits with the kind's status.
#pragma once

#include <exception>
#include <string>
#include <utility>

namespace pellucid {

/// The value is the exit status of the command.
enum class ErrorKind { Usage = 1, BadInput = 2, CannotFinish = 3, CheckFailed = 4 };

class Error : public std::exception {
public:
    Error(ErrorKind kind, std::string what, std::string where, std::string mend)
        : kind_(kind),
          what_(std::move(what)),
          where_(std::move(where)),
          mend_(std::move(mend)),
          message_(what_ + " (" + where_ + "): " + mend_) {}

    [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }
    [[nodiscard]] const char* what() const noexcept override { return message_.c_str(); }
    [[nodiscard]] const std::string& problem() const noexcept { return what_; }
    [[nodiscard]] const std::string& where() const noexcept { return where_; }
    [[nodiscard]] const std::string& mend() const noexcept { return mend_; }

private:
    ErrorKind kind_;
    std::string what_, where_, mend_, message_;
};

}  // namespace pellucid

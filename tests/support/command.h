/// The built command as a user runs it.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include <sys/wait.h>

#include <gtest/gtest.h>

#include "files.h"

namespace pellucid::test {

struct Outcome {
    int status = -1;  ///< -1: it was killed
    std::string out, err;
};

class CommandTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(PELLUCID_BINARY)) GTEST_SKIP() << "the command is not built";
    }

    /// Runs in a shell with the arguments as typed; `before` stands in front of the command. The folder holds what it
    /// prints, as `stdout` and `stderr`.
    [[nodiscard]] Outcome runCommand(const std::string& arguments, const std::string& before = "") const {
        const std::string command = before + " '" PELLUCID_BINARY "' " + arguments + " >'" +
                                    (folder_ / "stdout").string() + "' 2>'" + (folder_ / "stderr").string() +
                                    "' </dev/null";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytesOf(folder_ / "stdout"), bytesOf(folder_ / "stderr")};
    }

    TemporaryFolder folder_;
};

}  // namespace pellucid::test

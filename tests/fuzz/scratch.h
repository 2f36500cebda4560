/// What the fuzz targets share: a file to put the bytes in, for readers that take a file's name, and a requirement that
/// stays in release builds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace pellucid::fuzz {

inline void require(bool condition) {
    if (!condition) std::abort();
}

/// A file in a folder of this process, gone when the program ends.
class ScratchFile {
public:
    explicit ScratchFile(const std::string& name)
        : folder_(place() / ("pellucid-fuzz-" + std::to_string(getpid()))), file_(folder_ / name) {
        std::filesystem::create_directories(file_.parent_path());
    }
    ~ScratchFile() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;

    const std::filesystem::path& write(const void* data, std::size_t size) const {
        std::ofstream(file_, std::ios::binary)
            .write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
        return file_;
    }
    [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

private:
    /// In memory where that can be had: a disk would be all that is tested.
    [[nodiscard]] static std::filesystem::path place() {
        const std::filesystem::path memory("/dev/shm");
        return access(memory.c_str(), W_OK) == 0 ? memory : std::filesystem::temp_directory_path();
    }
    std::filesystem::path folder_, file_;
};

}  // namespace pellucid::fuzz

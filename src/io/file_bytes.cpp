#include "file_bytes.h"

#include <cstdint>
#include <fstream>
#include <system_error>

#include <pellucid/base/error.h>

namespace pellucid {

std::vector<std::byte> readFileBytes(const std::filesystem::path& file, const std::string& where) {
    std::error_code failure;
    const auto status = std::filesystem::status(file, failure);
    if (!std::filesystem::exists(status))
        throw Error(ErrorKind::BadInput, "file not found: " + file.string(), where, "check the name and the folder");
    if (!std::filesystem::is_regular_file(status))
        throw Error(ErrorKind::BadInput, "not a regular file: " + file.string(), where, "name a file, not a folder");
    const std::uintmax_t size = std::filesystem::file_size(file, failure);
    std::ifstream stream(file, std::ios::binary);
    if (failure || !stream)
        throw Error(ErrorKind::BadInput, "cannot open " + file.string(), where, "check the file's permissions");
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(stream.gcount()) != size)
        throw Error(ErrorKind::BadInput, "cannot read all of " + file.string(), where,
                    "check the disk or copy the file again");
    return bytes;
}

}  // namespace pellucid

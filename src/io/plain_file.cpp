#include <pellucid/io/plain_file.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include <unistd.h>

#include <pellucid/base/error.h>

namespace pellucid {
namespace {

/// Beside the file, so that renaming never crosses file systems.
[[nodiscard]] std::filesystem::path temporaryName(const std::filesystem::path& file) {
    std::filesystem::path name = file;
    name += "." + std::to_string(getpid()) + ".part";
    return name;
}

[[noreturn]] void cannotWrite(const std::filesystem::path& file, const std::string& reason) {
    throw Error(ErrorKind::CannotFinish, "cannot write: " + reason, file.string(),
                "name a file in a folder that exists, may be written and has space");
}

[[nodiscard]] std::array<int, 3> rgbChannels(const Image& image, const std::filesystem::path& file) {
    const std::array<int, 3> channels{image.channel("R"), image.channel("G"), image.channel("B")};
    for (const int c : channels)
        if (c < 0) cannotWrite(file, "the image has no channels R, G and B");
    return channels;
}

/// Shared exponent of the largest component (G. Ward, "Real Pixels", Graphics Gems II, 1991).
void appendRgbe(std::string& bytes, const Rgb& colour) {
    const auto usable = [](float v) { return std::isfinite(v) && v > 0.0F ? v : 0.0F; };
    const Rgb c{usable(colour.r), usable(colour.g), usable(colour.b)};
    int exponent = 0;
    const float largest = maxComponent(c);
    std::frexp(largest, &exponent);
    if (largest < 1e-32F) {
        bytes.append(4, '\0');
        return;
    }
    exponent = std::min(exponent, 127);
    for (int k = 0; k < 3; ++k) {
        const float mantissa = std::min(std::round(std::ldexp(c[k], 8 - exponent)), 255.0F);
        bytes.push_back(static_cast<char>(static_cast<unsigned char>(mantissa)));
    }
    bytes.push_back(static_cast<char>(static_cast<unsigned char>(exponent + 128)));
}

}  // namespace

void writeFile(const std::filesystem::path& file, std::string_view bytes) {
    const std::filesystem::path temporary = temporaryName(file);
    std::error_code failure;
    {
        std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
        stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        stream.close();
        if (!stream) {
            const std::string reason = std::strerror(errno);
            std::filesystem::remove(temporary, failure);
            cannotWrite(file, reason);
        }
    }
    std::filesystem::rename(temporary, file, failure);
    if (!failure) return;
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    cannotWrite(file, failure.message());
}

void checkFolderWritable(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored)) cannotWrite(file, "the folder does not exist");
    if (!file.has_filename() || std::filesystem::is_directory(file, ignored)) cannotWrite(file, "this is a folder");
    const std::filesystem::path probe = temporaryName(file);  // permissions alone do not tell of read-only disks
    const bool opened = std::ofstream(probe, std::ios::binary).good();
    const std::string reason = std::strerror(errno);
    std::filesystem::remove(probe, ignored);
    if (!opened) cannotWrite(file, reason);
}

void writePfm(const std::filesystem::path& file, const Image& image) {
    static_assert(std::endian::native == std::endian::little, "the header below says little-endian");
    const std::array<int, 3> channels = rgbChannels(image, file);
    std::string bytes = "PF\n" + std::to_string(image.width()) + " " + std::to_string(image.height()) + "\n-1.0\n";
    const auto width = static_cast<std::size_t>(image.width());
    for (int y = image.height() - 1; y >= 0; --y)  // rows from the bottom
        for (std::size_t x = 0; x < width; ++x)
            for (const int c : channels) {
                const auto raw =
                    std::bit_cast<std::array<char, 4>>(image.at(static_cast<std::size_t>(y) * width + x, c));
                bytes.append(raw.data(), raw.size());
            }
    writeFile(file, bytes);
}

void writeRadianceHdr(const std::filesystem::path& file, const Image& image) {
    const std::array<int, 3> channels = rgbChannels(image, file);
    std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(image.height()) + " +X " +
                        std::to_string(image.width()) + "\n";
    for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel)
        appendRgbe(bytes, {image.at(pixel, channels[0]), image.at(pixel, channels[1]), image.at(pixel, channels[2])});
    writeFile(file, bytes);
}

}  // namespace pellucid

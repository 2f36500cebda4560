#include <pellucid/io/image_file.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <unistd.h>

#include <OpenImageIO/imageio.h>

#include <pellucid/base/error.h>
#include <pellucid/io/plain_file.h>

#include "image_read.h"

namespace pellucid {
namespace {

[[noreturn]] void cannotWrite(const std::string& reason, const std::filesystem::path& file) {
    throw Error(ErrorKind::CannotFinish, "cannot write the image: " + oneLine(reason), file.string(),
                "name a file in a folder that exists, may be written and has space");
}

/// A name beside the file, so that renaming never crosses file systems; it goes away unless the file was renamed.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::filesystem::path& file) : target_(file), path_(file) {
        static std::atomic<unsigned> number{0};
        path_ += "." + std::to_string(getpid()) + "-" + std::to_string(number++) + ".part";
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }

    [[nodiscard]] std::string name() const { return path_.string(); }

    void moveToTarget() const {
        std::error_code failure;
        std::filesystem::rename(path_, target_, failure);
        if (failure) cannotWrite(failure.message(), target_);
    }

private:
    std::filesystem::path target_, path_;
};

void addMetadata(OIIO::ImageSpec& spec, const ImageMetadata& metadata) {
    for (const auto& [name, value] : metadata) spec.attribute(name, value);
}

void writeAtomically(const std::filesystem::path& file, const char* format, const OIIO::ImageSpec& spec,
                     OIIO::TypeDesc type, const void* pixels) {
    const TemporaryFile temporary(file);
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) cannotWrite(OIIO::geterror(), file);
    const bool written = output->open(temporary.name(), spec) && output->write_image(type, pixels);
    const bool closed = output->close();  // flushes: a full disk may show only here
    if (!written || !closed) cannotWrite(output->geterror(), file);
    temporary.moveToTarget();
}

[[nodiscard]] std::uint8_t displayCode(float linear) {
    if (!(linear > 0.0F)) return 0;  // NaN too
    return static_cast<std::uint8_t>(std::floor(linearToSrgb(std::min(linear, 1.0F)) * 255.0F + 0.5F));
}

}  // namespace

void writeExr(const std::filesystem::path& file, const Image& image, const ImageMetadata& metadata) {
    if (image.pixels() == 0 || image.channels() == 0) cannotWrite("the image is empty", file);
    OIIO::ImageSpec spec(image.width(), image.height(), image.channels(), OIIO::TypeDesc::FLOAT);
    spec.channelnames = image.channelNames();
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    addMetadata(spec, metadata);
    writeAtomically(file, "openexr", spec, OIIO::TypeDesc::FLOAT, image.data().data());
}

void writePng(const std::filesystem::path& file, const Image& image, float exposure, const ImageMetadata& metadata) {
    const std::array<int, 3> channels{image.channel("R"), image.channel("G"), image.channel("B")};
    if (image.pixels() == 0 || *std::min_element(channels.begin(), channels.end()) < 0)
        cannotWrite("it has no channels R, G and B", file);
    const float scale = std::exp2(exposure);
    std::vector<std::uint8_t> codes;
    codes.reserve(image.pixels() * channels.size());
    for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel)
        for (const int c : channels) codes.push_back(displayCode(image.at(pixel, c) * scale));

    OIIO::ImageSpec spec(image.width(), image.height(), 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    addMetadata(spec, metadata);
    writeAtomically(file, "png", spec, OIIO::TypeDesc::UINT8, codes.data());
}

void checkWritable(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    static constexpr std::array kKnown{".exr", ".png", ".hdr", ".pfm"};
    if (std::none_of(kKnown.begin(), kKnown.end(), [&](const char* known) { return extension == known; }))
        throw Error(ErrorKind::CannotFinish, "cannot write images of the kind '" + extension + "'", file.string(),
                    "name a file that ends in .exr, .png, .hdr or .pfm");
    checkFolderWritable(file);
}

}  // namespace pellucid

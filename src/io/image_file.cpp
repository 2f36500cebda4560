#include <pellucid/io/image_file.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <OpenImageIO/imageio.h>

#include <pellucid/base/error.h>

#include "exr_limits.h"
#include "file_bytes.h"
#include "image_read.h"
#include "png_check.h"

namespace pellucid {
namespace {

[[noreturn]] void unreadable(const std::string& reason, const std::string& where) {
    throw Error(ErrorKind::BadInput, "cannot read the image: " + (reason.empty() ? "unknown format" : oneLine(reason)),
                where, "give an EXR, HDR, PFM, PNG or TIFF file that is whole");
}

/// Files that state integers are taken as encoded for a display; float files are linear.
[[nodiscard]] bool isEncoded(const OIIO::ImageSpec& spec) {
    const auto type = static_cast<OIIO::TypeDesc::BASETYPE>(spec.format.basetype);
    return type == OIIO::TypeDesc::UINT8 || type == OIIO::TypeDesc::UINT16;
}

[[nodiscard]] std::vector<std::string> channelNames(const OIIO::ImageSpec& spec, bool isExr) {
    if (isExr) return spec.channelnames;
    switch (spec.nchannels) {
        case 1:
            return {"Y"};
        case 2:
            return {"Y", "A"};
        case 3:
            return {"R", "G", "B"};
        case 4:
            return {"R", "G", "B", "A"};
        default:
            return spec.channelnames;
    }
}

/// Channels [begin, end) that the caller wants. R G B stand next to each other: OpenImageIO sorts them so.
[[nodiscard]] std::pair<int, int> channelRange(const std::vector<std::string>& names, WantedChannels wanted) {
    const int count = static_cast<int>(names.size());
    if (wanted == WantedChannels::All) return {0, count};
    for (int i = 0; i + 2 < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        if (names[at] == "R" && names[at + 1] == "G" && names[at + 2] == "B") return {i, i + 3};
    }
    return {0, 1};
}

void decodeSrgb(Image& image) {
    const int channels = image.channels();
    for (int c = 0; c < channels; ++c) {
        if (image.channelNames()[static_cast<std::size_t>(c)] == "A") continue;
        for (std::size_t p = 0; p < image.pixels(); ++p) image.at(p, c) = srgbToLinear(image.at(p, c));
    }
}

/// Places the stored rectangle of an EXR in the picture's own, black around it.
[[nodiscard]] Image placeInFull(const Image& part, const OIIO::ImageSpec& spec, const std::string& where) {
    checkImageSize(spec.full_width, spec.full_height, part.channels(), where);
    Image full(spec.full_width, spec.full_height, part.channelNames());
    for (int y = 0; y < part.height(); ++y)
        for (int x = 0; x < part.width(); ++x) {
            const std::int64_t fx = std::int64_t{x} + spec.x - spec.full_x, fy = std::int64_t{y} + spec.y - spec.full_y;
            if (fx < 0 || fy < 0 || fx >= full.width() || fy >= full.height()) continue;
            const auto from =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(part.width()) + static_cast<std::size_t>(x);
            const auto to =
                static_cast<std::size_t>(fy) * static_cast<std::size_t>(full.width()) + static_cast<std::size_t>(fx);
            for (int c = 0; c < part.channels(); ++c) full.at(to, c) = part.at(from, c);
        }
    return full;
}

[[nodiscard]] bool isDamagedPng(const std::filesystem::path& file) {
    std::array<char, 8> start{};
    std::ifstream(file, std::ios::binary).read(start.data(), start.size());
    return isPng(std::as_bytes(std::span(start))) && !isWholePng(readFileBytes(file, file.string()));
}

}  // namespace

std::string oneLine(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    for (char& c : text)
        if (c == '\n' || c == '\r') c = ' ';
    return text;
}

void checkImageSize(std::int64_t width, std::int64_t height, std::int64_t channels, const std::string& where) {
    if (width > 0 && height > 0 && channels > 0 && width <= kMaxImageDimension && height <= kMaxImageDimension &&
        width * height <= kMaxImagePixels && width * height * channels <= kMaxImageValues)
        return;
    throw Error(ErrorKind::BadInput,
                "an image of " + std::to_string(width) + " x " + std::to_string(height) + " x " +
                    std::to_string(channels) + " is empty or too large",
                where, "keep each side within 32768 and the whole within 2^28 pixels");
}

Image readPixels(const std::filesystem::path& file, WantedChannels wanted) {
    const std::string where = file.string();
    std::error_code failure;
    if (!std::filesystem::is_regular_file(file, failure)) unreadable("no such file", where);
    if (isDamagedPng(file)) unreadable("the PNG is not whole", where);
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);  // colours as stored, not multiplied by alpha
    limitExrHeaders();
    const auto input = OIIO::ImageInput::open(where, &config);
    if (!input) unreadable(OIIO::geterror(), where);

    const OIIO::ImageSpec spec = input->spec();
    if (spec.depth > 1 || spec.deep) unreadable("volumes and deep images are not pictures", where);
    checkImageSize(spec.width, spec.height, spec.nchannels, where);
    std::vector<std::string> names = channelNames(spec, std::string_view(input->format_name()) == "openexr");
    const auto [begin, end] = channelRange(names, wanted);
    Image image(spec.width, spec.height, std::vector<std::string>(names.begin() + begin, names.begin() + end));
    if (!input->read_image(0, 0, begin, end, OIIO::TypeDesc::FLOAT, image.data().data()))
        unreadable(input->geterror(), where);
    if (isEncoded(spec)) decodeSrgb(image);

    const bool whole = spec.x == spec.full_x && spec.y == spec.full_y && spec.width == spec.full_width &&
                       spec.height == spec.full_height;
    if (whole) return image;
    return placeInFull(image, spec, where);
}

Image readImage(const std::filesystem::path& file) { return readPixels(file, WantedChannels::All); }

}  // namespace pellucid

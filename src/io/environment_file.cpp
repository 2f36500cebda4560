#include <pellucid/io/image_file.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <pellucid/base/error.h>

#include "content_hash.h"
#include "file_bytes.h"
#include "image_read.h"

namespace pellucid {
namespace {

/// "R,G,B" with three finite numbers >= 0 and nothing else. Locale never enters.
[[nodiscard]] std::optional<Rgb> parseConstant(std::string_view text) {
    Rgb colour{0.0F};
    for (int i = 0; i < 3; ++i) {
        const std::size_t comma = text.find(',');
        if ((comma == std::string_view::npos) != (i == 2)) return std::nullopt;
        std::string_view number = text.substr(0, comma);
        while (number.starts_with(' ')) number.remove_prefix(1);
        while (number.ends_with(' ')) number.remove_suffix(1);
        const auto [end, failure] = std::from_chars(number.data(), number.data() + number.size(), colour[i]);
        if (failure != std::errc() || end != number.data() + number.size()) return std::nullopt;
        text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
    }
    const bool usable = isFinite(colour) && colour.r >= 0.0F && colour.g >= 0.0F && colour.b >= 0.0F;
    return usable ? std::optional<Rgb>(colour + 0.0F) : std::nullopt;  // + 0 turns -0 into 0
}

/// RGB from whatever colour channels the file has; one channel is grey.
[[nodiscard]] Image toRgb(Image image) {
    if (image.channels() == 3) return image;
    Image rgb(image.width(), image.height(), {"R", "G", "B"});
    for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel) rgb.setRgb(pixel, Rgb(image.at(pixel, 0)));
    return rgb;
}

[[nodiscard]] std::size_t mendTexels(Image& map) {
    std::size_t mended = 0;
    for (std::size_t pixel = 0; pixel < map.pixels(); ++pixel) {
        const Rgb c = map.rgb(pixel);
        if (isFinite(c) && c.r >= 0.0F && c.g >= 0.0F && c.b >= 0.0F) continue;
        map.setRgb(pixel, Rgb(0.0F));
        ++mended;
    }
    return mended;
}

[[nodiscard]] std::string hashOfFile(const std::filesystem::path& file) {
    ContentHash hash;
    hash.addFile(readFileBytes(file, file.string()));
    return hash.hex();
}

}  // namespace

EnvironmentDescription loadEnvironment(const std::string& argument) {
    EnvironmentDescription description;
    std::error_code failure;
    const bool isFile = std::filesystem::exists(argument, failure);
    if (const auto constant = isFile ? std::nullopt : parseConstant(argument)) {
        description.constant = *constant;
        ContentHash hash;
        hash.addFile(std::as_bytes(std::span(&description.constant.x, 3)));
        description.contentHash = hash.hex();
        return description;
    }
    if (!isFile)
        throw Error(argument.find(',') == std::string::npos ? ErrorKind::BadInput : ErrorKind::Usage,
                    "no environment: neither a file nor three finite numbers >= 0", argument,
                    "give an equirectangular EXR or HDR file, or a constant as R,G,B");
    description.map = toRgb(readPixels(argument, WantedChannels::ColourOnly));
    description.mendedTexels = mendTexels(description.map);
    description.contentHash = hashOfFile(argument);
    return description;
}

}  // namespace pellucid

#include <pellucid/io/image_file.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <pellucid/base/error.h>

#include "exr_limits.h"
#include "image_read.h"
#include "png_check.h"

namespace pellucid {
namespace {

[[noreturn]] void notDecodable(const std::string& reason, const std::string& where) {
    throw Error(ErrorKind::BadInput, "the texture does not decode: " + oneLine(reason), where,
                "store it again as PNG or JPEG");
}

struct Magic {
    std::string_view bytes;
    std::size_t offset;
    const char* format;
};

/// Formats that may stand in a scene, told by their first bytes: names and media types in files lie, and the many other
/// decoders of OpenImageIO (video, volumes, raw) have no business with untrusted textures.
constexpr std::array<Magic, 8> kMagics{{
    {"\x89PNG\r\n\x1a\n", 0, "png"},
    {"\xff\xd8\xff", 0, "jpeg"},
    {"WEBP", 8, "webp"},
    {"BM", 0, "bmp"},
    {std::string_view("II*\0", 4), 0, "tiff"},
    {std::string_view("MM\0*", 4), 0, "tiff"},
    {"\x76\x2f\x31\x01", 0, "openexr"},
    {"#?RADIANCE", 0, "hdr"},
}};

[[nodiscard]] const char* formatOf(std::span<const std::byte> bytes, const std::string& where) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (const Magic& magic : kMagics)
        if (text.size() >= magic.offset && text.substr(magic.offset).starts_with(magic.bytes)) return magic.format;
    notDecodable("its first bytes name no known format", where);
}

/// Spreads grey, grey + alpha, RGB or RGBA to RGBA.
template <class Texel, class Value>
[[nodiscard]] Texel spread(const Value* values, int channels, Value opaque) noexcept {
    switch (channels) {
        case 1:
            return {values[0], values[0], values[0], opaque};
        case 2:
            return {values[0], values[0], values[0], values[1]};
        case 3:
            return {values[0], values[1], values[2], opaque};
        default:
            return {values[0], values[1], values[2], values[3]};
    }
}

/// Reads by strips, so that a large picture never stands in memory twice; a strip is not small, because each call of
/// OpenImageIO may set up tens of megabytes of its own.
template <class Texel, class Value, class Stored>
[[nodiscard]] bool readTexels(OIIO::ImageInput& input, OIIO::TypeDesc type, std::vector<Texel>& texels,
                              Stored (*store)(Value)) {
    constexpr int kRows = 512;
    const OIIO::ImageSpec spec = input.spec();
    const auto width = static_cast<std::size_t>(spec.width), channels = static_cast<std::size_t>(spec.nchannels);
    std::vector<Value> strip(width * channels * static_cast<std::size_t>(std::min(kRows, spec.height)));
    texels.reserve(width * static_cast<std::size_t>(spec.height));
    for (int y = 0; y < spec.height; y += kRows) {
        const int end = std::min(y + kRows, spec.height);
        if (!input.read_scanlines(0, 0, spec.y + y, spec.y + end, 0, 0, spec.nchannels, type, strip.data()))
            return false;
        const std::size_t count = width * static_cast<std::size_t>(end - y);
        for (std::size_t i = 0; i < count; ++i) {
            std::array<Stored, 4> values{};
            std::transform(&strip[i * channels], &strip[i * channels] + channels, values.begin(), store);
            texels.push_back(spread<Texel, Stored>(values.data(), spec.nchannels, std::numeric_limits<Stored>::max()));
        }
    }
    return true;
}

[[nodiscard]] std::uint16_t quantised(float value) {
    if (!(value > 0.0F)) return 0;
    return static_cast<std::uint16_t>(std::lround(std::min(value, 1.0F) * 65535.0F));
}

}  // namespace

std::shared_ptr<const TextureImage> decodeTexture(std::span<const std::byte> bytes, const std::string& where) {
    const char* format = formatOf(bytes, where);
    if (isPng(bytes) && !isWholePng(bytes)) notDecodable("the PNG is not whole", where);
    limitExrHeaders();
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    const auto input = OIIO::ImageInput::create(format);
    if (!input || input->supports("ioproxy") == 0) notDecodable(std::string("no decoder for ") + format, where);
    input->set_ioproxy(&memory);
    OIIO::ImageSpec config, spec;
    config.attribute("oiio:UnassociatedAlpha", 1);
    if (!input->open(where, spec, config)) notDecodable(input->geterror(), where);
    checkImageSize(spec.width, spec.height, spec.nchannels, where);
    if (spec.nchannels > 4 || spec.depth > 1 || spec.deep || spec.tile_width != 0)
        notDecodable("it has more than four channels, depth or tiles", where);

    auto image = std::make_shared<TextureImage>();
    image->name = where;
    image->width = spec.width;
    image->height = spec.height;
    const bool read = spec.format == OIIO::TypeDesc::UINT8
                          ? readTexels<glm::u8vec4, std::uint8_t, std::uint8_t>(
                                *input, OIIO::TypeDesc::UINT8, image->texels8, [](std::uint8_t v) { return v; })
                          : readTexels<glm::u16vec4, float, std::uint16_t>(*input, OIIO::TypeDesc::FLOAT,
                                                                           image->texels16, &quantised);
    if (!read) notDecodable(input->geterror(), where);
    return image;
}

}  // namespace pellucid

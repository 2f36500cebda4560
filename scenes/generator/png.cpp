#include "png.h"

#include <algorithm>
#include <string_view>

namespace scenes {

namespace {

using Bytes = std::vector<std::uint8_t>;

void appendBigEndian(Bytes& bytes, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) {
        bytes.push_back(static_cast<std::uint8_t>(value >> shift));
    }
}

void appendLittleEndian16(Bytes& bytes, std::uint32_t value) {
    bytes.push_back(static_cast<std::uint8_t>(value));
    bytes.push_back(static_cast<std::uint8_t>(value >> 8));
}

/// CRC-32 with the reflected polynomial 0xEDB88320 [PNG, annex D].
std::uint32_t crc32(Bytes::const_iterator first, Bytes::const_iterator last) {
    std::uint32_t crc = 0xFFFFFFFFU;
    for (; first != last; ++first) {
        crc ^= *first;
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc >> 1) ^ ((crc & 1U) ? 0xEDB88320U : 0U);
        }
    }
    return ~crc;
}

/// [RFC 1950, section 8]
std::uint32_t adler32(const Bytes& bytes) {
    std::uint32_t a = 1, b = 0;
    for (const std::uint8_t byte : bytes) {
        a = (a + byte) % 65521U;
        b = (b + a) % 65521U;
    }
    return (b << 16) | a;
}

void appendChunk(Bytes& file, std::string_view type, const Bytes& data) {
    appendBigEndian(file, static_cast<std::uint32_t>(data.size()));
    const auto start = static_cast<Bytes::difference_type>(file.size());
    file.insert(file.end(), type.begin(), type.end());
    file.insert(file.end(), data.begin(), data.end());
    appendBigEndian(file, crc32(file.begin() + start, file.end()));
}

/// A zlib stream whose blocks are stored [RFC 1951, section 3.2.4].
Bytes storedZlib(const Bytes& raw) {
    constexpr std::size_t kLargestBlock = 65535;
    Bytes stream = {0x78, 0x01};
    for (std::size_t at = 0; at < raw.size(); at += kLargestBlock) {
        const std::size_t length = std::min(kLargestBlock, raw.size() - at);
        stream.push_back(at + length == raw.size() ? 1 : 0);
        appendLittleEndian16(stream, static_cast<std::uint32_t>(length));
        appendLittleEndian16(stream, ~static_cast<std::uint32_t>(length));
        const auto first = raw.begin() + static_cast<Bytes::difference_type>(at);
        stream.insert(stream.end(), first, first + static_cast<Bytes::difference_type>(length));
    }
    appendBigEndian(stream, adler32(raw));
    return stream;
}

}  // namespace

std::vector<std::uint8_t> encodePng(const Pixels& pixels) {
    Bytes header;
    appendBigEndian(header, static_cast<std::uint32_t>(pixels.width));
    appendBigEndian(header, static_cast<std::uint32_t>(pixels.height));
    const auto colorType = static_cast<std::uint8_t>(pixels.channels == 4 ? 6 : 2);
    header.insert(header.end(), {8, colorType, 0, 0, 0});

    Bytes rows;
    const auto rowBytes = static_cast<Bytes::difference_type>(pixels.width) * pixels.channels;
    for (int y = 0; y < pixels.height; ++y) {
        rows.push_back(0);  // filter: none
        const auto first = pixels.bytes.begin() + y * rowBytes;
        rows.insert(rows.end(), first, first + rowBytes);
    }

    Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    appendChunk(file, "IHDR", header);
    appendChunk(file, "IDAT", storedZlib(rows));
    appendChunk(file, "IEND", {});
    return file;
}

}  // namespace scenes

#include "gltf_container.h"

#include <cstdint>

#include "gltf_error.h"

namespace pellucid {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67;        // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN"
constexpr std::size_t kHeaderSize = 12, kChunkHeaderSize = 8;

[[nodiscard]] std::uint32_t littleEndian(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
    return value;
}

[[noreturn]] void badGlb(const std::string& file, const std::string& what) {
    badGltf(file, "", what, "export the GLB again or copy it again in full");
}

[[nodiscard]] std::string_view asText(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The bytes that the header claims; a file may go on after them (the validator calls that a warning).
[[nodiscard]] std::span<const std::byte> checkedHeader(std::span<const std::byte> bytes, const std::string& file) {
    if (bytes.size() < kHeaderSize) badGlb(file, "the GLB ends within its header");
    if (const std::uint32_t version = littleEndian(bytes, 4); version != 2)
        badGltf(file, "", "GLB version " + std::to_string(version) + " is not 2", "convert the file to glTF 2.0");
    const std::uint32_t length = littleEndian(bytes, 8);
    if (length > bytes.size())
        badGlb(file, "the GLB is truncated: it claims " + std::to_string(length) + " bytes and has " +
                         std::to_string(bytes.size()));
    if (length < kHeaderSize + kChunkHeaderSize) badGlb(file, "the GLB holds no chunk");
    return bytes.first(length);
}

[[nodiscard]] GltfContainer splitGlb(std::span<const std::byte> bytes, const std::string& file) {
    const std::span<const std::byte> body = checkedHeader(bytes, file);
    GltfContainer container;
    std::size_t at = kHeaderSize;
    for (int number = 0; at < body.size(); ++number) {
        if (body.size() - at < kChunkHeaderSize) badGlb(file, "the GLB ends within the header of a chunk");
        const std::uint32_t size = littleEndian(body, at), type = littleEndian(body, at + 4);
        at += kChunkHeaderSize;
        if (size > body.size() - at) badGlb(file, "a chunk of the GLB reaches past its end");
        const std::span<const std::byte> chunk = body.subspan(at, size);
        at += size;
        if ((number == 0) != (type == kJsonChunk)) badGlb(file, "the first chunk of a GLB, and no other, must be JSON");
        if (type == kJsonChunk) container.json = asText(chunk);
        if (type == kBinaryChunk && number != 1) badGlb(file, "the binary chunk must be the second one");
        if (type == kBinaryChunk) container.binary = chunk;
    }
    return container;
}

}  // namespace

GltfContainer splitGltf(std::span<const std::byte> bytes, const std::string& file) {
    if (bytes.size() >= 4 && littleEndian(bytes, 0) == kMagic) return splitGlb(bytes, file);
    if (file.ends_with(".glb") || file.ends_with(".GLB"))
        badGlb(file, bytes.empty() ? "the file is empty" : "this is no GLB: it does not begin with 'glTF'");
    return {asText(bytes), std::nullopt};
}

}  // namespace pellucid

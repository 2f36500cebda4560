#include "gltf_uri.h"

#include <algorithm>
#include <cstdint>

namespace pellucid {
namespace {

[[nodiscard]] int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

[[nodiscard]] int base64Digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+') return 62;
    if (c == '/') return 63;
    return -1;
}

/// RFC 4648; missing padding is tolerated.
[[nodiscard]] std::optional<std::vector<std::byte>> decodeBase64(std::string_view text) {
    for (int i = 0; i < 2 && text.ends_with('='); ++i) text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int digit = base64Digit(c);
        if (digit < 0) return std::nullopt;
        bits = (bits << 6U) | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes.push_back(static_cast<std::byte>((bits >> static_cast<unsigned>(count)) & 255U));
    }
    return bytes;
}

/// Percent-decodes any bytes, NUL among them. Empty: a broken escape.
[[nodiscard]] std::optional<std::string> decodeEscapes(std::string_view text) {
    std::string decoded;
    decoded.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            decoded.push_back(text[i]);
            continue;
        }
        if (text.size() - i < 3) return std::nullopt;
        const int high = hexDigit(text[i + 1]), low = hexDigit(text[i + 2]);
        if (high < 0 || low < 0) return std::nullopt;
        decoded.push_back(static_cast<char>(static_cast<unsigned char>(16 * high + low)));
        i += 2;
    }
    return decoded;
}

}  // namespace

bool isDataUri(std::string_view uri) { return uri.starts_with("data:"); }

std::optional<std::vector<std::byte>> decodeDataUri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (!isDataUri(uri) || comma == std::string_view::npos) return std::nullopt;
    const std::string_view header = uri.substr(0, comma), body = uri.substr(comma + 1);
    if (header.ends_with(";base64")) return decodeBase64(body);
    const auto text = decodeEscapes(body);
    if (!text) return std::nullopt;
    const auto* begin = reinterpret_cast<const std::byte*>(text->data());
    return std::vector<std::byte>(begin, begin + text->size());
}

std::optional<std::string> percentDecode(std::string_view text) {
    auto decoded = decodeEscapes(text);
    if (decoded && decoded->find('\0') != std::string::npos) return std::nullopt;
    return decoded;
}

std::optional<std::filesystem::path> resolveInside(const std::filesystem::path& folder, std::string_view uri) {
    auto decoded = percentDecode(uri);
    if (!decoded || decoded->empty() || decoded->front() == '/' || decoded->front() == '\\') return std::nullopt;
    const std::size_t colon = decoded->find(':'), slash = decoded->find_first_of("/\\");
    if (colon != std::string::npos && (slash == std::string::npos || colon < slash)) return std::nullopt;
    std::replace(decoded->begin(), decoded->end(), '\\', '/');
    const std::filesystem::path relative = std::filesystem::path(*decoded).lexically_normal();
    if (relative.empty() || relative.is_absolute() || *relative.begin() == "..") return std::nullopt;
    return folder / relative;
}

}  // namespace pellucid

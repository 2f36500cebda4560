#include "png_check.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace pellucid {
namespace {

constexpr std::array<std::byte, 8> kSignature{std::byte{0x89}, std::byte{'P'},  std::byte{'N'},  std::byte{'G'},
                                              std::byte{'\r'}, std::byte{'\n'}, std::byte{0x1a}, std::byte{'\n'}};
constexpr std::uint32_t kHeader = 0x49484452, kEnd = 0x49454E44;  // IHDR, IEND

/// CRC-32 by bytes (PNG specification, annex D).
constexpr std::array<std::uint32_t, 256> kCrcTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        std::uint32_t c = i;
        for (int bit = 0; bit < 8; ++bit) c = (c & 1U) != 0 ? 0xEDB88320U ^ (c >> 1U) : c >> 1U;
        table[i] = c;
    }
    return table;
}();

[[nodiscard]] std::uint32_t crc(std::span<const std::byte> bytes) noexcept {
    std::uint32_t c = 0xFFFFFFFFU;
    for (const std::byte b : bytes) c = kCrcTable[(c ^ std::to_integer<std::uint32_t>(b)) & 255U] ^ (c >> 8U);
    return c ^ 0xFFFFFFFFU;
}

[[nodiscard]] std::uint32_t bigEndian(std::span<const std::byte> bytes) noexcept {
    std::uint32_t value = 0;
    for (const std::byte b : bytes.first(4)) value = (value << 8U) | std::to_integer<std::uint32_t>(b);
    return value;
}

}  // namespace

bool isPng(std::span<const std::byte> bytes) noexcept {
    return bytes.size() >= kSignature.size() && std::equal(kSignature.begin(), kSignature.end(), bytes.begin());
}

bool isWholePng(std::span<const std::byte> bytes) noexcept {
    if (!isPng(bytes)) return false;
    std::span<const std::byte> rest = bytes.subspan(kSignature.size());
    for (bool first = true;; first = false) {
        if (rest.size() < 12) return false;
        const std::size_t length = bigEndian(rest);
        const std::uint32_t type = bigEndian(rest.subspan(4));
        if (length > rest.size() - 12 || (first != (type == kHeader))) return false;
        if (crc(rest.subspan(4, 4 + length)) != bigEndian(rest.subspan(8 + length))) return false;
        if (type == kEnd) return true;
        rest = rest.subspan(12 + length);
    }
}

}  // namespace pellucid

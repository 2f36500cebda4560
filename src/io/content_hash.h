/// A 128-bit digest of what a scene was made from, for records and checkpoints. It tells files apart; it resists no
/// attacker. The result depends on the bytes and on where each file begins, not on how they arrive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace pellucid {

class ContentHash {
public:
    /// One whole file: its length goes in as well.
    void addFile(std::span<const std::byte> bytes) noexcept;

    /// 32 hexadecimal digits.
    [[nodiscard]] std::string hex() const;

private:
    void addWord(std::uint64_t word) noexcept;
    std::uint64_t low_ = 0x243f6a8885a308d3ULL, high_ = 0x13198a2e03707344ULL;
};

}  // namespace pellucid

#include "content_hash.h"

#include <algorithm>
#include <cstring>

#include <pellucid/math/hash.h>

namespace pellucid {

void ContentHash::addWord(std::uint64_t word) noexcept {
    low_ = hash64(low_ ^ word) + 0x9e3779b97f4a7c15ULL;
    high_ = hash64(high_ + word * 0xff51afd7ed558ccdULL) ^ low_;
}

void ContentHash::addFile(std::span<const std::byte> bytes) noexcept {
    addWord(bytes.size());
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::uint64_t)) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
        addWord(word);
    }
}

std::string ContentHash::hex() const {
    static constexpr char kDigits[] = "0123456789abcdef";
    std::string text;
    for (const std::uint64_t half : {high_, low_})
        for (int shift = 60; shift >= 0; shift -= 4) text.push_back(kDigits[(half >> shift) & 15U]);
    return text;
}

}  // namespace pellucid

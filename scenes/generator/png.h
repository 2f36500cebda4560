/// The smallest writer of valid PNG files: 8 bits a channel, no filter, deflate blocks that only store.
/// [PNG specification, ISO/IEC 15948; RFC 1950 and 1951]
#pragma once

#include <cstdint>
#include <vector>

namespace scenes {

/// Rows from the top, `channels` (3 = RGB, 4 = RGBA) bytes a pixel.
struct Pixels {
    int width = 0, height = 0, channels = 3;
    std::vector<std::uint8_t> bytes;
};

[[nodiscard]] std::vector<std::uint8_t> encodePng(const Pixels& pixels);

}  // namespace scenes

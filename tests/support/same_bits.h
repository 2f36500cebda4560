/// Two images of the same bits.
#pragma once

#include <bit>
#include <cstdint>

#include <gtest/gtest.h>

#include <pellucid/math/image.h>

namespace pellucid::test {

inline void expectSameBits(const Image& a, const Image& b) {
    ASSERT_EQ(a.width(), b.width());
    ASSERT_EQ(a.channelNames(), b.channelNames());
    for (std::size_t i = 0; i < a.pixels(); ++i)
        for (int c = 0; c < a.channels(); ++c)
            ASSERT_EQ(std::bit_cast<std::uint32_t>(a.at(i, c)), std::bit_cast<std::uint32_t>(b.at(i, c)))
                << "pixel " << i << ", channel " << c << ": " << a.at(i, c) << " and " << b.at(i, c);
}

}  // namespace pellucid::test

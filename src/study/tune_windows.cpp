#include "tune_windows.h"

#include <algorithm>
#include <cmath>

#include <pellucid/math/sampler.h>

namespace pellucid {
namespace {

constexpr double kShare = 1.0 / 7.0;
constexpr int kCells = 9;          // about; the grid has the image's shape
constexpr int kSmallestSide = 24;  // of a window, in pixels

}  // namespace

std::vector<PixelWindow> stratifiedWindows(int width, int height, std::uint64_t key) {
    const double shape = std::sqrt(static_cast<double>(width) / height), cells = std::sqrt(static_cast<double>(kCells));
    const int columns = std::max(1, static_cast<int>(std::lround(cells * shape)));
    const int rows = std::max(1, static_cast<int>(std::lround(cells / shape)));
    const int side = static_cast<int>(std::lround(std::sqrt(kShare * width * height / (columns * rows))));
    if (side < kSmallestSide) return {};
    Sampler sampler(key, 0, 0);
    std::vector<PixelWindow> windows;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const int left = column * width / columns, top = row * height / rows;
            const int roomX = (column + 1) * width / columns - left - side,
                      roomY = (row + 1) * height / rows - top - side;
            const glm::vec2 place = sampler.next2D();
            PixelWindow w;
            w.x0 = left + static_cast<int>(place.x * static_cast<float>(std::max(0, roomX) + 1));
            w.y0 = top + static_cast<int>(place.y * static_cast<float>(std::max(0, roomY) + 1));
            w.x1 = std::min(width, w.x0 + side);
            w.y1 = std::min(height, w.y0 + side);
            windows.push_back(w);
        }
    return windows;
}

}  // namespace pellucid

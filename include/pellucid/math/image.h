/// Named float channels in rows from the top: what renders make, files hold and metrics read.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pellucid/math/rgb.h>

namespace pellucid {

class Image {
public:
    Image() = default;
    Image(int width, int height, std::vector<std::string> channelNames)
        : width_(width),
          height_(height),
          names_(std::move(channelNames)),
          data_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * names_.size(), 0.0F) {}

    [[nodiscard]] int width() const noexcept { return width_; }
    [[nodiscard]] int height() const noexcept { return height_; }
    [[nodiscard]] int channels() const noexcept { return static_cast<int>(names_.size()); }
    [[nodiscard]] std::size_t pixels() const noexcept {
        return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    }
    [[nodiscard]] const std::vector<std::string>& channelNames() const noexcept { return names_; }

    /// Index of the named channel, or -1.
    [[nodiscard]] int channel(std::string_view name) const noexcept {
        for (std::size_t i = 0; i < names_.size(); ++i)
            if (names_[i] == name) return static_cast<int>(i);
        return -1;
    }

    [[nodiscard]] float at(std::size_t pixel, int channel) const noexcept { return data_[index(pixel, channel)]; }
    [[nodiscard]] float& at(std::size_t pixel, int channel) noexcept { return data_[index(pixel, channel)]; }

    /// Three consecutive channels beginning at `first`.
    [[nodiscard]] Rgb rgb(std::size_t pixel, int first = 0) const noexcept {
        return {at(pixel, first), at(pixel, first + 1), at(pixel, first + 2)};
    }
    void setRgb(std::size_t pixel, const Rgb& c, int first = 0) noexcept {
        at(pixel, first) = c.r;
        at(pixel, first + 1) = c.g;
        at(pixel, first + 2) = c.b;
    }

    [[nodiscard]] const std::vector<float>& data() const noexcept { return data_; }
    [[nodiscard]] std::vector<float>& data() noexcept { return data_; }

private:
    [[nodiscard]] std::size_t index(std::size_t pixel, int channel) const noexcept {
        return pixel * names_.size() + static_cast<std::size_t>(channel);
    }
    int width_ = 0, height_ = 0;
    std::vector<std::string> names_;
    std::vector<float> data_;
};

}  // namespace pellucid

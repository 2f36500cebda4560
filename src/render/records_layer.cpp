#include "records_layer.h"

#include <string>
#include <utility>

namespace pellucid {

void addRecordsLayer(Image& image, const std::vector<IrradianceRecord>& records, const Camera& camera) {
    std::vector<std::string> names = image.channelNames();
    names.emplace_back("records.Y");
    Image wider(image.width(), image.height(), names);
    for (std::size_t i = 0; i < image.pixels(); ++i)
        for (int c = 0; c < image.channels(); ++c) wider.at(i, c) = image.at(i, c);
    const int channel = wider.channels() - 1;
    for (const IrradianceRecord& r : records) {
        const auto film = camera.project(r.position, {0.5F, 0.5F});
        if (!film) continue;
        const int x = static_cast<int>(film->position.x), y = static_cast<int>(film->position.y);
        if (x < 0 || y < 0 || x >= image.width() || y >= image.height()) continue;
        wider.at(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width()) + static_cast<std::size_t>(x),
                 channel) += 1.0F;
    }
    image = std::move(wider);
}

}  // namespace pellucid

#include <pellucid/study/diff_report.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include <pellucid/base/error.h>
#include <pellucid/base/nearest_name.h>
#include <pellucid/study/image_pair.h>
#include <pellucid/study/reference_variance.h>
#include <pellucid/study/text_table.h>

namespace pellucid {
namespace {

constexpr std::array<std::string_view, 7> kMetricNames{"rmse", "relmse", "relmse_trimmed", "smape",
                                                       "flip", "bias",   "nonfinite"};

[[nodiscard]] std::array<double, kMetricNames.size()> valuesOf(const Metrics& m) noexcept {
    return {m.rmse, m.relmse, m.relmseTrimmed, m.smape, m.flip, m.bias, static_cast<double>(m.nonfinite)};
}

}  // namespace

std::span<const std::string_view> metricNames() noexcept { return kMetricNames; }

double metricByName(const Metrics& metrics, std::string_view name) {
    const auto found = std::ranges::find(kMetricNames, name);
    if (found == kMetricNames.end())
        throw Error(ErrorKind::Usage, "there is no metric '" + std::string(name) + "'", "--fail-above",
                    "the nearest name is '" + std::string(nearestName(name, kMetricNames)) + "'");
    return valuesOf(metrics)[static_cast<std::size_t>(found - kMetricNames.begin())];
}

std::optional<double> referenceNoise(const Image& reference) {
    const ReferenceVariance variance(reference);
    if (!variance.known()) return std::nullopt;
    const ImagePair pair(reference, reference);
    double noise = 0.0, count = 0.0;
    for (std::size_t pixel = 0; pixel < pair.pixels(); ++pixel)
        for (std::size_t c = 0; c < 3 && pair.counts(pixel); ++c) {
            const auto r = static_cast<double>(pair.reference(pixel, c));
            if (!std::isfinite(r)) continue;
            const double v = variance.at(pixel, c);
            noise += v == 0.0 ? 0.0 : v / (r * r + pair.relativeFloor());
            count += 1.0;
        }
    return count == 0.0 ? 0.0 : noise / count;
}

std::size_t countedPixels(const Image& reference) {
    const ImagePair pair(reference, reference);
    std::size_t count = 0;
    for (std::size_t pixel = 0; pixel < pair.pixels(); ++pixel) count += pair.counts(pixel) ? 1U : 0U;
    return count;
}

double exposureScale(const Image& reference, const Image& image) {
    const ImagePair pair(reference, image);
    double sumReference = 0.0, sumImage = 0.0;
    for (std::size_t pixel = 0; pixel < pair.pixels(); ++pixel)
        for (std::size_t c = 0; c < 3 && pair.counts(pixel); ++c) {
            const double r = static_cast<double>(pair.reference(pixel, c)),
                         i = static_cast<double>(pair.image(pixel, c));
            if (!std::isfinite(r) || !std::isfinite(i)) continue;
            sumReference += r;
            sumImage += i;
        }
    return sumImage > 0.0 ? sumReference / sumImage : 1.0;
}

Image scaled(Image image, double scale) {
    std::array<int, 3> channels = colourChannels(image);
    const auto end = std::unique(channels.begin(), channels.end());
    for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel)
        std::for_each(channels.begin(), end, [&](int c) {
            image.at(pixel, c) = static_cast<float>(scale * static_cast<double>(image.at(pixel, c)));
        });
    return image;
}

std::string diffJson(const DiffReport& report) {
    nlohmann::ordered_json json;
    json["reference"] = report.reference;
    json["width"] = report.width;
    json["height"] = report.height;
    json["counted_pixels"] = report.countedPixels;
    if (report.referenceNoise) json["reference_noise"] = *report.referenceNoise;
    json["images"] = nlohmann::ordered_json::array();
    for (const DiffRow& row : report.rows) {
        nlohmann::ordered_json entry;
        entry["file"] = row.file;
        const auto values = valuesOf(row.metrics);
        for (std::size_t i = 0; i + 1 < values.size(); ++i) entry[std::string(kMetricNames[i])] = values[i];
        entry["nonfinite"] = row.metrics.nonfinite;
        if (report.exposureInvariant) entry["scale"] = row.scale;
        json["images"].push_back(std::move(entry));
    }
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string diffTable(const DiffReport& report) {
    std::vector<std::string> header{"image"};
    for (const std::string_view name : kMetricNames) header.emplace_back(name);
    if (report.exposureInvariant) header.emplace_back("scale");
    TextTable table(std::move(header));
    for (const DiffRow& row : report.rows) {
        std::vector<std::string> cells{row.file};
        for (const double value : valuesOf(row.metrics)) cells.push_back(figure(value));
        if (report.exposureInvariant) cells.push_back(figure(row.scale));
        table.add(std::move(cells));
    }
    const std::size_t pixels = static_cast<std::size_t>(report.width) * static_cast<std::size_t>(report.height);
    std::string text = "reference " + report.reference + ", " + std::to_string(report.width) + "x" +
                       std::to_string(report.height) + "\n";
    if (report.countedPixels < pixels)
        text += "mask.Y of the reference leaves out " + std::to_string(pixels - report.countedPixels) + " of " +
                std::to_string(pixels) + " pixels\n";
    if (report.referenceNoise)
        text += "reference noise " + figure(*report.referenceNoise) + " (mean relative variance)\n";
    if (report.exposureInvariant) text += "images are scaled to the reference's mean; bias is that before scaling\n";
    return text + "\n" + table.text();
}

}  // namespace pellucid

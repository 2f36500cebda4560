/// What the command `diff` finds: the metrics of images against one reference, as a table for people and as JSON.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <pellucid/math/image.h>
#include <pellucid/study/metrics.h>

namespace pellucid {

/// Names of the metrics as the command line spells them: rmse, relmse, relmse_trimmed, smape, flip, bias, nonfinite.
[[nodiscard]] std::span<const std::string_view> metricNames() noexcept;
/// The metric of that name; throws Error{Usage} for another name.
[[nodiscard]] double metricByName(const Metrics& metrics, std::string_view name);

struct DiffRow {
    std::string file;
    Metrics metrics;
    double scale = 1.0;  ///< factor that brought the image to the reference's mean; 1 when that was not asked for
};

struct DiffReport {
    std::string reference;
    int width = 0, height = 0;
    std::size_t countedPixels = 0;         ///< less than all when the reference has a mask
    std::optional<double> referenceNoise;  ///< see referenceNoise()
    bool exposureInvariant = false;
    std::vector<DiffRow> rows;
};

/// Mean over the pixels that count of variance / (R^2 + 0.01 mean(R)^2), from the reference's layers variance.*: the
/// relmse that a perfect image would still show. Empty without such layers.
[[nodiscard]] std::optional<double> referenceNoise(const Image& reference);

/// Pixels that the reference's channel mask.Y lets count.
[[nodiscard]] std::size_t countedPixels(const Image& reference);

/// mean(R) / mean(I) over the values that count and are finite; 1 when the image is black.
[[nodiscard]] double exposureScale(const Image& reference, const Image& image);
/// The image with its colour multiplied by `scale`.
[[nodiscard]] Image scaled(Image image, double scale);

[[nodiscard]] std::string diffJson(const DiffReport& report);
[[nodiscard]] std::string diffTable(const DiffReport& report);

}  // namespace pellucid

// Bias and variance from K renders: one pass over the pixels makes K x K products of errors; the rest is arithmetic.
#include <array>
#include <limits>
#include <string>

#include <pellucid/study/image_pair.h>
#include <pellucid/study/reference_variance.h>
#include <pellucid/study/statistics.h>

namespace pellucid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

[[nodiscard]] std::array<int, 3> layerChannels(const Image& image, std::string_view prefix) {
    if (prefix.empty()) return colourChannels(image);
    const std::string layer(prefix);
    return {image.channel(layer + "R"), image.channel(layer + "G"), image.channel(layer + "B")};
}

/// The errors of one value (pixel and channel) in all renders; false where one of them is not finite.
[[nodiscard]] bool errorsAt(double reference, std::span<const Image> images,
                            std::span<const std::array<int, 3>> channels, std::size_t pixel, std::size_t c,
                            std::vector<double>& errors) noexcept {
    if (!std::isfinite(reference)) return false;
    for (std::size_t k = 0; k < images.size(); ++k) {
        const double value = images[k].at(pixel, channels[k][c]);
        if (!std::isfinite(value)) return false;
        errors[k] = value - reference;
    }
    return true;
}

}  // namespace

double meanSquaredError(const ErrorProducts& errors, SeedCounts counts) noexcept {
    double sum = 0.0, seeds = 0.0;
    for (int i = 0; i < errors.seeds; ++i) {
        const double n = counts[static_cast<std::size_t>(i)];
        sum += n * errors.at(i, i);
        seeds += n;
    }
    return sum / seeds;
}

double errorVariance(const ErrorProducts& errors, SeedCounts counts) noexcept {
    double squares = 0.0, pairs = 0.0;
    for (int i = 0; i < errors.seeds; ++i)
        for (int j = 0; j < i; ++j) {
            const double weight = static_cast<double>(counts[static_cast<std::size_t>(i)]) *
                                  static_cast<double>(counts[static_cast<std::size_t>(j)]);
            squares += weight * 0.5 * (errors.at(i, i) + errors.at(j, j) - 2.0 * errors.at(i, j));
            pairs += weight;
        }
    return pairs > 0.0 ? squares / pairs : kNan;
}

double biasSquared(const ErrorProducts& errors, SeedCounts counts) noexcept {
    return meanSquaredError(errors, counts) - errorVariance(errors, counts) - errors.referenceNoise;
}

ErrorProducts errorProducts(const Image& reference, std::span<const Image> images, bool relative,
                            std::string_view prefix) {
    const ImagePair whole(reference, images.front());
    const std::array<int, 3> referenceChannels = layerChannels(reference, prefix);
    std::vector<std::array<int, 3>> channels;
    for (const Image& image : images) channels.push_back(layerChannels(image, prefix));
    const ReferenceVariance noise(reference);
    const std::size_t seeds = images.size();
    ErrorProducts result{static_cast<int>(seeds), std::vector<double>(seeds * seeds, 0.0), 0.0};
    std::vector<double> errors(seeds);
    double values = 0.0;
    for (std::size_t pixel = 0; pixel < reference.pixels(); ++pixel) {
        if (!whole.counts(pixel)) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const double size = whole.reference(pixel, c);
            if (!errorsAt(reference.at(pixel, referenceChannels[c]), images, channels, pixel, c, errors)) continue;
            const double scale = size * size + whole.relativeFloor();
            const double weight = !relative ? 1.0 : (scale > 0.0 ? 1.0 / scale : 0.0);
            for (std::size_t i = 0; i < seeds; ++i)
                for (std::size_t j = 0; j <= i; ++j) result.products[i * seeds + j] += weight * errors[i] * errors[j];
            if (prefix.empty()) result.referenceNoise += weight * noise.at(pixel, c);
            values += 1.0;
        }
    }
    if (values == 0.0) return result;
    result.referenceNoise /= values;
    for (std::size_t i = 0; i < seeds; ++i)
        for (std::size_t j = 0; j <= i; ++j) result.products[j * seeds + i] = result.products[i * seeds + j] /= values;
    return result;
}

SeedMaps seedMaps(const Image& reference, std::span<const Image> images) {
    const ImagePair pair(reference, images.front());
    std::vector<std::array<int, 3>> channels;
    for (const Image& image : images) channels.push_back(colourChannels(image));
    SeedMaps maps{Image(pair.width(), pair.height(), {"Y"}), Image(pair.width(), pair.height(), {"Y"})};
    const double seeds = static_cast<double>(images.size());
    std::vector<double> errors(images.size());
    for (std::size_t pixel = 0; pixel < reference.pixels(); ++pixel) {
        if (!pair.counts(pixel)) continue;
        double bias = 0.0, variance = 0.0, values = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double r = pair.reference(pixel, c), scale = r * r + pair.relativeFloor();
            if (!(scale > 0.0) || !errorsAt(r, images, channels, pixel, c, errors)) continue;
            double sum = 0.0, squares = 0.0;
            for (const double e : errors) sum += e, squares += e * e;
            bias += sum / seeds / std::sqrt(scale);
            if (seeds > 1.0) variance += std::max(0.0, squares - sum * sum / seeds) / (seeds - 1.0) / scale;
            values += 1.0;
        }
        if (values == 0.0) continue;
        maps.bias.at(pixel, 0) = static_cast<float>(bias / values);
        maps.deviation.at(pixel, 0) = static_cast<float>(std::sqrt(variance / values));
    }
    return maps;
}

}  // namespace pellucid

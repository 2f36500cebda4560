// `pellucid diff`: read, measure, print, then hold the figures against the gates.
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include <pellucid/base/error.h>
#include <pellucid/io/image_file.h>
#include <pellucid/io/plain_file.h>
#include <pellucid/study/diff_report.h>
#include <pellucid/study/false_colour.h>
#include <pellucid/study/text_table.h>

#include "commands.h"
#include "terminal.h"

namespace pellucid {
namespace {

[[nodiscard]] Image readCropped(const std::string& file, const DiffArguments& arguments) {
    Image image = readImage(file);
    return arguments.crop ? crop(image, *arguments.crop) : image;
}

[[nodiscard]] std::string sizeText(const Image& image) {
    return std::to_string(image.width()) + "x" + std::to_string(image.height());
}

/// OUT.png for one image; OUT-1.png, OUT-2.png, ... for several.
[[nodiscard]] std::filesystem::path mapFile(const DiffArguments& arguments, std::size_t index) {
    std::filesystem::path file = arguments.map;
    if (arguments.images.size() == 1) return file;
    return file.replace_filename(file.stem().string() + "-" + std::to_string(index + 1) + file.extension().string());
}

[[nodiscard]] DiffRow measure(const Image& reference, std::size_t index, const DiffArguments& arguments) {
    DiffRow row;
    row.file = arguments.images[index];
    Image image = readCropped(row.file, arguments);
    if (image.width() != reference.width() || image.height() != reference.height())
        throw Error(
            ErrorKind::BadInput,
            "the images have different sizes: " + sizeText(image) + " against the reference's " + sizeText(reference),
            row.file, "render both at the same --size, or give a --crop that both have");
    if (arguments.exposureInvariant) {
        row.scale = exposureScale(reference, image);
        const double bias = compareImages(reference, image, false).bias;
        image = scaled(std::move(image), row.scale);
        row.metrics = compareImages(reference, image);
        row.metrics.bias = bias;
    } else {
        row.metrics = compareImages(reference, image);
    }
    if (!arguments.map.empty())
        writePng(mapFile(arguments, index), falseColourImage(hdrFlipMap(reference, image)), 0.0F);
    return row;
}

/// Throws for the first figure above its gate; one that is no number is above every gate.
void holdAgainstGates(const DiffReport& report, const DiffArguments& arguments) {
    for (const DiffRow& row : report.rows)
        for (const auto& [name, limit] : arguments.failAbove) {
            const double value = std::abs(metricByName(row.metrics, name));
            if (value <= limit) continue;
            throw Error(ErrorKind::CheckFailed, name + " " + figure(value) + " is above " + figure(limit), row.file,
                        "render longer, or raise --fail-above");
        }
}

}  // namespace

int runDiff(const DiffArguments& arguments) {
    if (!arguments.map.empty())
        for (std::size_t i = 0; i < arguments.images.size(); ++i) checkFolderWritable(mapFile(arguments, i));
    const Image reference = readCropped(arguments.reference, arguments);
    DiffReport report;
    report.reference = arguments.reference;
    report.width = reference.width();
    report.height = reference.height();
    report.countedPixels = countedPixels(reference);
    report.referenceNoise = referenceNoise(reference);
    report.exposureInvariant = arguments.exposureInvariant;
    for (std::size_t i = 0; i < arguments.images.size(); ++i) report.rows.push_back(measure(reference, i, arguments));
    printResult(arguments.json ? diffJson(report) : diffTable(report));
    holdAgainstGates(report, arguments);
    return 0;
}

}  // namespace pellucid

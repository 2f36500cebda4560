#include "compare_cell.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <nlohmann/json.hpp>

#include <pellucid/io/plain_file.h>

#include "study_json.h"

namespace pellucid {
namespace {

using Json = nlohmann::ordered_json;

[[nodiscard]] Json productsJson(const ErrorProducts& p) {
    return {{"seeds", p.seeds}, {"products", p.products}, {"reference_noise", p.referenceNoise}};
}

[[nodiscard]] ErrorProducts productsFrom(const Json& json) {
    return {json.at("seeds").get<int>(), json.at("products").get<std::vector<double>>(),
            json.at("reference_noise").get<double>()};
}

/// Empty when there is no such file or it is of other images.
[[nodiscard]] std::optional<CellProducts> readCell(const std::filesystem::path& file, const std::string& key) {
    return readKeyed<Json>(file, key, std::optional<CellProducts>(), [](const Json& json) {
        CellProducts cell{productsFrom(json.at("relative")), productsFrom(json.at("absolute")), {}};
        for (const auto& [name, value] : json.at("classes").items()) cell.classes[name] = productsFrom(value);
        return std::optional(cell);
    });
}

void writeCell(const std::filesystem::path& file, const std::string& key, const CellProducts& cell) {
    Json json{{"key", key},
              {"relative", productsJson(cell.relative)},
              {"absolute", productsJson(cell.absolute)},
              {"classes", Json::object()}};
    for (const auto& [name, products] : cell.classes) json["classes"][name] = productsJson(products);
    writeFile(file, dumped(json, -1));
}

[[nodiscard]] bool hasLayer(const Image& image, const std::string& name) {
    return image.channel(name + ".R") >= 0 && image.channel(name + ".G") >= 0 && image.channel(name + ".B") >= 0;
}

/// The noise of a made reference is known better than from its layer variance.Y, which is too large where the samples of a
/// pixel are spread evenly and holds no colour: from the difference of its two halves.
void setReferenceNoise(CellProducts& cell, const CompareReference& reference) {
    if (!reference.made || !std::isfinite(reference.noise)) return;
    const double seen = cell.relative.referenceNoise;
    if (seen > 0.0) cell.absolute.referenceNoise *= reference.noise / seen;
    cell.relative.referenceNoise = reference.noise;
}

}  // namespace

std::vector<std::string> classesIn(const Image& reference) {
    std::vector<std::string> names;
    for (const std::string_view name : kMeasuredClasses)
        if (hasLayer(reference, std::string(name))) names.emplace_back(name);
    return names;
}

CellProducts cellProducts(const std::vector<const StoredRun*>& runs, const CompareReference& reference,
                          const RunStore& store, const Workers& workers) {
    std::string key = "4 " + reference.hash;
    for (const StoredRun* run : runs) key += " " + run->imageHash;
    const std::filesystem::path folder = store.folder() / "cells", file = folder / (hashText(key) + ".json");
    const std::optional<CellProducts> stored = readCell(file, key);
    CellProducts cell = stored.value_or(CellProducts{});
    if (!stored) {
        std::vector<Image> images(runs.size());
        workers.forEach(runs.size(), 1, [&](std::size_t i) { images[i] = store.readImage(*runs[i]); });
        std::vector<std::string> names{"", ""};  // the whole image: relative and absolute; then the classes
        for (const std::string& name : classesIn(reference.image))
            if (std::ranges::all_of(images, [&name](const Image& image) { return hasLayer(image, name); }))
                names.push_back(name);
        std::vector<ErrorProducts> products(names.size());
        workers.forEach(names.size(), 1, [&](std::size_t i) {
            products[i] = errorProducts(reference.image, images, i != 1, names[i].empty() ? "" : names[i] + ".");
        });
        cell.relative = products[0];
        cell.absolute = products[1];
        for (std::size_t i = 2; i < names.size(); ++i) cell.classes[names[i]] = products[i];
        std::filesystem::create_directories(folder);
        writeCell(file, key, cell);
    }
    setReferenceNoise(cell, reference);
    return cell;
}

}  // namespace pellucid

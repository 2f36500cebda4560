// The film as an image: the mean of each pixel, by layer.
#include <algorithm>

#include <pellucid/math/constants.h>
#include <pellucid/render/film.h>

namespace pellucid {

namespace {

constexpr const char* kLayerNames[kPathClasses] = {"emission", "direct", "caustic", "indirect"};

[[nodiscard]] bool wants(const std::vector<std::string>& layers, const char* name) {
    return std::any_of(layers.begin(), layers.end(), [name](const std::string& l) { return l == name || l == "all"; });
}

/// Of the photons of an iteration, by the square of the unit of `radius`: what was met over the mean kernel's disc.
[[nodiscard]] float photonDensity(float photons, float radius) noexcept {
    return radius > 0.0F ? photons * kInvPi / (radius * radius) : 0.0F;
}

}  // namespace

const std::vector<std::string>& auxiliaryLayers() noexcept {
    static const std::vector<std::string> names{"albedo",     "normal",       "depth",         "variance",
                                                "radius",     "photons",      "density",       "records",
                                                "samples",    "classes",      "record_radius", "record_gradient",
                                                "record_age", "record_reuse", "record_reason"};
    return names;
}

double Film::stringMean(std::size_t slot, std::size_t pixel, std::size_t channel) const noexcept {
    const std::size_t i = (slot * pixels_.size() + pixel) * 3 + channel;
    return strings_[i] / terms_.divisor() + splatStrings_[i] / std::max<std::uint32_t>(1, splatPasses_);
}

std::vector<std::pair<std::size_t, std::string>> Film::litStrings() const {
    std::vector<std::pair<std::size_t, std::string>> lit;
    const std::size_t plane = pixels_.size() * 3;
    const auto isLit = [](double v) { return v != 0.0; };
    for (std::size_t s = 0; s < stringSlots_.size(); ++s) {
        const auto at = static_cast<std::ptrdiff_t>(s * plane), end = static_cast<std::ptrdiff_t>((s + 1) * plane);
        if (std::any_of(strings_.begin() + at, strings_.begin() + end, isLit) ||
            std::any_of(splatStrings_.begin() + at, splatStrings_.begin() + end, isLit))
            lit.emplace_back(s, "class." + stringSlots_[s].name());
    }
    return lit;
}

Image Film::image(const std::vector<std::string>& layers) const {
    std::vector<std::string> names{"R", "G", "B"};
    const auto addRgb = [&names](const std::string& layer) {
        for (const char* c : {".R", ".G", ".B"}) names.push_back(layer + c);
    };
    for (const char* l : kLayerNames) addRgb(l);
    const bool albedo = wants(layers, "albedo"), normal = wants(layers, "normal"), depth = wants(layers, "depth"),
               withVariance = wants(layers, "variance"), radius = wants(layers, "radius"),
               photons = wants(layers, "photons"), density = wants(layers, "density"),
               samples = wants(layers, "samples");
    if (albedo) addRgb("albedo");
    if (normal) names.insert(names.end(), {"normal.X", "normal.Y", "normal.Z"});
    if (depth) names.emplace_back("depth.Z");
    if (withVariance) names.emplace_back("variance.Y");
    if (radius) names.emplace_back("radius.Y");
    if (photons) names.emplace_back("photons.Y");
    if (density) names.emplace_back("density.Y");
    if (samples) names.emplace_back("samples.Y");
    const auto strings = litStrings();
    for (const auto& [slot, name] : strings) addRgb(name);
    Image image(width_, height_, names);
    const auto n = static_cast<float>(std::max<std::uint32_t>(1, terms_.count));
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const Pixel& p = pixels_[i];
        Rgb total(0.0F);
        int channel = 3;
        for (int l = 0; l < kPathClasses; ++l, channel += 3) {
            const Rgb value = mean(p, l);
            image.setRgb(i, value, channel);
            total += value;
        }
        image.setRgb(i, total);
        if (albedo) image.setRgb(i, Rgb(p.albedo[0], p.albedo[1], p.albedo[2]) / n, channel), channel += 3;
        if (normal) image.setRgb(i, Rgb(p.normal[0], p.normal[1], p.normal[2]) / n, channel), channel += 3;
        if (depth) image.at(i, channel++) = p.depth / n;
        if (withVariance) image.at(i, channel++) = static_cast<float>(variance(p));
        if (radius) image.at(i, channel++) = p.radius / n;
        if (photons) image.at(i, channel++) = p.photons / n;
        if (density) image.at(i, channel++) = photonDensity(p.photons / n, p.radius / n);
        if (samples) image.at(i, channel++) = static_cast<float>(p.taken);
        for (const auto& [slot, name] : strings)
            for (std::size_t c = 0; c < 3; ++c) image.at(i, channel++) = static_cast<float>(stringMean(slot, i, c));
    }
    return image;
}

}  // namespace pellucid

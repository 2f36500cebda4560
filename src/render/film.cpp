#include <pellucid/render/film.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace pellucid {

namespace {

constexpr const char* kLayerNames[kPathClasses] = {"emission", "direct", "caustic", "indirect"};

[[nodiscard]] bool wants(const std::vector<std::string>& layers, const char* name) {
    return std::any_of(layers.begin(), layers.end(), [name](const std::string& l) { return l == name || l == "all"; });
}

}  // namespace

const std::vector<std::string>& auxiliaryLayers() noexcept {
    static const std::vector<std::string> names{
        "albedo",  "normal",  "depth",         "variance",        "radius",     "photons",      "records",
        "samples", "classes", "record_radius", "record_gradient", "record_age", "record_reuse", "record_reason"};
    return names;
}

Film::Film(int width, int height)
    : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

bool Film::admit(std::size_t pixel, std::uint32_t iteration, const LayeredRadiance& radiance) noexcept {
    if (isFinite(radiance.total())) return true;
    Pixel& p = pixels_[pixel];
    if (p.nonfinite++ == 0) p.firstNonfinite = iteration;
    return false;
}

void Film::add(std::size_t pixel, std::uint32_t iteration, const LayeredRadiance& radiance, const FirstHit& first,
               int samples, std::uint64_t rays) noexcept {
    if (!admit(pixel, iteration, radiance)) return;
    Pixel& p = pixels_[pixel];
    const Rgb total = radiance.total();
    for (std::size_t l = 0; l < kPathClasses; ++l)
        for (glm::length_t c = 0; c < 3; ++c) p.layer[l][c] += static_cast<double>(radiance.layer[l][c]);
    if ((iteration & 1U) != 0)
        for (glm::length_t c = 0; c < 3; ++c) p.half[c] += static_cast<double>(total[c]);
    const double y = static_cast<double>(luminance(total));
    p.square += y * y;
    const double shared = static_cast<double>(radiance.shared), own = y - shared;
    p.blur += static_cast<double>(radiance.blur);
    if ((iteration & 1U) != 0) p.blurHalf += static_cast<double>(radiance.blur);
    p.sharedSum += shared;
    p.sharedSquare += shared * shared;
    p.eyeSum += samples * own;
    p.eyeSquare += samples * own * own;
    p.taken += static_cast<std::uint32_t>(samples);
    p.rays += rays;
    for (glm::length_t c = 0; c < 3; ++c) {
        p.albedo[c] += first.albedo[c];
        p.normal[c] += first.normal[c];
    }
    p.depth += first.depth;
    p.radius += first.kernelRadius;
    p.photons += first.kernelPhotons;
    if (radiance.strings == nullptr || stringSlots_.empty()) return;
    for (const auto& [path, value] : *radiance.strings) {
        double* sum = &strings_[(static_cast<std::size_t>(slotOf_[path.code()]) * pixels_.size() + pixel) * 3];
        for (glm::length_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(value[c]);
    }
}

void Film::setShares(const std::vector<std::uint8_t>& shares) noexcept {
    for (std::size_t i = 0; i < pixels_.size(); ++i) pixels_[i].share = shares[i];
}

std::uint64_t Film::taken() const noexcept {
    std::uint64_t sum = 0;
    for (const Pixel& p : pixels_) sum += p.taken;
    return sum;
}

/// An iteration's mean of k samples has the variance of a sample over k: so k (mean - expectation)^2 has that of a sample.
PixelNoise Film::noise(std::size_t pixel) const noexcept {
    const Pixel& p = pixels_[pixel];
    const double n = samples_, free = std::max(1.0, n - 1.0), taken = std::max<std::uint32_t>(1, p.taken);
    PixelNoise noise;
    noise.eyeVariance = static_cast<float>(std::max(0.0, p.eyeSquare - p.eyeSum * p.eyeSum / taken) / free);
    noise.photonVariance =
        static_cast<float>(std::max(0.0, p.sharedSquare - p.sharedSum * p.sharedSum / std::max(1.0, n)) / free);
    noise.luminance = static_cast<float>(p.eyeSum / taken + p.sharedSum / std::max(1.0, n));
    noise.rays = static_cast<float>(static_cast<double>(p.rays) / taken);
    const double odd = std::max<std::uint32_t>(1, samples_ / 2),
                 even = std::max<std::uint32_t>(1, samples_ - samples_ / 2);
    noise.blur2 = static_cast<float>(p.blurHalf / odd * ((p.blur - p.blurHalf) / even));
    noise.inside = p.taken > 0;
    return noise;
}

void Film::keepStrings(LobeKinds kinds) {
    stringSlots_ = possibleStrings(kinds);
    for (std::size_t i = 0; i < stringSlots_.size(); ++i)
        slotOf_[stringSlots_[i].code()] = static_cast<std::int16_t>(i);
    strings_.assign(stringSlots_.size() * pixels_.size() * 3, 0.0);
    splatStrings_ = strings_;
}

double Film::stringMean(std::size_t slot, std::size_t pixel, std::size_t channel) const noexcept {
    const std::size_t i = (slot * pixels_.size() + pixel) * 3 + channel;
    return strings_[i] / std::max<std::uint32_t>(1, samples_) +
           splatStrings_[i] / std::max<std::uint32_t>(1, splatPasses_);
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

void Film::addSplats(const std::vector<LightSplat>& splats, std::uint32_t pass) noexcept {
    ++splatPasses_;
    for (const LightSplat& s : splats) {
        Pixel& p = pixels_[s.pixel];
        if (!isFinite(s.radiance)) {
            if (p.nonfinite++ == 0) p.firstNonfinite = pass;
            continue;
        }
        p.splatPass += luminance(s.radiance);
        double* string =
            stringSlots_.empty()
                ? nullptr
                : &splatStrings_[(static_cast<std::size_t>(slotOf_[s.path.code()]) * pixels_.size() + s.pixel) * 3];
        for (glm::length_t c = 0; c < 3; ++c) {
            const auto value = static_cast<double>(s.radiance[c]);
            p.splat[static_cast<std::size_t>(s.path.layer())][c] += value;
            if ((pass & 1U) != 0) p.splatHalf[c] += value;
            if (string != nullptr) string[c] += value;
        }
    }
    for (const LightSplat& s : splats) {
        Pixel& p = pixels_[s.pixel];
        p.splatSquare += static_cast<double>(p.splatPass) * static_cast<double>(p.splatPass);
        p.splatPass = 0.0F;
    }
}

Rgb Film::mean(const Pixel& p, int layer) const noexcept {
    Rgb value(0.0F);
    const double n = std::max<std::uint32_t>(1, samples_);
    for (glm::length_t c = 0; c < 3; ++c) {
        double v = p.layer[layer][c] / n;
        if (splatPasses_ > 0) v += p.splat[layer][c] / splatPasses_;
        value[c] = static_cast<float>(v);
    }
    return value;
}

double Film::luminanceOf(const Pixel& p) const noexcept {
    Rgb sum(0.0F);
    for (int l = 0; l < kPathClasses; ++l) sum += mean(p, l);
    return static_cast<double>(luminance(sum));
}

double Film::luminanceAt(int x, int y) const noexcept {
    return luminanceOf(
        pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)]);
}

double Film::meanLuminance() const noexcept {
    double sum = 0.0;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) sum += luminanceAt(x, y);
    return sum / static_cast<double>(std::max<std::size_t>(1, pixels_.size()));
}

double Film::indirectShare() const noexcept {
    const double floor = 0.1 * meanLuminance();
    double sum = 0.0;
    for (const Pixel& p : pixels_) {
        const double value = luminanceOf(p) + floor;
        if (value > 0.0) sum += static_cast<double>(luminance(mean(p, static_cast<int>(PathClass::Indirect)))) / value;
    }
    return sum / static_cast<double>(std::max<std::size_t>(1, pixels_.size()));
}

/// Of the pixel's mean luminance: sample variance over the number of samples, of the eye's samples and of the passes'
/// splats, which are taken as independent of each other.
double Film::variance(const Pixel& p) const noexcept {
    const auto ofMean = [](const double(&layers)[kPathClasses][3], double square, double count) {
        double sum = 0.0;
        for (const auto& l : layers) sum += 0.2126 * l[0] + 0.7152 * l[1] + 0.0722 * l[2];
        const double m = sum / count;
        return std::max(0.0, square / count - m * m) / std::max(1.0, count - 1.0);
    };
    return ofMean(p.layer, p.square, std::max<std::uint32_t>(1, samples_)) +
           ofMean(p.splat, p.splatSquare, std::max<std::uint32_t>(1, splatPasses_));
}

Image Film::image(const std::vector<std::string>& layers) const {
    std::vector<std::string> names{"R", "G", "B"};
    const auto addRgb = [&names](const std::string& layer) {
        for (const char* c : {".R", ".G", ".B"}) names.push_back(layer + c);
    };
    for (const char* l : kLayerNames) addRgb(l);
    const bool albedo = wants(layers, "albedo"), normal = wants(layers, "normal"), depth = wants(layers, "depth"),
               withVariance = wants(layers, "variance"), radius = wants(layers, "radius"),
               photons = wants(layers, "photons"), samples = wants(layers, "samples");
    if (albedo) addRgb("albedo");
    if (normal) names.insert(names.end(), {"normal.X", "normal.Y", "normal.Z"});
    if (depth) names.emplace_back("depth.Z");
    if (withVariance) names.emplace_back("variance.Y");
    if (radius) names.emplace_back("radius.Y");
    if (photons) names.emplace_back("photons.Y");
    if (samples) names.emplace_back("samples.Y");
    const auto strings = litStrings();
    for (const auto& [slot, name] : strings) addRgb(name);
    Image image(width_, height_, names);
    const auto n = static_cast<float>(std::max<std::uint32_t>(1, samples_));
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
        if (samples) image.at(i, channel++) = static_cast<float>(p.taken);
        for (const auto& [slot, name] : strings)
            for (std::size_t c = 0; c < 3; ++c) image.at(i, channel++) = static_cast<float>(stringMean(slot, i, c));
    }
    return image;
}

double Film::relativeBlur2() const noexcept {
    const double odd = samples_ / 2, even = samples_ - samples_ / 2;
    if (odd < 1.0) return 0.0;
    double meanValue = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < pixels_.size(); ++i) meanValue += luminanceOf(pixels_[i]);
    meanValue /= static_cast<double>(pixels_.size());
    const double floor = std::max(0.01 * meanValue * meanValue, 1e-300);
    for (const Pixel& p : pixels_) {
        const double value = luminanceOf(p);
        sum += p.blurHalf / odd * ((p.blur - p.blurHalf) / even) / (value * value + floor);
    }
    return std::max(0.0, sum / static_cast<double>(pixels_.size()));
}

double Film::relativeNoise2() const noexcept {
    const double odd = samples_ / 2, even = samples_ - samples_ / 2;
    if (odd < 1.0) return 1.0;
    const double oddPasses = splatPasses_ / 2, evenPasses = splatPasses_ - splatPasses_ / 2;
    double meanValue = 0.0;
    std::vector<double> value(pixels_.size() * 3), difference(pixels_.size() * 3);
    for (std::size_t i = 0; i < pixels_.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const Pixel& p = pixels_[i];
            double sum = 0.0;
            for (const auto& l : p.layer) sum += l[c];
            double a = p.half[c] / odd, b = (sum - p.half[c]) / even;
            if (oddPasses >= 1.0) {
                double splats = 0.0;
                for (const auto& l : p.splat) splats += l[c];
                a += p.splatHalf[c] / oddPasses;
                b += (splats - p.splatHalf[c]) / evenPasses;
            }
            value[3 * i + c] = 0.5 * (a + b);
            difference[3 * i + c] = 0.5 * (a - b);
            meanValue += value[3 * i + c];
        }
    meanValue /= static_cast<double>(value.size());
    const double floor = 0.01 * meanValue * meanValue;
    double sum = 0.0;
    for (std::size_t i = 0; i < value.size(); ++i) {
        const double d2 = difference[i] * difference[i], v2 = value[i] * value[i] + floor;
        if (v2 > 0.0) sum += d2 / v2;
    }
    return sum / static_cast<double>(value.size());
}

NonFinite Film::nonfinite() const noexcept {
    NonFinite result;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        if (pixels_[i].nonfinite == 0) continue;
        if (result.count == 0) {
            result.x = static_cast<int>(i % static_cast<std::size_t>(width_));
            result.y = static_cast<int>(i / static_cast<std::size_t>(width_));
            result.sample = pixels_[i].firstNonfinite;
        }
        result.count += pixels_[i].nonfinite;
    }
    return result;
}

std::vector<char> Film::save() const {
    std::vector<char> bytes;
    const auto put = [&bytes](const void* from, std::size_t size) {
        bytes.insert(bytes.end(), static_cast<const char*>(from), static_cast<const char*>(from) + size);
    };
    bytes.reserve(savedSize());
    put(&samples_, sizeof samples_);
    put(&splatPasses_, sizeof splatPasses_);
    put(pixels_.data(), pixels_.size() * sizeof(Pixel));
    for (const auto* sums : {&strings_, &splatStrings_}) put(sums->data(), sums->size() * sizeof(double));
    return bytes;
}

std::size_t Film::savedSize() const noexcept {
    return sizeof samples_ + sizeof splatPasses_ + pixels_.size() * sizeof(Pixel) +
           (strings_.size() + splatStrings_.size()) * sizeof(double);
}

bool Film::restore(const std::vector<char>& bytes) {
    if (bytes.size() != savedSize()) return false;
    const char* from = bytes.data();
    const auto take = [&from](void* to, std::size_t size) {
        std::memcpy(to, from, size);
        from += size;
    };
    take(&samples_, sizeof samples_);
    take(&splatPasses_, sizeof splatPasses_);
    take(static_cast<void*>(pixels_.data()), pixels_.size() * sizeof(Pixel));
    for (auto* sums : {&strings_, &splatStrings_}) take(sums->data(), sums->size() * sizeof(double));
    return true;
}

}  // namespace pellucid

#include <pellucid/render/film.h>

#include <cstring>

namespace pellucid {

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
    const double w = terms_.weight;
    for (std::size_t l = 0; l < kPathClasses; ++l)
        for (glm::length_t c = 0; c < 3; ++c) p.layer[l][c] += w * static_cast<double>(radiance.layer[l][c]);
    if ((iteration & 1U) != 0)
        for (glm::length_t c = 0; c < 3; ++c) p.half[c] += w * static_cast<double>(total[c]);
    const double y = static_cast<double>(luminance(total));
    p.squareSum += w * w * y;
    p.squareSquare += w * w * y * y;
    const double shared = static_cast<double>(radiance.shared), own = y - shared;
    p.blur += w * static_cast<double>(radiance.blur);
    p.recordNoise += w * static_cast<double>(radiance.recordNoise);
    if ((iteration & 1U) != 0) p.blurHalf += w * static_cast<double>(radiance.blur);
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
        for (glm::length_t c = 0; c < 3; ++c) sum[c] += w * static_cast<double>(value[c]);
    }
}

void Film::setShares(const std::vector<std::uint8_t>& shares) noexcept {
    for (std::size_t i = 0; i < pixels_.size(); ++i) pixels_[i].share = shares[i];
}

std::vector<std::uint8_t> Film::shares() const {
    std::vector<std::uint8_t> shares;
    shares.reserve(pixels_.size());
    for (const Pixel& p : pixels_) shares.push_back(p.share);
    return shares;
}

std::uint64_t Film::taken() const noexcept {
    std::uint64_t sum = 0;
    for (const Pixel& p : pixels_) sum += p.taken;
    return sum;
}

void Film::keepStrings(LobeKinds kinds) {
    stringSlots_ = possibleStrings(kinds);
    for (std::size_t i = 0; i < stringSlots_.size(); ++i)
        slotOf_[stringSlots_[i].code()] = static_cast<std::int16_t>(i);
    strings_.assign(stringSlots_.size() * pixels_.size() * 3, 0.0);
    splatStrings_ = strings_;
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
    put(&terms_, sizeof terms_);
    put(&splatPasses_, sizeof splatPasses_);
    put(pixels_.data(), pixels_.size() * sizeof(Pixel));
    for (const auto* sums : {&strings_, &splatStrings_}) put(sums->data(), sums->size() * sizeof(double));
    return bytes;
}

std::size_t Film::savedSize() const noexcept {
    return sizeof terms_ + sizeof splatPasses_ + pixels_.size() * sizeof(Pixel) +
           (strings_.size() + splatStrings_.size()) * sizeof(double);
}

bool Film::restore(const std::vector<char>& bytes) {
    if (bytes.size() != savedSize()) return false;
    const char* from = bytes.data();
    const auto take = [&from](void* to, std::size_t size) {
        if (size > 0) std::memcpy(to, from, size);  // an empty vector has no address
        from += size;
    };
    take(&terms_, sizeof terms_);
    take(&splatPasses_, sizeof splatPasses_);
    take(static_cast<void*>(pixels_.data()), pixels_.size() * sizeof(Pixel));
    for (auto* sums : {&strings_, &splatStrings_}) take(sums->data(), sums->size() * sizeof(double));
    return true;
}

}  // namespace pellucid

#include "cache_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <pellucid/base/error.h>

#include "sealed_file.h"

namespace pellucid {

namespace {

constexpr SealedKind kCacheFile{"pellucid cache 5\n", "the cache file", "delete it, or name another: it is made anew"};

/// What a view may have for itself.
constexpr std::array<std::string_view, 13> kOfTheView{
    "photon.caustic", "photon.radius",      "photon.alpha",       "photon.guiding", "path.adaptive",
    "path.sampler",   "reference.texel",    "camera.aperture",    "camera.focus",   "cache.mode",
    "photon.chance",  "photon.caustic_map", "reference.eye_paths"};

/// The last two members are whole numbers.
constexpr std::size_t kFloatsOfRecord = 36;
static_assert(std::is_trivially_copyable_v<IrradianceRecord> &&
              sizeof(IrradianceRecord) == kFloatsOfRecord * sizeof(float) + 2 * sizeof(std::uint32_t));

/// A record that can be looked up without harm.
[[nodiscard]] bool isSound(const IrradianceRecord& record, float reach, const Bounds& scene) noexcept {
    std::array<float, kFloatsOfRecord> numbers{};
    std::memcpy(numbers.data(), &record, sizeof numbers);
    if (!std::all_of(numbers.begin(), numbers.end(), [](float f) { return std::isfinite(f); })) return false;
    // In the tree a record takes cells by its reach: far outside or with a huge one it would take them all.
    const float size = std::max(1e-6F, scene.radius());
    return record.radius > 0.0F && std::isfinite(reach) && reach > 0.0F &&
           glm::length(record.position - scene.centre()) <= 4.0F * size;
}

/// As a user would ask for it.
[[nodiscard]] std::string_view asked(std::string_view value) noexcept { return value == "-1" ? "auto" : value; }

/// Why a file does not fit, in words; empty: it does.
[[nodiscard]] std::string difference(const CacheKey& here, const CacheKey& there) {
    std::string text;
    for (const auto& [name, value] : here.parts) {
        const auto other = std::find_if(there.parts.begin(), there.parts.end(),
                                        [&wanted = name](const auto& part) { return part.first == wanted; });
        if (other != there.parts.end() && other->second == value) continue;
        if (!text.empty()) text += ", ";
        if (name == "scene") return "geometry, materials, lights or environment";
        text += name + "=";
        text += other == there.parts.end() ? "?" : asked(other->second);
        text += " there, ";
        text += asked(value);
        text += " here";
    }
    if (text.empty() && here.parts.size() != there.parts.size()) text = "settings that this version does not know";
    return text;
}

[[nodiscard]] CacheKey getKey(ByteReader& reader) {
    CacheKey key;
    const auto parts = reader.get<std::uint32_t>();
    for (std::uint32_t i = 0; i < parts && reader.good(); ++i) {
        std::string name = reader.getBlock<std::string>(), value = reader.getBlock<std::string>();
        key.parts.emplace_back(std::move(name), std::move(value));
    }
    return key;
}

}  // namespace

CacheKey cacheKey(const Scene& scene, const Settings& resolved, bool causticsApart) {
    CacheKey key;
    key.parts.emplace_back("version", PELLUCID_VERSION);
    key.parts.emplace_back("scene", scene.lightHash());
    key.parts.emplace_back("caustics", causticsApart ? "apart from the records" : "in the records");
    for (const auto& [name, value] : settingsAsText(resolved))
        if (std::find(kOfTheView.begin(), kOfTheView.end(), name) == kOfTheView.end())
            key.parts.emplace_back(name, value);
    return key;
}

std::string cacheBody(const CacheKey& key, const LearntLight& light) {
    ByteWriter body;
    body.put(static_cast<std::uint32_t>(key.parts.size()));
    for (const auto& [name, value] : key.parts) {
        body.putBlock(name);
        body.putBlock(value);
    }
    body.put(light.seed);
    body.put(light.generation);
    body.put(light.views);
    body.put(light.size.globalPaths);
    body.put(light.size.gatherRays);
    body.put(light.size.cacheError);
    body.put(light.size.minSpacing);
    body.put(light.rays);
    body.putBlock(light.seen);
    body.put(light.cache->error());
    body.put(static_cast<std::uint32_t>(light.cache->metric()));
    body.putBlock(light.cache->records());
    body.putBlock(light.cache->reaches());
    body.putBlock(light.cache->lights());
    body.putBlock(light.map ? light.map->save() : std::vector<char>());
    return body.bytes();
}

LearntLight parseCacheBody(std::string_view body, const std::filesystem::path& file, const CacheKey* key,
                           const Bounds& bounds, const Scene* scene) {
    ByteReader reader(body);
    const CacheKey there = getKey(reader);
    if (!reader.good()) refuseDamaged(file, kCacheFile);
    if (const std::string reason = key != nullptr ? difference(*key, there) : std::string(); !reason.empty())
        throw Error(ErrorKind::BadInput, "the cache file was made from something else: " + reason, file.string(),
                    "give the same scene and settings as then, or delete it, or name another");
    LearntLight light;
    light.seed = reader.get<std::uint64_t>();
    light.generation = reader.get<std::uint32_t>();
    light.views = reader.get<std::uint32_t>();
    light.size.globalPaths = reader.get<std::uint32_t>();
    light.size.gatherRays = reader.get<int>();
    light.size.cacheError = reader.get<float>();
    light.size.minSpacing = reader.get<float>();
    light.rays = reader.get<double>();
    light.seen = reader.getBlock<std::vector<std::uint64_t>>();
    const auto error = reader.get<float>();
    const auto metric = reader.get<std::uint32_t>();
    const auto records = reader.getBlock<std::vector<IrradianceRecord>>();
    const auto reaches = reader.getBlock<std::vector<float>>();
    const auto lights = reader.getBlock<std::vector<LightByDirection>>();
    const auto map = reader.getBlock<std::vector<char>>();
    const bool sizes = light.size.gatherRays > 0 && light.size.cacheError > 0.0F && error >= light.size.cacheError &&
                       error < 100.0F && metric <= static_cast<std::uint32_t>(CacheMetric::Hessian) &&
                       light.size.minSpacing >= 0.0F && std::isfinite(light.size.minSpacing) && light.rays >= 0.0;
    const bool mapped = scene != nullptr ? scene->surfaces().mapsDiffuseNormals() : !lights.empty();
    if (!reader.good() || reader.left() > 0 || !sizes || records.size() != reaches.size() ||
        lights.size() != (mapped ? records.size() : 0))
        refuseDamaged(file, kCacheFile);
    auto cache = std::make_shared<IrradianceCache>(bounds, error, static_cast<CacheMetric>(metric), scene);
    for (std::size_t i = 0; i < records.size(); ++i) {
        if (!isSound(records[i], reaches[i], bounds) || (mapped && !isSound(lights[i])))
            refuseDamaged(file, kCacheFile);
        cache->adopt(records[i], reaches[i], mapped ? &lights[i] : nullptr);
    }
    light.cache = std::move(cache);
    if (!map.empty()) {
        light.map = RadianceMap::restore(map);
        if (!light.map) refuseDamaged(file, kCacheFile);
    }
    return light;
}

void writeCacheFile(const std::filesystem::path& file, const CacheKey& key, const LearntLight& light) {
    writeSealed(file, kCacheFile, cacheBody(key, light));
}

std::optional<LearntLight> readCacheFile(const std::filesystem::path& file, const CacheKey& key, const Scene& scene) {
    const auto body = readSealed(file, kCacheFile);
    if (!body) return std::nullopt;
    return parseCacheBody(*body, file, &key, scene.bounds(), &scene);
}

}  // namespace pellucid

/// What views have learnt of a scene's light, on disk: records and global map, versioned, with a checksum and the key of what
/// made them. A file that is damaged or made from another scene or with other settings is refused with the reason.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "learnt_light.h"

namespace pellucid {

/// All that the records depend on, as (name, value): hash of geometry, lights and materials, then settings as resolved.
struct CacheKey {
    std::vector<std::pair<std::string, std::string>> parts;
};

/// Leaves out what only concerns a view: camera, kernels, eye samples. `causticsApart`: records hold no light that came over
/// casters alone, because the caustic map or eye paths bring it.
[[nodiscard]] CacheKey cacheKey(const Scene& scene, const Settings& resolved, bool causticsApart);

/// Throws Error{CannotFinish}.
void writeCacheFile(const std::filesystem::path& file, const CacheKey& key, const LearntLight& light);

/// Empty when there is no such file; throws Error{BadInput} when it is damaged or was made from something else.
[[nodiscard]] std::optional<LearntLight> readCacheFile(const std::filesystem::path& file, const CacheKey& key,
                                                       const Scene& scene);

/// The sealed part of such a file, and back. `key` null: whoever made it. `file` is for errors, `scene` for the records'
/// shadow rays (null: none).
[[nodiscard]] LearntLight parseCacheBody(std::string_view body, const std::filesystem::path& file, const CacheKey* key,
                                         const Bounds& bounds, const Scene* scene = nullptr);
[[nodiscard]] std::string cacheBody(const CacheKey& key, const LearntLight& light);

}  // namespace pellucid

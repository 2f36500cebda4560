/// libFuzzer target: any bytes behind a good checksum are a cache that can be looked up and filled further, or an Error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <pellucid/base/error.h>

#include "../../src/render/cache_file.h"
#include "../../src/render/sealed_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace pellucid;
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);  // NOLINT: bytes as characters
    Bounds scene;
    scene.extend(glm::vec3(-1.0F));
    scene.extend(glm::vec3(1.0F));
    (void)unseal(bytes, SealedKind{"pellucid cache 5\n", "the cache file", "delete it"});
    try {
        const LearntLight light = parseCacheBody(bytes, "fuzz", nullptr, scene);
        const glm::vec3 normal(0.0F, 1.0F, 0.0F);
        for (const float x : {-0.9F, 0.0F, 0.7F}) {
            (void)light.cache->lookup(glm::vec3(x, 0.1F, 0.3F), normal);
            if (light.map) (void)light.map->find(glm::vec3(x, 0.1F, 0.3F), normal);
        }
        (void)cacheBody(CacheKey{}, light);
    } catch (const Error&) {
    }
    return 0;
}

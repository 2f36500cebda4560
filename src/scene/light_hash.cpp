// What the light in a scene depends on, as a digest: what irradiance records of one camera are worth to another. Meshes and
// lights are hashed as they stand, textures by their texels: a file in which only cameras or names differ gives the same.
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include <pellucid/math/hash.h>

#include "scene_impl.h"

namespace pellucid {

namespace {

class Digest {
public:
    template <class T>
    void add(const T& value) noexcept {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        std::uint64_t word = 0;
        std::memcpy(&word, &value, sizeof value);
        addWord(word);
    }
    template <glm::length_t N, class T>
    void add(const glm::vec<N, T>& v) noexcept {
        for (glm::length_t a = 0; a < N; ++a) add(v[a]);
    }
    void add(const glm::dmat4& m) noexcept {
        for (glm::length_t c = 0; c < 4; ++c) add(m[c]);
    }
    void add(const std::string& text) noexcept {
        add(text.size());
        for (const char c : text) add(c);
    }
    template <class T>
    void add(const std::vector<T>& items) noexcept {
        add(items.size());
        for (const T& item : items) add(item);
    }
    void add(const Mesh& m) noexcept {
        add(m.positions), add(m.normals), add(m.tangents);
        add(m.uv0), add(m.uv1), add(m.colors);
        add(m.triangles), add(m.material);
    }
    void add(const Geometry& g) noexcept { add(g.mesh), add(g.toWorld); }
    void add(const TextureRef& t) noexcept {
        add(t.image != nullptr);
        if (!t.image) return;
        add(t.image->width), add(t.image->height), add(t.image->texels8), add(t.image->texels16);
        add(t.srgb), add(t.linear), add(t.wrapS), add(t.wrapT), add(t.uvSet);
        add(t.offset), add(t.scale), add(t.rotation);
    }
    void add(const Material& m) noexcept {
        add(m.baseColor), add(m.baseColorTexture), add(m.metallic), add(m.roughness), add(m.metallicRoughnessTexture);
        add(m.normalTexture), add(m.normalScale), add(m.emission), add(m.emissiveTexture);
        add(m.alphaMode), add(m.alphaCutoff), add(m.doubleSided), add(m.ior);
        add(m.specular), add(m.specularTexture), add(m.specularColor), add(m.specularColorTexture);
        add(m.transmission), add(m.transmissionTexture), add(m.thickness), add(m.absorption);
        add(m.dispersion);
    }
    void add(const PunctualLight& l) noexcept {
        add(l.kind), add(l.position), add(l.direction), add(l.intensity), add(l.innerCone), add(l.outerCone);
    }
    [[nodiscard]] std::string hex() const {
        std::array<char, 33> text{};
        text.fill('0');
        for (std::size_t i = 0; i < 2; ++i) {
            std::array<char, 16> half{};
            const auto end = std::to_chars(half.data(), half.data() + half.size(), state_[i], 16).ptr;
            std::copy(half.data(), end, text.data() + 16 * (i + 1) - (end - half.data()));
        }
        text.back() = 0;
        return text.data();
    }

private:
    void addWord(std::uint64_t word) noexcept {
        state_[0] = hash64(state_[0] ^ word) + 0x9e3779b97f4a7c15ULL;
        state_[1] = hash64(state_[1] + word * 0xff51afd7ed558ccdULL) ^ state_[0];
    }
    std::array<std::uint64_t, 2> state_{};
};

}  // namespace

std::string Scene::lightHash() const {
    const Impl& s = *impl_;
    Digest digest;
    digest.add(s.normalisation.centre), digest.add(s.normalisation.exponent);
    digest.add(s.description.meshes), digest.add(s.description.geometries);
    digest.add(s.description.materials), digest.add(s.description.lights);
    digest.add(s.environmentHash);
    return digest.hex();
}

}  // namespace pellucid

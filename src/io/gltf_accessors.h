/// Reading accessors: any component type, normalised or not, interleaved, sparse. The model has been validated, so that
/// every element lies inside of its buffer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "gltf_asset.h"

namespace tinygltf {
struct Accessor;
}

namespace pellucid {

/// One element's place in memory. Matrices of small components have padded columns (glTF 2.0 section 3.6.2.4).
struct ElementLayout {
    std::size_t components = 0, componentSize = 0, size = 0;
};
[[nodiscard]] ElementLayout elementLayout(const tinygltf::Accessor& accessor);

class AccessorReader {
public:
    AccessorReader(const GltfAsset& asset, int accessor);

    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] std::size_t components() const noexcept { return layout_.components; }

    /// Components beyond the type's own are 0.
    [[nodiscard]] glm::vec4 vector(std::size_t i) const noexcept;
    /// For indices and joints: the integers as they are.
    [[nodiscard]] std::uint32_t index(std::size_t i) const noexcept { return integer(i, 0); }
    [[nodiscard]] std::uint32_t integer(std::size_t i, std::size_t component) const noexcept;
    /// MAT4 of floats.
    [[nodiscard]] glm::dmat4 matrix(std::size_t i) const noexcept;

private:
    void readSparseIndices(const GltfAsset& asset, const tinygltf::Accessor& accessor, int number);
    [[nodiscard]] const std::byte* element(std::size_t i) const noexcept;
    [[nodiscard]] float component(const std::byte* at) const noexcept;

    ElementLayout layout_;
    std::size_t count_ = 0, stride_ = 0;
    int componentType_ = 0;
    bool normalized_ = false;
    const std::byte* base_ = nullptr;
    std::vector<std::uint32_t> sparseIndices_;  ///< strictly increasing
    const std::byte* sparseValues_ = nullptr;
};

}  // namespace pellucid

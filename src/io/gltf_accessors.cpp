#include "gltf_accessors.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include <tiny_gltf.h>

namespace pellucid {
namespace {

template <class T>
[[nodiscard]] T load(const std::byte* at) noexcept {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

/// glTF 2.0 section 3.11: f = max(c / largest, -1).
template <class T>
[[nodiscard]] float fromInteger(const std::byte* at, bool normalized) noexcept {
    const auto value = static_cast<float>(load<T>(at));
    if (!normalized) return value;
    return std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0F);
}

[[nodiscard]] std::uint32_t loadUnsigned(const std::byte* at, int type) noexcept {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return load<std::uint8_t>(at);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<std::uint16_t>(at);
        default:
            return load<std::uint32_t>(at);
    }
}

}  // namespace

ElementLayout elementLayout(const tinygltf::Accessor& accessor) {
    ElementLayout layout;
    layout.components =
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
    layout.componentSize =
        static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)));
    layout.size = layout.components * layout.componentSize;
    if (accessor.type == TINYGLTF_TYPE_MAT2 && layout.componentSize == 1) layout.size = 8;
    if (accessor.type == TINYGLTF_TYPE_MAT3 && layout.componentSize < 4) layout.size = 12 * layout.componentSize;
    return layout;
}

AccessorReader::AccessorReader(const GltfAsset& asset, int number) {
    const tinygltf::Accessor& accessor = asset.model().accessors[static_cast<std::size_t>(number)];
    layout_ = elementLayout(accessor);
    count_ = accessor.count;
    componentType_ = accessor.componentType;
    normalized_ = accessor.normalized;
    base_ = asset.viewBytes(accessor.bufferView).data() + accessor.byteOffset;
    const std::size_t stride = asset.model().bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
    stride_ = stride == 0 ? layout_.size : stride;
    if (accessor.sparse.isSparse) readSparseIndices(asset, accessor, number);
}

void AccessorReader::readSparseIndices(const GltfAsset& asset, const tinygltf::Accessor& accessor, int number) {
    const auto& indices = accessor.sparse.indices;
    const std::byte* at = asset.viewBytes(indices.bufferView).data() + indices.byteOffset;
    const auto size =
        static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(indices.componentType)));
    sparseIndices_.reserve(static_cast<std::size_t>(accessor.sparse.count));
    for (std::size_t i = 0; i < static_cast<std::size_t>(accessor.sparse.count); ++i) {
        const std::uint32_t index = loadUnsigned(at + i * size, indices.componentType);
        if (index >= count_ || (i > 0 && index <= sparseIndices_.back()))
            asset.bad(pellucid::element("accessors", static_cast<std::size_t>(number)) + ".sparse.indices",
                      "the indices do not rise strictly within the accessor", "export the file again");
        sparseIndices_.push_back(index);
    }
    sparseValues_ = asset.viewBytes(accessor.sparse.values.bufferView).data() + accessor.sparse.values.byteOffset;
}

const std::byte* AccessorReader::element(std::size_t i) const noexcept {
    if (!sparseIndices_.empty()) {
        const auto found = std::lower_bound(sparseIndices_.begin(), sparseIndices_.end(), i);
        if (found != sparseIndices_.end() && *found == i)
            return sparseValues_ + static_cast<std::size_t>(found - sparseIndices_.begin()) * layout_.size;
    }
    return base_ + i * stride_;
}

float AccessorReader::component(const std::byte* at) const noexcept {
    switch (componentType_) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return fromInteger<std::int8_t>(at, normalized_);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return fromInteger<std::uint8_t>(at, normalized_);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return fromInteger<std::int16_t>(at, normalized_);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return fromInteger<std::uint16_t>(at, normalized_);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return fromInteger<std::uint32_t>(at, normalized_);
        default:
            return load<float>(at);
    }
}

glm::vec4 AccessorReader::vector(std::size_t i) const noexcept {
    const std::byte* at = element(i);
    glm::vec4 result(0.0F);
    for (std::size_t c = 0; c < std::min<std::size_t>(layout_.components, 4); ++c)
        result[static_cast<glm::length_t>(c)] = component(at + c * layout_.componentSize);
    return result;
}

std::uint32_t AccessorReader::integer(std::size_t i, std::size_t component) const noexcept {
    return loadUnsigned(element(i) + component * layout_.componentSize, componentType_);
}

glm::dmat4 AccessorReader::matrix(std::size_t i) const noexcept {
    const std::byte* at = element(i);
    glm::dmat4 result(1.0);
    for (glm::length_t c = 0; c < 4; ++c)
        for (glm::length_t r = 0; r < 4; ++r)
            result[c][r] = static_cast<double>(load<float>(at + static_cast<std::size_t>(4 * c + r) * sizeof(float)));
    return result;
}

}  // namespace pellucid

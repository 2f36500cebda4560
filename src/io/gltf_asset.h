/// A glTF file taken in as a whole: the model as tinygltf parsed it, checked (gltf_validate.cpp), and the bytes of its
/// buffers. tinygltf opens no file and decodes no image: both are done here, under this room's rules.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <pellucid/surface/texture.h>

#include "content_hash.h"
#include "gltf_error.h"
#include "gltf_json.h"

namespace tinygltf {
class Model;
}

namespace pellucid {

class GltfAsset {
public:
    /// `folder`: where relative references may lead; empty: nowhere.
    GltfAsset(std::vector<std::byte> bytes, std::string name, std::optional<std::filesystem::path> folder,
              GltfNotes& notes);
    GltfAsset(const GltfAsset&) = delete;
    GltfAsset& operator=(const GltfAsset&) = delete;

    [[nodiscard]] const tinygltf::Model& model() const noexcept { return *model_; }
    [[nodiscard]] const GltfJson& json() const noexcept { return json_; }
    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[nodiscard]] GltfNotes& notes() const noexcept { return notes_; }
    /// Of the file and of the other files read so far.
    [[nodiscard]] std::string contentHash() const { return hash_.hex(); }

    [[nodiscard]] std::span<const std::byte> viewBytes(int bufferView) const;

    /// The decoded image, read at its first use.
    [[nodiscard]] std::shared_ptr<const TextureImage> image(int index);

    [[noreturn]] void bad(const std::string& path, const std::string& what, const std::string& mend) const {
        badGltf(name_, path, what, mend);
    }

private:
    void loadBuffers(std::optional<std::span<const std::byte>> binaryChunk);
    [[nodiscard]] std::span<const std::byte> bufferBytes(std::size_t index,
                                                         std::optional<std::span<const std::byte>> binaryChunk);
    void parseModel();
    void fillZeroView();
    [[nodiscard]] std::vector<std::byte> fetch(const std::string& uri, const std::string& path);

    std::string name_;
    std::optional<std::filesystem::path> folder_;
    GltfNotes& notes_;
    std::vector<std::byte> file_;
    GltfJson json_;
    std::vector<std::vector<std::byte>> owned_;  ///< external files, data URIs and the zeros
    std::vector<std::span<const std::byte>> buffers_;
    std::shared_ptr<tinygltf::Model> model_;  ///< shared: its deleter is known where the type is
    std::vector<std::shared_ptr<const TextureImage>> images_;
    ContentHash hash_;
};

}  // namespace pellucid

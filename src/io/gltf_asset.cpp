#include "gltf_asset.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <tiny_gltf.h>

#include <pellucid/io/image_file.h>

#include "file_bytes.h"
#include "gltf_container.h"
#include "gltf_uri.h"
#include "gltf_validate.h"

namespace pellucid {
namespace {

/// Accessors without data are zeros, for sparse ones mostly. More than this would be a small file that asks for a lot.
constexpr std::uint64_t kMaxZeros = std::uint64_t{64} << 20U;

/// References to files are gone from the text; should one be left, it leads nowhere.
[[nodiscard]] tinygltf::FsCallbacks noFiles() {
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = [](const std::string&, void*) { return false; };
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>*, std::string*, const std::string&, void*) {
        return false;
    };
    callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    };
    return callbacks;
}

bool decodeNothing(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
    return true;
}

[[nodiscard]] std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

GltfAsset::GltfAsset(std::vector<std::byte> bytes, std::string name, std::optional<std::filesystem::path> folder,
                     GltfNotes& notes)
    : name_(std::move(name)), folder_(std::move(folder)), notes_(notes), file_(std::move(bytes)) {
    hash_.addFile(file_);
    const GltfContainer container = splitGltf(file_, name_);
    json_ = readGltfJson(container.json, name_);
    images_.resize(json_.images.size());
    parseModel();
    checkExtensions(*this);
    loadBuffers(container.binary);
    fillZeroView();
    validateModel(*this);
}

void GltfAsset::parseModel() {
    model_ = std::make_shared<tinygltf::Model>();
    tinygltf::TinyGLTF parser;
    parser.SetImageLoader(&decodeNothing, nullptr);
    parser.SetFsCallbacks(noFiles());
    std::string error, warning;
    if (json_.text.size() > UINT32_MAX) bad("", "the JSON is larger than 4 GiB", "move its data into binary buffers");
    if (!parser.LoadASCIIFromString(model_.get(), &error, &warning, json_.text.data(),
                                    static_cast<unsigned>(json_.text.size()), ""))
        bad("", "tinygltf refuses it: " + firstLine(error), "export the file again");
}

void GltfAsset::loadBuffers(std::optional<std::span<const std::byte>> binaryChunk) {
    for (std::size_t i = 0; i < json_.buffers.size(); ++i) buffers_.push_back(bufferBytes(i, binaryChunk));
}

std::span<const std::byte> GltfAsset::bufferBytes(std::size_t index,
                                                  std::optional<std::span<const std::byte>> binaryChunk) {
    const BufferSource& source = json_.buffers[index];
    const std::string path = element("buffers", index);
    std::span<const std::byte> bytes;
    if (source.hasUri) {
        owned_.push_back(fetch(source.uri, path + ".uri"));
        bytes = owned_.back();
    } else {
        if (index != 0 || !binaryChunk) bad(path, "the buffer has no uri and no binary chunk", "export the file again");
        bytes = *binaryChunk;
    }
    if (bytes.size() < source.byteLength)
        bad(path + ".byteLength",
            "the buffer claims " + std::to_string(source.byteLength) + " bytes and has " + std::to_string(bytes.size()),
            "copy the buffer's file again in full");
    return bytes.first(static_cast<std::size_t>(source.byteLength));
}

std::vector<std::byte> GltfAsset::fetch(const std::string& uri, const std::string& path) {
    if (isDataUri(uri)) {
        auto decoded = decodeDataUri(uri);
        if (!decoded) bad(path, "the data URI is malformed", "encode it as base64");
        return std::move(*decoded);
    }
    if (!folder_) bad(path, "a file in memory refers to '" + uri + "'", "embed the data");
    auto resolved = resolveInside(*folder_, uri);
    if (!resolved)
        bad(path, "'" + uri + "' is no relative path inside of the scene's folder",
            "put the file beside the scene and refer to it by a relative path");
    std::error_code failure;
    const std::filesystem::path literal = *folder_ / uri;  // some writers do not escape; '%' then stands for itself
    if (!std::filesystem::exists(*resolved, failure) && uri.find("..") == std::string::npos &&
        std::filesystem::exists(literal, failure))
        resolved = literal;
    std::vector<std::byte> bytes = readFileBytes(*resolved, name_ + ": " + path);
    hash_.addFile(bytes);
    return bytes;
}

/// The view of zeros serves every accessor without data: it is as long as the longest of them.
void GltfAsset::fillZeroView() {
    std::uint64_t needed = 1;
    for (std::size_t i = 0; i < model_->accessors.size(); ++i) {
        const tinygltf::Accessor& accessor = model_->accessors[i];
        if (accessor.bufferView != json_.zeroView) continue;
        const ElementLayout layout = elementLayout(accessor);
        if (accessor.count > kMaxZeros || accessor.byteOffset > kMaxZeros ||
            accessor.byteOffset + accessor.count * layout.size > kMaxZeros)
            bad(element("accessors", i) + ".count",
                "an accessor of " + std::to_string(accessor.count) + " elements has no buffer view", "give it data");
        needed = std::max<std::uint64_t>(needed, accessor.byteOffset + accessor.count * layout.size);
    }
    owned_.emplace_back(static_cast<std::size_t>(needed));
    buffers_.emplace_back(owned_.back());
    model_->bufferViews[static_cast<std::size_t>(json_.zeroView)].byteLength = static_cast<std::size_t>(needed);
}

std::span<const std::byte> GltfAsset::viewBytes(int bufferView) const {
    const tinygltf::BufferView& view = model_->bufferViews[static_cast<std::size_t>(bufferView)];
    const std::span<const std::byte> buffer = buffers_[static_cast<std::size_t>(view.buffer)];
    if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset)
        bad(element("bufferViews", static_cast<std::size_t>(bufferView)),
            "the view reaches past the end of its buffer of " + std::to_string(buffer.size()) + " bytes",
            "export the file again");
    return buffer.subspan(view.byteOffset, view.byteLength);
}

std::shared_ptr<const TextureImage> GltfAsset::image(int index) {
    const auto at = static_cast<std::size_t>(index);
    if (images_[at]) return images_[at];
    const ImageSource& source = json_.images[at];
    const std::string path = element("images", at);
    if (source.hasUri == (source.bufferView >= 0))
        bad(path, "an image needs either a uri or a buffer view", "export the file again");
    if (source.hasUri) {
        const std::vector<std::byte> bytes = fetch(source.uri, path + ".uri");
        images_[at] = decodeTexture(bytes, name_ + ": " + path);
    } else {
        images_[at] = decodeTexture(viewBytes(source.bufferView), name_ + ": " + path);
    }
    return images_[at];
}

}  // namespace pellucid

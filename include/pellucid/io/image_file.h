/// Reading and writing image files. The only room that sees OpenImageIO.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>

#include <pellucid/math/image.h>
#include <pellucid/scene/description.h>
#include <pellucid/surface/texture.h>

namespace pellucid {

using ImageMetadata = std::map<std::string, std::string>;

/// Any format that OpenImageIO reads (EXR, HDR, PFM, PNG, ...), as float. EXR keeps its channel names; in others
/// three or four channels are R G B (A), one or two Y (A). 8- and 16-bit integers are taken as sRGB-encoded and made
/// linear.
[[nodiscard]] Image readImage(const std::filesystem::path& file);

/// Float32 EXR with every channel of `image` by name. Written to a temporary name and renamed: whole or absent.
void writeExr(const std::filesystem::path& file, const Image& image, const ImageMetadata& metadata);

/// 8-bit sRGB PNG of the channels R G B scaled by 2^exposure, clipped to [0, 1]. Atomic as writeExr.
void writePng(const std::filesystem::path& file, const Image& image, float exposure,
              const ImageMetadata& metadata = {});

/// Throws Error{CannotFinish} unless a file of this name could be written: the folder exists and is writable, and the
/// extension is one of .exr .png .hdr .pfm.
void checkWritable(const std::filesystem::path& file);

/// Decodes an image in memory (PNG, JPEG, ...) for a texture. `where` names it in errors.
[[nodiscard]] std::shared_ptr<const TextureImage> decodeTexture(std::span<const std::byte> bytes,
                                                                const std::string& where);

/// `--env`: a file (equirectangular HDR or EXR) or "R,G,B". NaN, infinite and negative texels become 0 and are counted.
[[nodiscard]] EnvironmentDescription loadEnvironment(const std::string& argument);

}  // namespace pellucid

#include "exr_limits.h"

#include <mutex>

#include <OpenEXR/ImfHeader.h>

#include "image_read.h"

namespace pellucid {

void limitExrHeaders() {
    static std::once_flag once;
    std::call_once(once, [] {
        Imf::Header::setMaxImageSize(kMaxImageDimension, kMaxImageDimension);
        Imf::Header::setMaxTileSize(kMaxImageDimension, kMaxImageDimension);
    });
}

}  // namespace pellucid

/// OpenEXR sets up line buffers by what a file's header claims before anyone can look at the size: a few hundred bytes can ask
/// for gigabytes.
#pragma once

namespace pellucid {

/// From now on OpenEXR refuses headers of images and tiles wider or higher than kMaxImageDimension. Holds for the whole
/// process, as OpenEXR has it; may be called again, from any thread.
void limitExrHeaders();

}  // namespace pellucid

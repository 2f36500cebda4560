/// libFuzzer target: any bytes under the name of an environment map are a map of finite radiances >= 0, or an Error. The
/// first byte chooses the format that the name claims.
#include <array>
#include <new>

#include <pellucid/base/error.h>
#include <pellucid/io/image_file.h>

#include "scratch.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace pellucid;
    if (size == 0) return 0;
    static const std::array<fuzz::ScratchFile, 3> kFiles{fuzz::ScratchFile("map.exr"), fuzz::ScratchFile("map.hdr"),
                                                         fuzz::ScratchFile("map.pfm")};
    const auto file = kFiles[data[0] % kFiles.size()].write(data + 1, size - 1);
    try {
        const EnvironmentDescription sky = loadEnvironment(file.string());
        fuzz::require(sky.map.width() > 0 && sky.map.height() > 0 && sky.map.channels() == 3);
        for (std::size_t i = 0; i < sky.map.pixels(); ++i) {
            const Rgb c = sky.map.rgb(i);
            fuzz::require(isFinite(c) && c.r >= 0.0F && c.g >= 0.0F && c.b >= 0.0F);
        }
    } catch (const Error&) {
    } catch (const std::bad_alloc&) {  // the command's message "out of memory"
    }
    return 0;
}

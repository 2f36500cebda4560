/// libFuzzer target: any bytes as a checkpoint are a state or an Error. They are read twice: as the file, and as the body
/// of one whose checksum is right; what comes out is given to a film, which takes it whole or not at all.
#include <string>

#include <pellucid/base/error.h>
#include <pellucid/render/film.h>

#include "../../src/render/checkpoint.h"
#include "scratch.h"

namespace {

void readBack(const std::filesystem::path& file) {
    using namespace pellucid;
    try {
        const auto state = readCheckpoint(file, {"key"});
        fuzz::require(state.has_value());
        Film film(2, 2);
        const std::vector<char> before = film.save();
        if (film.restore(state->film))
            fuzz::require(film.save() == state->film);
        else
            fuzz::require(film.save() == before);
    } catch (const Error&) {
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const pellucid::fuzz::ScratchFile kFile("render.state");
    readBack(kFile.write(data, size));
    const std::string sealed = pellucid::sealedCheckpoint(std::string(data, data + size));
    readBack(kFile.write(sealed.data(), sealed.size()));
    return 0;
}

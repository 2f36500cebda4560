/// libFuzzer target: any bytes as a file of settings are settings in their ranges, which read back as themselves, or an
/// Error; and so is any "name=value" of --set.
#include <string>

#include <pellucid/base/error.h>
#include <pellucid/render/settings.h>

#include "scratch.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace pellucid;
    static const fuzz::ScratchFile kFile("settings.toml");
    const std::string text(data, data + size);
    const std::string file = kFile.write(data, size).string();
    Settings settings;
    try {
        loadSettings(settings, file);
        (void)tunedSceneHash(file);
    } catch (const Error&) {
    }
    try {
        const std::size_t equals = text.find('=');
        if (equals != std::string::npos) setParameter(settings, text.substr(0, equals), text.substr(equals + 1));
    } catch (const Error&) {
    }
    Settings again;
    for (const auto& [name, value] : settingsAsText(settings)) setParameter(again, name, value);  // none may be refused
    fuzz::require(settingsAsText(again) == settingsAsText(settings));
    return 0;
}

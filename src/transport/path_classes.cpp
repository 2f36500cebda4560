#include <pellucid/transport/path_classes.h>

#include <array>

namespace pellucid {

std::string PathString::name() const {
    std::string text = "E";
    for (unsigned rest = code() & kNamed; rest != 0; rest >>= 2U) text += "?SGD"[rest & 3U];
    if (code() > kNamed) text += '_';
    return text + 'L';
}

std::vector<PathString> possibleStrings(LobeKinds kinds) {
    std::array<bool, PathString::kCodes> known{};
    std::vector<PathString> strings{PathString()};
    known[0] = true;
    const auto note = [&](PathString s) {
        if (known[s.code()]) return;
        known[s.code()] = true;
        strings.push_back(s);
    };
    for (std::size_t i = 0; i < strings.size(); ++i) {
        for (const LobeKinds kind : {kSpecular, kGlossy, kDiffuse}) {
            if ((kinds & kind) == kNoLobe) continue;
            PathString next = strings[i];
            next.pass(kind);
            note(next);
            if (kind == kDiffuse) note(next.open());  // what a cache or a map returns
        }
    }
    return strings;
}

}  // namespace pellucid

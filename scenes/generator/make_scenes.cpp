/// make_scenes OUTDIR: writes every scene of this folder as OUTDIR/NAME.glb, the same bytes each time.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "scenes.h"

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: make_scenes OUTDIR\n");
        return 1;
    }
    const std::vector<std::pair<std::string, scenes::GlbWriter (*)()>> all = {
        {"glass-and-mirror", scenes::glassAndMirror},
        {"goblet", scenes::goblet},
        {"pool", scenes::pool},
        {"prism-spot", scenes::prismSpot},
        {"rainbow", scenes::rainbow},
        {"lens-point", scenes::lensPoint},
        {"ring", scenes::ring},
        {"rough-metal", scenes::roughMetal},
        {"diffuse-room", scenes::diffuseRoom},
        {"two-rooms", scenes::twoRooms},
        {"many-lamps", scenes::manyLamps},
        {"corner-open", scenes::cornerOpen},
        {"textured", scenes::textured},
    };
    try {
        const std::filesystem::path folder = argv[1];
        std::filesystem::create_directories(folder);
        for (const auto& [name, make] : all) {
            const std::filesystem::path file = folder / (name + ".glb");
            make().write(file);
            std::printf("%-28s %8ju bytes\n", file.string().c_str(),
                        static_cast<std::uintmax_t>(std::filesystem::file_size(file)));
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make_scenes: error: %s\n", error.what());
        return 3;
    }
    return 0;
}

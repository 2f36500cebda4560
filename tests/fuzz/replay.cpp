/// Runs a fuzz target without libFuzzer, for the default tests and any compiler: every seed as it is, then with changes
/// that a fixed key draws (bytes flipped, set, cut out, repeated, taken from another seed), so that each run tries the same.
/// usage: TARGET_replay FOLDER CHANGES; the input that breaks the target is left as crash-input in the working folder
#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include <pellucid/math/hash.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;

class Numbers {
public:
    explicit Numbers(std::uint64_t key) : key_(key) {}
    /// Below `count`; 0 for 0.
    [[nodiscard]] std::size_t below(std::size_t count) {
        const std::uint64_t bits = pellucid::hashCombine(key_, counter_++);
        return count == 0 ? 0 : static_cast<std::size_t>(bits % count);
    }

private:
    std::uint64_t key_, counter_ = 0;
};

void change(Bytes& bytes, const std::vector<Bytes>& seeds, Numbers& random) {
    const std::size_t at = random.below(bytes.size()), rest = bytes.size() - at;
    const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    const auto length = static_cast<std::ptrdiff_t>(random.below(std::min<std::size_t>(rest, 64) + 1));
    static constexpr std::uint8_t kBytes[] = {0, 1, 0x7f, 0x80, 0xff, '0', '9', '-', '"', '{', ']', '=', '\n'};
    switch (random.below(6)) {
        case 0:
            if (rest > 0) *place = static_cast<std::uint8_t>(*place ^ (1U << random.below(8)));
            break;
        case 1:
            std::fill(place, place + std::min<std::ptrdiff_t>(length, 8), kBytes[random.below(std::size(kBytes))]);
            break;
        case 2:
            bytes.erase(place, place + length);
            break;
        case 3:
            bytes.resize(at);
            break;
        case 4: {
            const Bytes again(place, place + length);
            bytes.insert(place, again.begin(), again.end());
            break;
        }
        default: {
            const Bytes& other = seeds[random.below(seeds.size())];
            const auto from = other.begin() + static_cast<std::ptrdiff_t>(random.below(other.size()));
            std::copy_n(from, std::min<std::ptrdiff_t>(length, other.end() - from), std::back_inserter(bytes));
        }
    }
}

const Bytes* running = nullptr;  ///< for the handler, which may call little more than write()

void keepInput(int signal) {
    const int file = open("crash-input", O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (file >= 0 && running != nullptr && write(file, running->data(), running->size()) >= 0) (void)close(file);
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

void run(const Bytes& bytes) {
    running = &bytes;
    (void)LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 3) return std::fprintf(stderr, "usage: %s FOLDER CHANGES\n", arguments[0]), 1;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(arguments[1])) files.push_back(entry.path());
    std::ranges::sort(files);
    std::vector<Bytes> seeds;
    for (const auto& file : files) {
        std::ifstream stream(file, std::ios::binary);
        seeds.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    }
    if (seeds.empty()) return std::fprintf(stderr, "no seeds in %s\n", arguments[1]), 1;
    for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE}) std::signal(signal, keepInput);
    const int changes = std::atoi(arguments[2]);
    Numbers random(1);
    for (const Bytes& seed : seeds) {
        run(seed);
        for (int i = 0; i < changes; ++i) {
            Bytes bytes = seed;
            for (std::size_t n = 1 + random.below(4); n > 0; --n) change(bytes, seeds, random);
            run(bytes);
        }
    }
    std::printf("%zu seeds, %zu inputs\n", seeds.size(), seeds.size() * static_cast<std::size_t>(changes + 1));
    return 0;
}

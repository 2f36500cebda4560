#include "checkpoint.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>

#include <pellucid/base/error.h>
#include <pellucid/math/hash.h>

namespace pellucid {

namespace {

constexpr char kMagic[] = "pellucid checkpoint 3\n";

[[nodiscard]] std::uint64_t checksum(const std::string& bytes) noexcept {
    std::uint64_t sum = bytes.size();
    for (const char c : bytes) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
    return hash64(sum);
}

template <class T>
void put(std::string& out, const T& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);  // NOLINT: plain bytes of this machine
}

/// Reads in order from a block whose length was checked by the checksum; runs dry safely.
struct Reader {
    const std::string& bytes;
    std::size_t at = 0;
    bool good = true;

    template <class T>
    [[nodiscard]] T get() noexcept {
        T value{};
        if (bytes.size() - at < sizeof value) good = false;
        else std::memcpy(&value, bytes.data() + at, sizeof value), at += sizeof value;
        return value;
    }
    [[nodiscard]] std::string text(std::uint64_t length) {
        if (bytes.size() - at < length) return good = false, std::string();
        at += length;
        return bytes.substr(at - length, length);
    }
};

[[nodiscard]] Error damaged(const std::filesystem::path& file) {
    return {ErrorKind::BadInput, "the checkpoint is damaged", file.string(), "delete it and render from the start"};
}

}  // namespace

std::string sealedCheckpoint(const std::string& body) {
    std::string file = kMagic;
    put(file, checksum(body));
    return file + body;
}

void writeCheckpoint(const std::filesystem::path& file, const CheckpointKey& key, const CheckpointState& state) {
    std::string body;
    put(body, static_cast<std::uint64_t>(key.text.size()));
    body += key.text;
    put(body, state.iteration);
    put(body, state.generation);
    put(body, state.raysOfGeneration);
    put(body, state.raysSince);
    put(body, state.causticPaths);
    for (const std::vector<char>* block : {&state.film, &state.training, &state.radii}) {
        put(body, static_cast<std::uint64_t>(block->size()));
        body.append(block->begin(), block->end());
    }
    const std::string bytes = sealedCheckpoint(body);
    const std::filesystem::path temporary = file.string() + ".tmp";
    std::ofstream out(temporary, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    std::error_code failed;
    if (out) std::filesystem::rename(temporary, file, failed);
    if (!out || failed) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        throw Error(ErrorKind::CannotFinish, "the checkpoint could not be written", file.string(), "check the folder, its rights and the space left");
    }
}

std::optional<CheckpointState> readCheckpoint(const std::filesystem::path& file, const CheckpointKey& key) {
    std::ifstream in(file, std::ios::binary);
    if (!in) return std::nullopt;
    const std::string all((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    const std::size_t magic = sizeof kMagic - 1, head = magic + sizeof(std::uint64_t);
    if (all.size() < head || all.compare(0, magic, kMagic) != 0) throw damaged(file);
    std::uint64_t sum = 0;
    std::memcpy(&sum, all.data() + magic, sizeof sum);
    const std::string body = all.substr(head);
    if (checksum(body) != sum) throw damaged(file);
    Reader reader{body};
    const std::string owner = reader.text(reader.get<std::uint64_t>());
    if (owner != key.text)
        throw Error(ErrorKind::BadInput, "the checkpoint belongs to another render (scene, camera, size, seed, method or settings differ)", file.string(),
                    "give the same arguments as before, or delete it");
    CheckpointState state;
    state.iteration = reader.get<std::uint32_t>();
    state.generation = reader.get<std::uint32_t>();
    state.raysOfGeneration = reader.get<double>();
    state.raysSince = reader.get<double>();
    state.causticPaths = reader.get<std::uint32_t>();
    for (std::vector<char>* block : {&state.film, &state.training, &state.radii}) {
        const std::string bytes = reader.text(reader.get<std::uint64_t>());
        block->assign(bytes.begin(), bytes.end());
    }
    if (!reader.good) throw damaged(file);
    return state;
}

}  // namespace pellucid

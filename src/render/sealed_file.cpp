#include "sealed_file.h"

#include <fstream>
#include <iterator>

#include <pellucid/base/error.h>
#include <pellucid/io/plain_file.h>
#include <pellucid/math/hash.h>

namespace pellucid {

namespace {

[[nodiscard]] std::uint64_t checksum(std::string_view bytes) noexcept {
    std::uint64_t sum = bytes.size();
    for (const char c : bytes) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
    return hash64(sum);
}

}  // namespace

void refuseDamaged(const std::filesystem::path& file, const SealedKind& kind) {
    throw Error(ErrorKind::BadInput, std::string(kind.name) + " is damaged", file.string(), std::string(kind.mend));
}

std::string seal(const SealedKind& kind, std::string_view body) {
    ByteWriter head;
    head.put(checksum(body));
    return std::string(kind.magic) + head.bytes() + std::string(body);
}

std::optional<std::string> unseal(std::string_view bytes, const SealedKind& kind) {
    if (!bytes.starts_with(kind.magic)) return std::nullopt;
    ByteReader reader(bytes.substr(kind.magic.size()));
    const auto sum = reader.get<std::uint64_t>();
    const std::string_view body = bytes.substr(bytes.size() - reader.left());
    if (!reader.good() || checksum(body) != sum) return std::nullopt;
    return std::string(body);
}

void writeSealed(const std::filesystem::path& file, const SealedKind& kind, std::string_view body) {
    writeFile(file, seal(kind, body));
}

std::optional<std::string> readSealed(const std::filesystem::path& file, const SealedKind& kind) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return std::nullopt;
    std::ifstream in(file, std::ios::binary);
    if (!in || std::filesystem::is_directory(file, ignored))
        throw Error(ErrorKind::BadInput, std::string(kind.name) + " cannot be read", file.string(),
                    "give a file that may be read");
    const std::string all((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    const std::string_view name = kind.magic.substr(0, kind.magic.find_last_of(' ') + 1);
    if (all.starts_with(name) && !all.starts_with(kind.magic))
        throw Error(ErrorKind::BadInput, std::string(kind.name) + " is of another version of this program",
                    file.string(), std::string(kind.mend));
    auto body = unseal(all, kind);
    if (!body) refuseDamaged(file, kind);
    return body;
}

}  // namespace pellucid

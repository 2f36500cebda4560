/// Files of this program's own that must never be half read: a line that names kind and version, a checksum, then the bytes.
/// Written whole or not at all. Numbers are in this machine's byte order: such a file is not for carrying elsewhere.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace pellucid {

/// A kind of sealed file: `magic` ends in a version and a line break; `name` ("the checkpoint") and `mend` are for errors.
struct SealedKind {
    std::string_view magic, name, mend;
};

/// Throws Error{CannotFinish}.
void writeSealed(const std::filesystem::path& file, const SealedKind& kind, std::string_view body);

/// Empty when there is no such file; throws Error{BadInput} when it is damaged or of another kind or version.
[[nodiscard]] std::optional<std::string> readSealed(const std::filesystem::path& file, const SealedKind& kind);

/// The body of a sealed file that is in memory; empty when it is damaged.
[[nodiscard]] std::optional<std::string> unseal(std::string_view bytes, const SealedKind& kind);
[[nodiscard]] std::string seal(const SealedKind& kind, std::string_view body);

/// Throws the Error{BadInput} of a file that ends too early or says what cannot be.
[[noreturn]] void refuseDamaged(const std::filesystem::path& file, const SealedKind& kind);

/// Appends plain values and blocks with their length.
class ByteWriter {
public:
    template <class T>
    void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);  // NOLINT: plain bytes of this machine
    }
    template <class Block>
    void putBlock(const Block& block) {
        using Item = typename Block::value_type;
        static_assert(std::is_trivially_copyable_v<Item>);
        put(static_cast<std::uint64_t>(block.size()));
        if (block.size() > 0)
            bytes_.append(reinterpret_cast<const char*>(block.data()), block.size() * sizeof(Item));  // NOLINT
    }
    [[nodiscard]] const std::string& bytes() const noexcept { return bytes_; }

private:
    std::string bytes_;
};

/// Reads in the order of writing. Runs dry safely: from the first value that is not there on, all are zero and good() is false.
class ByteReader {
public:
    explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

    template <class T>
    [[nodiscard]] T get() noexcept {
        static_assert(std::is_trivially_copyable_v<T>);
        T value{};
        if (left() < sizeof value)
            fail();
        else
            std::memcpy(&value, bytes_.data() + at_, sizeof value), at_ += sizeof value;
        return value;
    }
    template <class Block>
    [[nodiscard]] Block getBlock() {
        using Item = typename Block::value_type;
        const auto count = get<std::uint64_t>();
        if (count > left() / sizeof(Item)) return fail(), Block();
        Block block(static_cast<std::size_t>(count), Item{});
        if (count > 0) std::memcpy(block.data(), bytes_.data() + at_, block.size() * sizeof(Item));
        at_ += block.size() * sizeof(Item);
        return block;
    }
    [[nodiscard]] bool good() const noexcept { return good_; }
    [[nodiscard]] std::size_t left() const noexcept { return bytes_.size() - at_; }

private:
    void fail() noexcept {
        good_ = false;
        at_ = bytes_.size();
    }

    std::string_view bytes_;
    std::size_t at_ = 0;
    bool good_ = true;
};

}  // namespace pellucid

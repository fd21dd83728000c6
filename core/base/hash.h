#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace tetrace {

/// XXH3, 64 bits, of raw bytes; `seed` chains hashes.
[[nodiscard]] std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t seed = 0);

/// The same of bytes that come in pieces.
class Hasher {
public:
    Hasher();
    ~Hasher();
    Hasher(const Hasher&) = delete;
    Hasher& operator=(const Hasher&) = delete;

    void add(std::span<const std::byte> bytes);
    /// Of all bytes so far.
    [[nodiscard]] std::uint64_t hash() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The same over a contiguous range of plain data without padding.
template <class Range>
[[nodiscard]] std::uint64_t hash_of(const Range& range, std::uint64_t seed = 0)
{
    return hash_bytes(std::as_bytes(std::span(range)), seed);
}

/// 16 lower-case hexadecimal digits, as hashes are printed everywhere.
[[nodiscard]] std::string hash_text(std::uint64_t hash);

} // namespace tetrace

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace tetrace {

/// Compiled programs in a folder, a file each: `<16 digits>.bin`, the digits being the key; first 8 bytes of hash
/// (core/base/hash.h), then what was compiled, so that a damaged file never reaches a driver. Nothing here throws: a
/// cache that cannot be read or written is none.
class ProgramCache {
public:
    /// folder: empty keeps nothing; it is made when first written to.
    explicit ProgramCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// What was kept under a key; empty where nothing was, or where it is damaged.
    [[nodiscard]] std::optional<std::vector<unsigned char>> find(std::uint64_t key) const;
    void keep(std::uint64_t key, std::span<const unsigned char> program) const;

private:
    [[nodiscard]] std::filesystem::path path_of(std::uint64_t key) const;

    std::filesystem::path folder_;
};

} // namespace tetrace

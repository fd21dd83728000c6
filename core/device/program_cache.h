#pragma once

#include "core/base/hash.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace tetrace {

/// Compiled programs in a folder, one file each, `<16 digits>.bin`; the digits are the key. A file is 8 bytes of hash
/// (core/base/hash.h), then the program, so that a damaged file never reaches a driver. Nothing here throws: a cache
/// that cannot be read or written counts as empty.
class ProgramCache {
public:
    /// folder: created when first written to; empty: nothing is kept.
    explicit ProgramCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Whether it has a folder.
    [[nodiscard]] bool keeps() const { return !folder_.empty(); }
    /// The program kept under a key; empty if there is none, or it is damaged.
    [[nodiscard]] std::optional<std::vector<unsigned char>> find(std::uint64_t key) const;
    void keep(std::uint64_t key, std::span<const unsigned char> program) const;

private:
    [[nodiscard]] std::filesystem::path path_of(std::uint64_t key) const { return folder_ / (hash_text(key) + ".bin"); }

    std::filesystem::path folder_;
};

} // namespace tetrace

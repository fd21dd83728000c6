#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tetrace {

/// Hashes three words of 32 bits (vertex indices, or the bits of three floats) for hash tables.
struct TripleHash {
    template <class Word>
    std::size_t operator()(const std::array<Word, 3>& key) const
    {
        std::uint64_t hash = 0;
        for (const Word word : key)
            hash = (hash ^ static_cast<std::uint32_t>(word)) * 0x9E3779B97F4A7C15u + (hash >> 29);
        return hash;
    }
};

} // namespace tetrace

#include "bench/browser/answer_hash.h"

#include <bit>

namespace tetrace {

namespace {

using Words = std::array<std::uint32_t, HIT_WORDS>;

/// Multiply and shift, word after word; the end is that of MurmurHash3 (Appleby 2011).
std::uint32_t hash_of_ray(const Words& words, std::uint32_t factor)
{
    std::uint32_t hash = 0x9E3779B9u;
    for (const std::uint32_t word : words) {
        hash = (hash ^ word) * factor;
        hash ^= hash >> 13;
    }
    hash *= 0xC2B2AE35u;
    return hash ^ (hash >> 16);
}

} // namespace

std::array<std::uint32_t, 2> hash_of_words(std::span<const std::uint32_t> words)
{
    std::uint32_t low = 0, high = 0;
    for (const std::uint32_t word : words) {
        low = (std::rotl(low, 5) ^ word) * 0x9E3779B1u;
        high = (std::rotl(high, 7) ^ (word * 0x27D4EB2Fu)) * 0x85EBCA77u;
    }
    return {low, high};
}

AnswerHashes answer_hashes(std::span<const Hit> hits)
{
    AnswerHashes hashes;
    hashes.rays.reserve(hits.size());
    auto& [low, high] = hashes.view;
    for (const Hit& hit : hits) {
        const auto words = std::bit_cast<Words>(hit);
        const std::uint32_t a = hash_of_ray(words, 0x85EBCA6Bu), b = hash_of_ray(words, 0x27D4EB2Fu);
        low = (std::rotl(low, 5) ^ a) * 0x9E3779B1u;
        high = (std::rotl(high, 7) ^ b) * 0x85EBCA77u;
        hashes.rays.push_back(static_cast<std::uint8_t>(a));
    }
    return hashes;
}

} // namespace tetrace

#include "core/base/hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace tetrace {

std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t seed)
{
    return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

struct Hasher::State {
    XXH3_state_t bytes;
};

Hasher::Hasher() : state_(std::make_unique<State>())
{
    XXH3_64bits_reset(&state_->bytes);
}

Hasher::~Hasher() = default;

void Hasher::add(std::span<const std::byte> bytes)
{
    XXH3_64bits_update(&state_->bytes, bytes.data(), bytes.size());
}

std::uint64_t Hasher::hash() const
{
    return XXH3_64bits_digest(&state_->bytes);
}

std::string hash_text(std::uint64_t hash)
{
    std::string text(16, '0');
    for (auto digit = text.rbegin(); digit != text.rend(); ++digit, hash >>= 4)
        *digit = "0123456789abcdef"[hash & 15];
    return text;
}

} // namespace tetrace

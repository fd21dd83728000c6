#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tetrace {

/// A share of a run. Parts (views, batches of searches) are dealt out by number, in turn: shard 2 of 4 has parts 1, 5,
/// 9 and so on of those that were asked for.
struct Shard {
    unsigned number = 1, of = 1; ///< number: from 1

    [[nodiscard]] bool is_whole() const { return of == 1; }
    /// The number of parts of this shard, for a total number of parts.
    [[nodiscard]] std::size_t share(std::size_t parts) const { return (parts + of - number) / of; }
    /// The number, among all parts, of its part at an index.
    [[nodiscard]] std::size_t part(std::size_t index) const { return number - 1 + index * of; }

    friend bool operator==(const Shard&, const Shard&) = default;
};

inline constexpr unsigned max_shards = 65'536;

/// "2/4".
[[nodiscard]] std::string text_of(const Shard& shard);

/// Reads "2/4". Throws Error{usage}.
[[nodiscard]] Shard parse_shard(const std::string& text);

/// The shard's parts.
template <class T>
[[nodiscard]] std::vector<T> dealt(const std::vector<T>& parts, const Shard& shard)
{
    std::vector<T> own;
    for (std::size_t i = 0; i < shard.share(parts.size()); ++i)
        own.push_back(parts[shard.part(i)]);
    return own;
}

} // namespace tetrace

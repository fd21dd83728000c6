#pragma once

#include "bench/options/options.h"
#include "core/base/did_you_mean.h"
#include "core/base/error.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tetrace {

/// "a, b or c".
[[nodiscard]] std::string join_alternatives(const std::vector<std::string>& names);

/// Splits at commas. Throws Error{usage} naming the option where a part is empty.
[[nodiscard]] std::vector<std::string> split_list(const std::string& option, const std::string& text);
/// The same of scenes: what is the name of a file stays whole, its commas included; the longest such name counts.
[[nodiscard]] std::vector<std::string> split_scenes(const std::string& option, const std::string& text);

/// Throws Error{usage}: the value is not accepted; lists the accepted ones.
[[noreturn]] void reject_value(const std::string& option, const std::string& value, const std::string& accepted);
/// The same, with a guess which of the names was meant. more: what else is accepted, such as " or a file".
/// As --views takes them: "0-3", "0-1281:20", "0,5,6".
[[nodiscard]] std::string views_text(const std::vector<std::uint64_t>& views);

[[noreturn]] void reject_name(const std::string& option, const std::string& value,
                              const std::vector<std::string>& names, const std::string& more = {});

template <class T>
[[nodiscard]] std::vector<std::string> all_names(const std::vector<T>& values = values_of<T>())
{
    std::vector<std::string> names;
    for (const T& value : values)
        names.emplace_back(name_of(value));
    return names;
}
/// "a, b or c": the names of values.
template <class T>
[[nodiscard]] std::string join_names(const std::vector<T>& values)
{
    return join_alternatives(all_names(values));
}

/// The value with that name. Throws Error{usage} listing the names where there is none.
template <class T>
[[nodiscard]] T choose(const std::string& option, const std::string& text,
                       const std::vector<T>& values = values_of<T>())
{
    for (const T& value : values)
        if (name_of(value) == text) return value;
    reject_name(option, text, all_names(values));
}

/// A whole number in [low, high]. Throws Error{usage} naming the bounds.
[[nodiscard]] std::uint64_t parse_count(const std::string& option, const std::string& text, std::uint64_t low,
                                        std::uint64_t high);

/// Seconds, positive and finite: "90", "1.5", "10m", "2h". Throws Error{usage}.
[[nodiscard]] double parse_seconds(const std::string& option, const std::string& text);

/// Seconds that a sample lasts at least, 0 to 60: a driver has minutes for a call. Throws Error{usage}.
[[nodiscard]] double parse_sample_time(const std::string& text);

/// A percentage from 0 to 100: "3", "2.5" or "3%". Throws Error{usage}.
[[nodiscard]] double parse_percent(const std::string& option, const std::string& text);

/// Bytes: a whole number with K, M, G or T (powers of 1024). Throws Error{usage}.
[[nodiscard]] std::uint64_t parse_bytes(const std::string& option, const std::string& text);

/// "WxH", or "N" for N x N; each from 1 to 16384. Throws Error{usage}.
[[nodiscard]] std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& option, const std::string& text);

/// "8x4" or "8x8": the height. Throws Error{usage}.
[[nodiscard]] unsigned parse_tile_height(const std::string& text);
[[nodiscard]] std::vector<std::string> tile_names();

/// One of packet_widths. Throws Error{usage}.
[[nodiscard]] unsigned parse_packet_lanes(const std::string& text);
[[nodiscard]] std::vector<std::string> packet_lane_names();

/// The expression, unchanged. Throws Error{usage} if it is not a regular expression (name_filter.h).
[[nodiscard]] std::string parse_filter(const std::string& text);

/// The label as it is: one line. Throws Error{usage}.
[[nodiscard]] std::string parse_label(const std::string& text);

/// "TETSxRAYS" for --searches: at most 1,000,000 tets with 1,048,576 rays each, a multiple of 8. Throws Error{usage}.
[[nodiscard]] SearchSize parse_searches(const std::string& text);

/// View numbers: numbers separated by commas, ranges "10-20" and strides "0-1281:64"; empty is all. Ascending, each
/// once. Throws Error{usage} naming the part that cannot be read, or the number that is not below view_count.
[[nodiscard]] std::vector<std::uint32_t> parse_views(const std::string& text, std::size_t view_count,
                                                     const std::string& option = "--views");

} // namespace tetrace

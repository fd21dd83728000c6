#include "bench/options/option_values.h"

#include "bench/options/name_filter.h"
#include "core/base/printable.h"
#include "core/device/backend.h"
#include "kernels/layouts/layout.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <set>

namespace tetrace {

namespace {

template <class T>
bool read_whole(std::string_view text, T& value)
{
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    return problem == std::errc() && end == text.data() + text.size();
}

struct ViewRange {
    std::uint32_t first = 0, last = 0, stride = 1;
};

bool read_range(std::string_view text, ViewRange& range)
{
    if (const auto colon = text.find(':'); colon != std::string_view::npos) {
        if (!read_whole(text.substr(colon + 1), range.stride) || range.stride == 0) return false;
        text = text.substr(0, colon);
    }
    const auto dash = text.find('-');
    if (!read_whole(text.substr(0, dash), range.first)) return false;
    if (dash == std::string_view::npos) {
        range.last = range.first;
        return true;
    }
    return read_whole(text.substr(dash + 1), range.last) && range.first <= range.last;
}

} // namespace

std::string join_alternatives(const std::vector<std::string>& names)
{
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
        text += names[i];
    }
    return text;
}

std::vector<std::string> split_list(const std::string& option, const std::string& text)
{
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == ',')
            parts.emplace_back();
        else
            parts.back() += c;
    }
    if (text.empty()) throw Error(ErrorKind::usage, option + ": the value is empty");
    for (const std::string& part : parts)
        if (part.empty())
            throw Error(ErrorKind::usage,
                        fmt::format("{}: empty value in '{}'; write values with one comma between", option, text));
    return parts;
}

std::vector<std::string> split_scenes(const std::string& option, const std::string& text)
{
    std::error_code ignored; // what cannot be looked at is not a file for us
    std::vector<std::string> names;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t first = std::min(text.find(',', begin), text.size());
        std::size_t end = text.size();
        while (end > first && !std::filesystem::is_regular_file(text.substr(begin, end - begin), ignored))
            end = text.rfind(',', end - 1);
        names.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    for (const std::string& name : names)
        if (name.empty()) return split_list(option, text); // which says so
    return names;
}

void reject_value(const std::string& option, const std::string& value, const std::string& accepted)
{
    throw Error(ErrorKind::usage, fmt::format("{}: '{}' is not accepted; accepted: {}", option, value, accepted));
}

void reject_name(const std::string& option, const std::string& value, const std::vector<std::string>& names,
                 const std::string& more)
{
    const std::string guess = did_you_mean(value, names);
    throw Error(ErrorKind::usage,
                fmt::format("{}: '{}' is not accepted{}: {}{}", option, value,
                            guess.empty() ? "; accepted" : guess + " Accepted", join_alternatives(names), more));
}

std::uint64_t parse_count(const std::string& option, const std::string& text, std::uint64_t low, std::uint64_t high)
{
    std::uint64_t value = 0;
    if (!read_whole(text, value) || value < low || value > high)
        reject_value(option, text, fmt::format("a whole number from {} to {}", low, high));
    return value;
}

namespace {

/// Empty if the text is not a time of 0 or more.
std::optional<double> read_seconds(const std::string& text)
{
    std::string_view digits = text;
    double unit = 1;
    if (!digits.empty() && std::string_view("smh").find(digits.back()) != std::string_view::npos) {
        unit = digits.back() == 'h' ? 3600 : digits.back() == 'm' ? 60 : 1;
        digits.remove_suffix(1);
    }
    double value = 0;
    if (!read_whole(digits, value) || !std::isfinite(value) || value < 0) return std::nullopt;
    return value * unit;
}

} // namespace

double parse_seconds(const std::string& option, const std::string& text)
{
    const std::optional<double> seconds = read_seconds(text);
    if (!seconds || *seconds == 0)
        reject_value(option, text, "a positive number of seconds, or a number followed by s, m or h");
    return *seconds;
}

double parse_sample_time(const std::string& text)
{
    const std::optional<double> seconds = read_seconds(text);
    if (!seconds || *seconds > 60) reject_value("--sample-time", text, "0 to 60 seconds");
    return *seconds;
}

double parse_percent(const std::string& option, const std::string& text)
{
    std::string_view digits = text;
    if (!digits.empty() && digits.back() == '%') digits.remove_suffix(1);
    double value = 0;
    if (!read_whole(digits, value) || !(value >= 0 && value <= 100))
        reject_value(option, text, "a percentage from 0 to 100, as 3 or 2.5%");
    return value;
}

std::uint64_t parse_bytes(const std::string& option, const std::string& text)
{
    constexpr std::string_view units = "KMGT";
    std::string_view digits = text;
    unsigned shift = 0;
    if (!digits.empty())
        if (const auto unit = units.find(digits.back()); unit != std::string_view::npos) {
            shift = 10 * (static_cast<unsigned>(unit) + 1);
            digits.remove_suffix(1);
        }
    std::uint64_t value = 0;
    if (!read_whole(digits, value) || value == 0 || value > std::numeric_limits<std::uint64_t>::max() >> shift)
        reject_value(option, text, "a whole number of bytes, or one followed by K, M, G or T (powers of 1024)");
    return value << shift;
}

std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& option, const std::string& text)
{
    constexpr std::uint32_t largest = 16384;
    const auto cross = text.find('x');
    std::uint32_t width = 0, height = 0;
    const bool read = read_whole(std::string_view(text).substr(0, cross), width) &&
                      (cross == std::string::npos || read_whole(std::string_view(text).substr(cross + 1), height));
    if (cross == std::string::npos) height = width;
    if (!read || width < 1 || height < 1 || width > largest || height > largest)
        reject_value(option, text, fmt::format("WxH or N, each from 1 to {}", largest));
    return {width, height};
}

std::vector<std::string> tile_names()
{
    return {"8x4", "8x8"};
}

unsigned parse_tile_height(const std::string& text)
{
    const auto names = tile_names();
    if (std::ranges::find(names, text) == names.end()) reject_name("--tile", text, names);
    return text == names.front() ? 4 : 8;
}

std::vector<std::string> packet_lane_names()
{
    std::vector<std::string> names;
    for (const unsigned lanes : packet_widths)
        names.push_back(std::to_string(lanes));
    return names;
}

unsigned parse_packet_lanes(const std::string& text)
{
    for (const unsigned lanes : packet_widths)
        if (text == std::to_string(lanes)) return lanes;
    reject_name("--packet-lanes", text, packet_lane_names());
}

std::string parse_filter(const std::string& text)
{
    const NameFilter check("--filter", text);
    return text;
}

std::string parse_label(const std::string& text)
{
    constexpr std::size_t longest = 100;
    if (text.empty() || text.size() > longest || printable_line(text) != text)
        reject_value("--label", text, "one line of 1 to 100 bytes, UTF-8 that can be shown");
    return text;
}

SearchSize parse_searches(const std::string& text)
{
    constexpr std::uint32_t max_tets = 1'000'000, max_rays = 1u << 20;
    const auto cross = text.find('x');
    SearchSize size;
    const bool read = cross != std::string::npos && read_whole(std::string_view(text).substr(0, cross), size.tets) &&
                      read_whole(std::string_view(text).substr(cross + 1), size.rays);
    const bool in_range = size.tets >= 1 && size.tets <= max_tets && size.rays >= 1 && size.rays <= max_rays;
    if (!read || !in_range || size.rays % TILE_WIDTH != 0)
        reject_value("--searches", text,
                     fmt::format("TETSxRAYS, 1 to {} tets with {} to {} rays each, a multiple of {}", max_tets,
                                 TILE_WIDTH, max_rays, TILE_WIDTH));
    return size;
}

std::string text_of(const Shard& shard)
{
    return fmt::format("{}/{}", shard.number, shard.of);
}

Shard parse_shard(const std::string& text)
{
    const std::size_t slash = text.find('/');
    Shard shard;
    const bool read = slash != std::string::npos && read_whole(std::string_view(text).substr(0, slash), shard.number) &&
                      read_whole(std::string_view(text).substr(slash + 1), shard.of);
    if (!read || shard.number < 1 || shard.number > shard.of || shard.of > max_shards)
        reject_value("--shard", text,
                     fmt::format("K/N, the K-th of N shards, 1/4 to 4/4 for example; N is at most {}", max_shards));
    return shard;
}

std::vector<std::uint32_t> parse_views(const std::string& text, std::size_t view_count, const std::string& option)
{
    std::set<std::uint32_t> numbers;
    const std::string all = fmt::format("0-{}", view_count - 1);
    for (const std::string& part : split_list(option, text.empty() ? all : text)) {
        ViewRange range;
        if (!read_range(part, range))
            reject_value(option, part, "numbers (3), ranges (10-20) and strides (0-1281:64), commas between");
        if (range.last >= view_count)
            throw Error(ErrorKind::usage, fmt::format("{}: view {} does not exist; this camera set has views 0 to {}",
                                                      option, range.last, view_count - 1));
        for (std::uint64_t number = range.first; number <= range.last; number += range.stride)
            numbers.insert(static_cast<std::uint32_t>(number));
    }
    return {numbers.begin(), numbers.end()};
}

std::string views_text(const std::vector<std::uint64_t>& views)
{
    std::string text;
    for (std::size_t i = 0; i < views.size();) {
        std::size_t end = i + 1;
        const std::uint64_t step = end < views.size() ? views[end] - views[i] : 1;
        while (end < views.size() && views[end] - views[end - 1] == step)
            ++end;
        if (end - i < 3) end = step == 1 ? end : i + 1;
        text += fmt::format("{}{}", text.empty() ? "" : ",", views[i]);
        if (end - i > 1) text += fmt::format("-{}{}", views[end - 1], step == 1 ? "" : fmt::format(":{}", step));
        i = end;
    }
    return text;
}

} // namespace tetrace

#include "scenes/builder/mesh_source.h"

#include "core/base/printable.h"
#include "scenes/builder/polygon.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace tetrace {

void MeshSource::fail(const std::string& place, const std::string& problem, const std::string& remedy) const
{
    // All may quote the file.
    throw Error(ErrorKind::invalid_input,
                printable_line(fmt::format("reading {}: {}: {}; {}", name_, place, problem, remedy)));
}

void MeshSource::fail(const std::string& place, const std::string& problem) const
{
    fail(place, problem, "the file is damaged or cut short: fetch or export it again");
}

void MeshSource::require_room(const std::string& elements, std::int64_t count, std::size_t min_bytes) const
{
    if (count < 0) fail("header", fmt::format("a negative number of {}, {}", elements, count));
    const auto most = bytes_.size() / min_bytes + 1;
    if (static_cast<std::uint64_t>(count) > most)
        fail("header", fmt::format("it announces {} {}, but {} bytes cannot hold more than {}", count, elements,
                                   bytes_.size(), most));
}

void MeshSource::add_vertex(Float3 position, const std::string& place)
{
    for (int axis = 0; axis < 3; ++axis) {
        const float value = position[axis];
        if (std::isfinite(value)) continue;
        fail(place,
             fmt::format("coordinate {} is {}", "xyz"[axis],
                         std::isnan(value) ? "not a number" : "infinite or outside float's range"),
             "remove or repair the vertex (MeshLab: Filters, Cleaning and Repairing), or scale the mesh down");
    }
    if (soup_.mesh.vertices.size() >= std::numeric_limits<std::int32_t>::max())
        fail(place, "more than 2^31 vertices", "simplify the mesh: TetGen counts in 32 bits");
    soup_.mesh.vertices.push_back(position);
}

void MeshSource::add_face(const std::vector<std::int64_t>& corners, std::size_t vertex_count, const std::string& place)
{
    for (const std::int64_t corner : corners)
        if (corner < 0 || static_cast<std::uint64_t>(corner) >= vertex_count)
            fail(place, fmt::format("vertex index {} is out of range (the mesh has {} vertices, counted from 0)",
                                    corner, vertex_count));
    if (corners.size() < 3) ++soup_.skipped_faces;
    if (corners.size() > 3) return add_polygon(corners);
    const auto index = [&](std::size_t i) { return static_cast<std::uint32_t>(corners[i]); };
    if (corners.size() == 3) soup_.mesh.triangles.push_back({index(0), index(1), index(2)});
}

void MeshSource::add_polygon(const std::vector<std::int64_t>& corners)
{
    std::vector<Float3> places;
    for (const std::int64_t corner : corners)
        // PLY may have vertices after faces; then nothing is known of the polygon yet.
        if (static_cast<std::uint64_t>(corner) < soup_.mesh.vertices.size())
            places.push_back(soup_.mesh.vertices[static_cast<std::size_t>(corner)]);
    if (places.size() < corners.size()) places.assign(corners.size(), Float3{});
    for (const std::array<std::size_t, 3>& triangle : cut_polygon(places)) {
        const auto index = [&](std::size_t i) { return static_cast<std::uint32_t>(corners[triangle[i]]); };
        soup_.mesh.triangles.push_back({index(0), index(1), index(2)});
    }
}

bool LineReader::next_raw(std::string_view& line)
{
    if (at_ >= text_.size()) return false;
    const auto end = std::min(text_.find('\n', at_), text_.size());
    line = text_.substr(at_, end - at_);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    at_ = std::min(end + 1, text_.size());
    ++line_;
    return true;
}

bool LineReader::next(std::vector<std::string_view>& words)
{
    std::string_view line;
    while (next_raw(line)) {
        words = split_words(line.substr(0, line.find('#')));
        if (!words.empty()) return true;
    }
    words.clear();
    return false;
}

std::string LineReader::place(const std::string& element) const
{
    return fmt::format("{} (line {})", element, line_);
}

std::vector<std::string_view> split_words(std::string_view line)
{
    constexpr std::string_view blanks = " \t\r\v\f";
    std::vector<std::string_view> words;
    for (auto begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
        const auto end = std::min(line.find_first_of(blanks, begin), line.size());
        words.push_back(line.substr(begin, end - begin));
        begin = line.find_first_not_of(blanks, end);
    }
    return words;
}

std::optional<float> parse_float(std::string_view word)
{
    if (word.starts_with('+')) word.remove_prefix(1);
    const char* const end = word.data() + word.size();
    float value = 0;
    const auto result = std::from_chars(word.data(), end, value);
    if (result.ptr != end || word.empty()) return std::nullopt;
    if (result.ec == std::errc{}) return value;
    if (result.ec != std::errc::result_out_of_range) return std::nullopt;
    // Too small is zero to the nearest float's precision; too large is for the caller to refuse.
    double wide = 0;
    const auto again = std::from_chars(word.data(), end, wide);
    if (again.ec == std::errc{} && std::abs(wide) < 1) return static_cast<float>(wide);
    const bool tiny = again.ec != std::errc{} && lower_case(word).find("e-") != std::string::npos;
    return tiny ? 0.0f : std::numeric_limits<float>::infinity();
}

std::optional<std::int64_t> parse_integer(std::string_view word)
{
    if (word.starts_with('+')) word.remove_prefix(1);
    std::int64_t value = 0;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
    if (result.ec != std::errc{} || result.ptr != word.data() + word.size()) return std::nullopt;
    return value;
}

std::string lower_case(std::string_view word)
{
    std::string text(word);
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

Float3 parse_position(const MeshSource& source, const std::vector<std::string_view>& words, std::size_t first,
                      const std::string& place)
{
    Float3 position;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (words.size() <= first + axis) source.fail(place, "fewer than three coordinates");
        const auto value = parse_float(words[first + axis]);
        if (!value) source.fail(place, fmt::format("'{:.40}' is not a number", words[first + axis]));
        position[static_cast<int>(axis)] = *value;
    }
    return position;
}

} // namespace tetrace

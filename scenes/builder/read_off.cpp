#include "scenes/builder/mesh_source.h"

#include <fmt/format.h>

namespace tetrace {
namespace {

using Words = std::vector<std::string_view>;

// The keyword, and the words that follow it on its line; fails for OFF's binary, 4D and nD variants.
Words read_keyword(const MeshSource& source, LineReader& lines)
{
    Words words;
    if (!lines.next(words)) source.fail("header", "the file is empty");
    std::string_view keyword = words.front();
    for (const std::string_view prefix : {"ST", "C", "N"})
        if (keyword.starts_with(prefix)) keyword.remove_prefix(prefix.size());
    if (keyword != "OFF")
        source.fail("header", fmt::format("it begins with '{:.20}', not with OFF, COFF, NOFF or STOFF", words.front()),
                    "this is not an OFF file of three dimensions: convert it, or give it the right extension");
    words.erase(words.begin());
    if (!words.empty() && words.front() == "BINARY")
        source.fail("header", "binary OFF is not supported", "convert it to ascii OFF or to PLY");
    return words;
}

std::int64_t read_count(const MeshSource& source, const LineReader& lines, const Words& words, std::size_t index)
{
    const auto count = words.size() > index ? parse_integer(words[index]) : std::nullopt;
    if (!count) source.fail(lines.place("header"), "the numbers of vertices and faces are missing");
    return *count;
}

// A face's corners may span several lines; colours after them are ignored.
std::vector<std::int64_t> read_corners(MeshSource& source, LineReader& lines, Words& words, const std::string& face)
{
    const auto size = parse_integer(words.front());
    if (!size || *size < 0)
        source.fail(lines.place(face), fmt::format("'{:.40}' is not a number of corners", words.front()));
    source.require_room("corners of a face", *size, 2);
    std::vector<std::int64_t> corners;
    std::size_t word = 1;
    while (corners.size() < static_cast<std::size_t>(*size)) {
        if (word == words.size()) {
            if (!lines.next(words)) source.fail(lines.place(face), "the file ends inside it");
            word = 0;
        }
        const auto corner = parse_integer(words[word]);
        if (!corner) source.fail(lines.place(face), fmt::format("'{:.40}' is not a vertex index", words[word]));
        corners.push_back(*corner);
        ++word;
    }
    return corners;
}

} // namespace

void read_off(MeshSource& source)
{
    LineReader lines(source.bytes());
    Words words = read_keyword(source, lines);
    if (words.empty()) lines.next(words);
    const auto vertex_count = read_count(source, lines, words, 0);
    const auto face_count = read_count(source, lines, words, 1);
    source.require_room("vertices", vertex_count, 6);
    source.require_room("faces", face_count, 2);

    for (std::int64_t i = 0; i < vertex_count; ++i) {
        const auto vertex = fmt::format("vertex {}", i);
        if (!lines.next(words))
            source.fail(lines.place(vertex), fmt::format("the file ends before it; {} announced", vertex_count));
        source.add_vertex(parse_position(source, words, 0, lines.place(vertex)), lines.place(vertex));
    }
    for (std::int64_t i = 0; i < face_count; ++i) {
        const auto face = fmt::format("face {}", i);
        if (!lines.next(words))
            source.fail(lines.place(face), fmt::format("the file ends before it; {} announced", face_count));
        source.add_face(read_corners(source, lines, words, face), static_cast<std::size_t>(vertex_count),
                        lines.place(face));
    }
    if (lines.next(words)) source.fail(lines.place("end"), "text follows the last announced face");
}

} // namespace tetrace

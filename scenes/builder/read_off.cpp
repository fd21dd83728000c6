#include "scenes/builder/mesh_source.h"

#include <fmt/format.h>

#include <algorithm>

namespace tetrace {
namespace {

using Words = std::vector<std::string_view>;

// The words after the keyword on its line; there may be no keyword, or no blank after it. Fails for OFF's binary, 4D
// and nD variants. The prefixes say what else a vertex has, which is ignored.
Words read_keyword(const MeshSource& source, LineReader& lines)
{
    Words words;
    if (!lines.next(words)) source.fail("header", "the file is empty");
    if (parse_integer(words.front())) return words;
    std::string_view rest = words.front();
    const std::string keyword = lower_case(rest);
    const auto end = keyword.find("off");
    const auto is_prefix = [&](std::string_view prefix) {
        for (const std::string_view part : {"st", "c", "n"})
            if (prefix.starts_with(part)) prefix.remove_prefix(part.size());
        if (prefix.starts_with("c")) prefix.remove_prefix(1); // NC is as frequent as CN
        return prefix.empty();
    };
    rest.remove_prefix(std::min(rest.size(), end == std::string::npos ? end : end + 3));
    const bool is_of_n_dimensions = words.front().find("nOFF") != std::string_view::npos;
    if (end == std::string::npos || is_of_n_dimensions || !is_prefix(std::string_view(keyword).substr(0, end)) ||
        (!rest.empty() && !parse_integer(rest)))
        source.fail("header", fmt::format("it begins with '{:.20}', not with OFF, COFF, NOFF or STOFF", words.front()),
                    "this is not an OFF file of three dimensions: convert it, or give it the right extension");
    words.erase(words.begin());
    if (!rest.empty()) words.insert(words.begin(), rest);
    if (!words.empty() && lower_case(words.front()) == "binary")
        source.fail("header", "binary OFF is not supported", "convert it to ascii OFF or to PLY");
    return words;
}

std::int64_t read_count(const MeshSource& source, const LineReader& lines, const Words& words, std::size_t index)
{
    const auto count = words.size() > index ? parse_integer(words[index]) : std::nullopt;
    if (!count) source.fail(lines.place("header"), "the numbers of vertices and faces are missing");
    return *count;
}

// The words of vertices and faces. Each begins on a line of its own and may go on in the next, and more words on its
// last line (colours, normals) are ignored; if there are too few lines for that, nothing is.
class Records {
public:
    Records(const MeshSource& source, LineReader& lines, std::int64_t count)
        : source_(source), lines_(lines), by_words_(lines.has_fewer_lines(static_cast<std::uint64_t>(count)))
    {
    }

    void begin(const std::string& element)
    {
        element_ = element;
        if (by_words_ && word_ < words_.size()) return;
        if (!lines_.next(words_)) source_.fail(place(), "the file ends before it, fewer than announced");
        word_ = 0;
    }
    std::string_view next()
    {
        if (word_ == words_.size()) {
            if (!lines_.next(words_)) source_.fail(place(), "the file ends inside it");
            word_ = 0;
        }
        return words_[word_++];
    }
    [[nodiscard]] std::string place() const { return lines_.place(element_); }

private:
    const MeshSource& source_;
    LineReader& lines_;
    bool by_words_;
    std::string element_;
    Words words_;
    std::size_t word_ = 0;
};

std::vector<std::int64_t> read_corners(const MeshSource& source, Records& records)
{
    const std::string_view word = records.next();
    const auto size = parse_integer(word);
    if (!size || *size < 0) source.fail(records.place(), fmt::format("'{:.40}' is not a number of corners", word));
    source.require_room("corners of a face", *size, 2);
    std::vector<std::int64_t> corners;
    while (corners.size() < static_cast<std::size_t>(*size)) {
        const std::string_view index = records.next();
        const auto corner = parse_integer(index);
        if (!corner) source.fail(records.place(), fmt::format("'{:.40}' is not a vertex index", index));
        corners.push_back(*corner);
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

    Records records(source, lines, vertex_count + face_count);
    for (std::int64_t i = 0; i < vertex_count; ++i) {
        records.begin(fmt::format("vertex {}", i));
        const auto coordinate = [&] {
            const std::string_view word = records.next();
            return parse_coordinate(source, word, records.place());
        };
        const double x = coordinate(), y = coordinate(), z = coordinate();
        source.add_vertex({x, y, z}, records.place());
    }
    for (std::int64_t i = 0; i < face_count; ++i) {
        records.begin(fmt::format("face {}", i));
        const std::vector<std::int64_t> corners = read_corners(source, records);
        source.add_face(corners, static_cast<std::size_t>(vertex_count), records.place());
    }
    if (lines.next(words)) source.note("text after the last announced face was ignored");
}

} // namespace tetrace
